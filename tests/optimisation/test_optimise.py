"""Optimal design: exact derivatives, known optima, honest worst cases, and clear refusals."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine
from tests.helpers.support import apart

import flexapod as fx
from flexapod import _core
from flexapod.design.layout import HOME, PLACES, numbers
from flexapod.optimisation import constraint_quantities
from flexapod.optimisation.derivatives import DesignDerivatives, index_derivatives
from flexapod.optimisation.design_map import DesignMap
from flexapod.optimisation.local_search import finish
from flexapod.optimisation.problem import Problem
from flexapod.workspace.quantities import evaluate

RADIANS = np.radians


def three_pairs(
    base_radius=0.2, base_half=0.2, radius=0.15, half=0.25, height=0.2, mass=10.0, inertia=(0.1, 0.1, 0.15)
):
    """A machine with three-fold and mirror symmetry and massless legs of 1e6 N/m."""
    angle = np.repeat(np.arange(3) * 2 * np.pi / 3, 2)
    side = np.tile([-1.0, 1.0], 3)
    base, plate = angle + side * base_half, angle + side * (np.pi / 3 - half)
    return fx.Hexapod.from_toml(
        f"""
        name = "three-pairs"
        [base.circle]
        radius = {base_radius}
        angles = {base.tolist()}
        [platform.circle]
        radius = {radius}
        angles = {plate.tolist()}
        [platform]
        mass = {mass}
        mass_center = [0, 0, 0]
        inertia = [[{inertia[0]}, 0, 0], [0, {inertia[1]}, 0], [0, 0, {inertia[2]}]]
        [legs]
        stiffness = 1e6
        [home]
        position = [0, 0, {height}]
        """
    )


def many_variables():
    """Variables of every sort, on the precision positioner."""
    return [
        fx.optimisation.JointCircle(
            "base", radius=(0.1, 0.3), half_angle=(0.05, 0.6), turn=(-0.3, 0.3), height=(-0.02, 0.02)
        ),
        fx.Variable({"platform.joints_mm[0][2]": 1.0, "platform.joints_mm[3][2]": -0.5}, -10, 10, kind="add"),
        fx.Variable("platform.joints[:][1]", 0.7, 1.3, kind="scale"),
        fx.Variable(["legs.stiffness_N_per_um[0]", "legs.stiffness_N_per_um[5]"], 10, 100, log=True),
        fx.Variable("platform.mass", 10, 40),
        fx.Variable("platform.inertia[0][1]", -0.01, 0.01),
        fx.Variable("legs.upper.mass", 0.5, 2),
        fx.Variable("home.position[2]", 0.2, 0.3),
        fx.Variable("home.orientation_deg[1]", -5, 5),
    ]


@pytest.fixture(scope="module")
def somewhere():
    """A map of many variables, a point of it, and poses that move with home."""
    design = DesignMap(plain_machine("precision-positioner"), many_variables())
    rng = np.random.default_rng(5)
    x = design.from_unit(rng.uniform(0.2, 0.8, len(design.names)))[0]
    offsets = rng.uniform(-1, 1, (5, 6)) * np.repeat([0.01, 0.1], 3)
    return design, x, offsets


def slopes_at(design, x, offsets):
    own = design.numbers(x)
    return DesignDerivatives(own, design.jacobian(x), offsets + own[HOME], True, _core.Joint.universal)


def differences(function, design, x):
    """Central differences of a function of x, (..., n): steps of 1e-6 of the range err by 1e-9 of the curvature's part
    and by 1e-10 of the value in rounding."""
    step = 1e-6 * (design.high - design.low)
    columns = []
    for k in range(len(x)):
        d = np.zeros(len(x))
        d[k] = step[k]
        columns.append((function(x + d) - function(x - d)) / (2 * step[k]))
    return np.stack(columns, axis=-1)


def slope_error(found, expected, design):
    """In units of each variable's range, so that entries of different units compare; of the largest."""
    width = design.high - design.low
    return np.abs((found - expected) * width).max() / np.abs(expected * width).max()


def assert_slopes(found, expected, design, rtol=2e-7):
    assert slope_error(found, expected, design) < rtol  # see `differences`; rounding dominates


def test_the_map_and_its_inverse_agree_with_the_design(somewhere):
    design, x, _ = somewhere
    hexapod = design.hexapod_at(x)
    np.testing.assert_array_equal(numbers(hexapod)[design.changed], design.numbers(x)[design.changed])
    np.testing.assert_allclose(hexapod.packed, design.numbers(x)[: HOME.start], rtol=1e-15, atol=1e-18)
    assert_slopes(design.jacobian(x), differences(design.numbers, design, x), design)
    np.testing.assert_allclose(design.from_unit(design.unit(x))[0], x, rtol=1e-13)


def test_frequency_slopes_against_differences(somewhere, measured):
    design, x, offsets = somewhere

    def omega(x):
        hexapod = design.hexapod_at(x)
        pose = fx.Pose.from_rpy(*(offsets + numbers(hexapod)[HOME]).T)
        return fx.natural_modes(hexapod, pose).omega

    value, rayleigh = slopes_at(design, x, offsets).omega
    np.testing.assert_allclose(value, omega(x), rtol=1e-12)
    found = np.einsum("kaan->kan", rayleigh) / (2 * value[..., None])
    measured("design/slopes", slope_error(found, differences(omega, design, x), design), 2e-7)


@pytest.mark.parametrize(
    "kind",
    [
        constraint_quantities.LegLengths(),
        constraint_quantities.LegStroke(),
        constraint_quantities.JointAngles("universal"),
        constraint_quantities.JointAngles("spherical"),
        constraint_quantities.LegDistance(),
        constraint_quantities.Conditioning(),
        constraint_quantities.StaticDeflection(),
        constraint_quantities.StaticDeflection(100.0),
        constraint_quantities.Mass(),
        constraint_quantities.Radius("base", 0.01, -0.02),
    ],
    ids=lambda kind: type(kind).__name__,
)
def test_constraint_slopes_against_differences_and_values_against_the_sweep(kind, somewhere):
    design, x, offsets = somewhere
    if isinstance(kind, constraint_quantities.LegStroke):
        offsets = np.tile(offsets[:2], (6, 1))  # for each leg a shortest and a longest pose

    def values(x):
        return kind.derivatives(slopes_at(design, x, offsets)).value

    found = kind.derivatives(slopes_at(design, x, offsets))
    # Angles of some degrees, from their cosines, have a rounding of eps / angle: a hundred times that of the others.
    rtol = 1e-5 if isinstance(kind, constraint_quantities.JointAngles) else 2e-7
    assert_slopes(found.slope, differences(values, design, x), design, rtol)
    hexapod = design.hexapod_at(x)
    own = numbers(hexapod)
    swept = evaluate(hexapod, offsets + own[HOME], kind.quantities, "universal", 1) if kind.quantities else {}
    if isinstance(kind, constraint_quantities.LegStroke):
        length = swept["leg_length"]
        np.testing.assert_allclose(found.value, length[1] - length[0], rtol=1e-11)
        return
    expected = kind.columns(swept, own).ravel()
    if isinstance(kind, constraint_quantities.LegDistance):
        found = found._replace(value=found.value.reshape(5, 15).min(axis=1))
    # Angles near zero come from a cosine; smooth extremes lie up to log(6)/1000 above on each side.
    np.testing.assert_allclose(found.value, expected, rtol=4e-3 if kind.log else 1e-8)


def test_slopes_where_frequencies_are_equal(measured):
    """At its centre a cubic hexapod with massless legs and a small inertia has its lowest frequency three times."""
    hexapod = plain_machine("cubic-isolator").replace(
        {"legs.lower": None, "legs.upper": None, "platform.inertia": (0.1 * np.eye(3)).tolist()}
    )
    pose = fx.home_pose(hexapod)
    omega = fx.natural_modes(hexapod, pose).omega
    assert omega[2] - omega[0] < 1e-9 * omega[0]  # three times sqrt(2 k / M)
    np.testing.assert_allclose(omega[0], np.sqrt(2 * 1e4 / 20), rtol=1e-9)
    rng = np.random.default_rng(1)
    direction = np.zeros((1, _core.design_size))
    direction[0, 3:21] = rng.standard_normal(18) * 0.01  # joints of the base
    direction[0, PLACES["legs.stiffness"]] = rng.standard_normal(6) * 1e3
    own = numbers(hexapod)
    jacobian = np.zeros((HOME.stop, 1))
    jacobian[: _core.design_size] = direction.T
    at = DesignDerivatives(own, jacobian, own[None, HOME], True, _core.Joint.universal)
    block = at.omega[1][0, :3, :3, 0]
    by_formula = np.linalg.eigvalsh(block) / (2 * omega[0])

    def lowest_three(step):
        packed = own[: HOME.start] + step * direction[0]
        motion = fx.Motion(pose).packed[None]
        still = fx.Motion.fixed().packed[None]
        return _core.natural_modes(packed, _core.Joint.universal, motion, still)[0][0, :3]

    for side in (1, -1):  # each of the three goes its own way, in order, on either side
        moved = (lowest_three(side * 1e-5) - omega[:3]) / 1e-5
        expected = np.sort(side * by_formula)
        measured("design/repeated", apart(moved, expected), 5e-3)  # second order: step times the others' frequency gap

    def soft(step):
        moved = DesignDerivatives(own + step * jacobian[:, 0], jacobian, own[None, HOME], True, _core.Joint.universal)
        return index_derivatives(moved, 50.0)[0][0]

    slope = index_derivatives(at, 50.0)[1][0, 0]
    assert abs(slope - (soft(1e-5) - soft(-1e-5)) / 2e-5) < 1e-6 * abs(by_formula).max() / omega[0] + 1e-7


def test_joint_circles_keep_their_symmetry():
    design = DesignMap(
        plain_machine("motion-base"),
        [fx.optimisation.JointCircle("base", radius=(1, 2), half_angle=(0.05, 0.9), turn=(-2, 2), height=(-0.1, 0.1))],
    )
    np.testing.assert_allclose(design.own()[:2], [1.65, np.arcsin(0.3 / 1.65)], rtol=1e-5)  # as its file says
    rng = np.random.default_rng(3)
    c, s = np.cos(2 * np.pi / 3), np.sin(2 * np.pi / 3)
    third = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    for u in rng.uniform(size=(20, 4)):
        x = design.from_unit(u)[0]
        joints = design.hexapod_at(x).base_joints
        turned = joints @ third.T
        middle = np.array([np.cos(x[2]), np.sin(x[2]), 0])
        mirrored = joints - 2 * (joints - (joints @ middle)[:, None] * middle - joints[:, 2:] * [0, 0, 1])
        for image in (turned, mirrored):
            apart = np.linalg.norm(image[:, None] - joints[None], axis=-1).min(axis=1)
            assert apart.max() < 1e-14 * 10  # a few roundings of metres


def test_the_best_height_of_a_symmetric_family_is_the_closed_form(measured):
    """With height the heave stiffens, omega_z^2 = 6 k (h/L)^2 / M, and the yaw softens, 6 k (R r sin(phi)/L)^2 / I_z.

    The best height is where they cross, h = R r sin(phi) sqrt(M / I_z): an optimum at a repeated frequency.
    """
    R, r, phi = 0.2, 0.15, np.pi / 3 - 0.25 - 0.2
    machine = three_pairs(height=0.1, mass=10.0, inertia=(0.05, 0.05, 1.0))  # such that the other four are higher
    best = R * r * np.sin(phi) * np.sqrt(10.0 / 1.0)
    length = np.hypot(best, np.sqrt(R**2 + r**2 - 2 * R * r * np.cos(phi)))
    index = np.sqrt(6 * 1e6 / 10.0) * best / length
    found = fx.optimise(machine, [fx.Variable("home.position[2]", 0.02, 0.3)], trials=0)
    # The smooth minimum of two modes is off by at most log(2)/4000, and its place by as much.
    assert abs(found.variables["home.position[2]"] / best - 1) < 5e-4
    measured("design/height", found.index / index - 1, 2e-4)
    assert found.coincident == 2
    searched = fx.optimise(machine, [fx.Variable("home.position[2]", 0.02, 0.3)], trials=12)
    measured("design/height", searched.index / index - 1, 2e-4)


def test_massless_legs_are_best_isotropic(measured):
    """The translational stiffnesses of six legs sum to 6 k whatever the geometry, so no machine of this mass has an
    index above sqrt(2 k / M); one that has it is isotropic, as the cubic configuration is."""
    machine = three_pairs(height=0.12, mass=10.0, inertia=(0.02, 0.02, 0.02))
    found = fx.optimise(
        machine,
        [
            fx.optimisation.JointCircle("base", radius=(0.1, 0.4), half_angle=(0.02, 1.0)),
            fx.optimisation.JointCircle("platform", radius=(0.1, 0.4), half_angle=(0.02, 1.0)),
            fx.Variable("home.position[2]", 0.05, 0.5),
            fx.Variable("platform.mass_center[2]", -0.3, 0.3),
        ],
        trials=0,
    )
    most = np.sqrt(2 * 1e6 / 10.0)
    assert found.index < (1 + 1e-12) * most
    measured("design/isotropic", 1 - found.index / most, 1e-3)  # log(3)/4000 from the smooth minimum, and flat about it
    H = fx.force_transformation(found.hexapod, fx.home_pose(found.hexapod))
    np.testing.assert_allclose(H[:3] @ H[:3].T, 2 * np.eye(3), atol=4e-3)  # twice the relative shortfall of the index


def workspace():
    return fx.Workspace.about_home(0.004, RADIANS(4))


def circles():
    return [
        fx.optimisation.JointCircle("base", radius=(0.02, 0.035), half_angle=(0.1, 0.9)),
        fx.optimisation.JointCircle("platform", radius=(0.03, 0.06), half_angle=(0.1, 0.9)),
        fx.Variable("home.position[2]", 0.07, 0.1),
    ]


def test_a_better_design_is_better_on_a_sweep_of_our_own():
    start = fx.load("mukherjee-ii")
    found = fx.optimise(
        start,
        circles(),
        fx.LeastIndex(workspace()),
        [fx.optimisation.Footprint(), fx.optimisation.Stroke(), fx.optimisation.ConditionNumber(150.0)],
        trials=15,
        samples=512,
        verify=2**14,
    )

    def own(hexapod):
        home = fx.home_pose(hexapod).position
        box = fx.Box(*[(h - 0.004, h + 0.004) for h in home], *[(-RADIANS(4), RADIANS(4))] * 3)
        return fx.sweep(
            hexapod, fx.random_poses(box, 100_000, seed=123), quantities=("omega_1", "leg_length", "cond_H")
        )

    before, after = own(start), own(found.hexapod)
    assert found.gain > 0.2
    assert float(after.omega_1.min()) > 1.2 * float(before.omega_1.min())
    assert found.index <= float(after.omega_1.min()) * (1 + 1e-9)  # no pose of ours is worse than what was vouched for
    assert found.start_index <= float(before.omega_1.min()) * (1 + 1e-9)
    reach = np.linalg.norm(found.hexapod.base_joints[:, :2], axis=1).max()
    assert reach <= np.linalg.norm(start.base_joints[:, :2], axis=1).max() * (1 + 1e-3)  # about the circle's own middle
    stroke = {c.name: c.bound for c in found.verification.checks}["leg stroke"]
    assert np.ptp(after.leg_length.values, axis=0).max() <= stroke * (1 + 1e-5)
    assert float(after.cond_H.max()) <= 150.0 * (1 + 1e-5)
    assert found.verification.holds
    assert found.verification.points >= 16 * 512


def test_mean_over_a_path_and_single_joints():
    start = fx.load("mukherjee-i")
    z = np.linspace(0.8, 1.0, 9)
    path = np.zeros((9, 6))
    path[:, 2] = z
    weights = np.linspace(1, 2, 9)
    variables = [fx.Variable(f"platform.joints[{i}][{k}]", -0.03, 0.03, kind="add") for i in range(6) for k in range(2)]
    objective = fx.optimisation.MeanIndex(path, weights)
    found = fx.optimise(
        start,
        variables,
        objective,
        [fx.optimisation.Stroke(region=path), fx.optimisation.TotalMass()],
        trials=0,
        verify=8192,
    )

    def mean(hexapod):
        return np.average(fx.stability_index(hexapod, fx.Pose.from_rpy(*path.T)), weights=weights)

    assert found.index == pytest.approx(mean(found.hexapod), rel=1e-12)
    assert found.index > 1.05 * mean(start)
    assert len(found.at_bounds) >= 6  # twelve coordinates that each help: most run to their bounds


def test_the_finish_holds_up_the_pose_that_the_search_missed():
    """One pose a trial is a poor sweep: the exchange still ends at the design that the dense sweep vouches for."""
    start = fx.load("mukherjee-ii")
    problem = Problem(start, circles(), fx.LeastIndex(workspace()), [fx.optimisation.Stroke()], "universal", 1)
    coarse = finish(problem, problem.map.from_values({}), samples=16)
    dense = problem.assess_at(coarse.x, 2**15, seed=9)
    assert coarse.assessment.feasible
    assert dense.index >= 0.999 * coarse.assessment.index


def test_clearance_angles_and_deflection_are_kept():
    start = plain_machine("precision-positioner")
    over = fx.Workspace.about_home(0.002, RADIANS(0.5))
    found = fx.optimise(
        start,
        [
            fx.optimisation.JointCircle("base", radius=(0.12, 0.25), half_angle=(0.03, 0.6)),
            fx.optimisation.JointCircle("platform", radius=(0.09, 0.2), half_angle=(0.03, 0.6)),
            fx.Variable("home.position[2]", 0.2, 0.3),
        ],
        fx.LeastIndex(over),
        [
            fx.optimisation.DesignLimits(),
            fx.optimisation.Footprint(),
            fx.optimisation.Footprint(plate="platform"),
            fx.optimisation.Deflection(most=1.2e-5),
        ],
        trials=0,
        samples=512,
        verify=4096,
    )
    assert found.verification.holds
    assert found.gain > 0.02
    home = fx.home_pose(found.hexapod)
    K = fx.force_transformation(found.hexapod, home) * np.sqrt(found.hexapod.legs.stiffness)
    sag = np.linalg.eigvalsh(np.linalg.inv(K @ K.T)[:3, :3])[-1] * found.hexapod.platform_mass * 9.81
    assert sag <= 1.2e-5 * (1 + 1e-5)
    assert fx.mechanics.leg_distance(found.hexapod, home) >= 0.034 * (1 - 1e-5)


def test_pareto_front_is_one_and_its_designs_are_what_it_says():
    start = fx.load("mukherjee-ii")
    front = fx.pareto_front(
        start,
        circles(),
        fx.optimisation.Footprint(),
        constraints=[fx.optimisation.Stroke(region=workspace())],
        trials=40,
        refine=3,
        samples=256,
    )
    assert len(front.designs) >= 2
    assert (np.diff(front.index) > 0).all()
    assert (np.diff(front.against) > 0).all()
    for hexapod, index, radius in zip(front.designs, front.index, front.against, strict=True):
        assert fx.stability_index(hexapod, fx.home_pose(hexapod)) == pytest.approx(index, rel=1e-9)
        middle, _ = constraint_quantities.enclosing_circle(start.base_joints[:, :2])
        assert np.linalg.norm(hexapod.base_joints[:, :2] - middle, axis=1).max() == pytest.approx(radius, rel=1e-9)


BAD = {
    "contradict each other": lambda h: ([fx.Variable("platform.mass", 30, 20)], {}),
    "base.circle.radius has the bounds": lambda h: ([fx.optimisation.JointCircle("base", radius=(0.2, 0.1))], {}),
    "both set base.joints[2][1]": lambda h: (
        [fx.optimisation.JointCircle("base", radius=(0.1, 0.2)), fx.Variable("base.joints[2][1]", 0, 1)],
        {},
    ),
    "Raise its lower bound": lambda h: ([fx.Variable("legs.stiffness", -1, 1e6)], {}),
    "is not a number that a search can change": lambda h: ([fx.Variable("limits.leg_distance", 0.1, 0.2)], {}),
    "Did you mean": lambda h: ([fx.Variable("platform.masss", 1, 2)], {}),
    "Indices count from 0": lambda h: ([fx.Variable("legs.stiffness[6]", 1e6, 1e7)], {}),
    "holds nothing that varies": lambda h: ([fx.optimisation.JointCircle("base", radius=0.2)], {}),
    "no design can keep both": lambda h: (
        [fx.Variable("platform.mass", 20, 30)],
        {"constraints": [fx.optimisation.LegLength(least=0.3), fx.optimisation.LegLength(most=0.2)]},
    ),
    "leg length: the bounds are": lambda h: (
        [fx.Variable("platform.mass", 20, 30)],
        {"constraints": [fx.optimisation.LegLength(least=0.3, most=0.2)]},
    ),
    "outside its bounds 20 to 30": lambda h: ([fx.Variable("platform.mass", 20, 30)], {"start": {"platform.mass": 40}}),
    "the start breaks: total mass is 43.7": lambda h: (
        [fx.Variable("platform.mass", 20, 30)],
        {"start": {"platform.mass": 25.3}, "constraints": [fx.optimisation.TotalMass(40.0)]},
    ),
    "the nearest one breaks: total mass": lambda h: (
        [fx.Variable("platform.mass", 20, 30)],
        {"constraints": [fx.optimisation.TotalMass(30.0)], "trials": 3},
    ),
    "twice the poses of a trial": lambda h: ([fx.Variable("platform.mass", 20, 30)], {"verify": 100}),
    "no H has less than 1": lambda h: (
        [fx.Variable("platform.mass", 20, 30)],
        {"constraints": [fx.optimisation.ConditionNumber(0.5)]},
    ),
}


@pytest.mark.parametrize("words", BAD)
def test_bad_input_is_told_by_name(words):
    hexapod = plain_machine("precision-positioner")
    variables, options = BAD[words](hexapod)
    with pytest.raises((fx.ArgumentError, fx.errors.InfeasibleError)) as error:
        fx.optimise(hexapod, variables, **{"trials": 0, **options})
    assert words in str(error.value)


def test_a_home_pose_is_asked_for_where_there_is_none():
    hexapod = fx.load("mukherjee-i").replace({"home": None})
    with pytest.raises(fx.ArgumentError, match="names no home pose"):
        fx.optimise(hexapod, [fx.Variable("platform.mass", 20, 30)])
    with pytest.raises(fx.ArgumentError, match="names none"):
        fx.optimise(hexapod, [fx.Variable("home.position[2]", 0.5, 1)])
