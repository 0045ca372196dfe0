"""What the validation page says of the tests: each claim's words, and the ledger of what the tests measured for it.

`measured(key, found, bound)` in a test asserts that the deviation found is below the bound, and that the committed
`docs/validation.json` names this bound for the claim. `make validation` writes that file from the tests' own numbers.
"""

import json
import os
import platform
from pathlib import Path
from typing import NamedTuple

import numpy as np

FILE = Path(__file__).parents[2] / "docs" / "validation.json"
RENEW = "Run `make validation`, and commit docs/validation.json."


class Claim(NamedTuple):
    """What agrees, with what that the library does not share a formula with, and the unit of the deviation."""

    topic: str
    claim: str
    against: str
    unit: str = "relative"


PINOCCHIO = "closed chain of rigid bodies, loops closed by constraints (Pinocchio)"
STORED = "stored answers of an independent code"
DIGITS = "50-digit arithmetic, from the partial velocities"
DIFFERENCES = "fourth-order differences"
DEHAEZE = "T. Dehaeze, stewart-simscape (printed digits)"
PREUMONT = "closed form (Preumont)"

MOTION, LAWS, GEOMETRY = "Equations of motion", "Laws of mechanics", "Kinematics"
REST, MODES, PUBLISHED = "Rest and the tangent", "Natural frequencies", "Published numbers"
SWEEPS, TIME, FREQUENCY = "Workspace sweeps", "Simulation in time", "Vibration by frequency"
DESIGN, CONTROL = "Design, paths and robustness", "Control"

CLAIMS: dict[str, Claim] = {
    "motion/matrices": Claim(MOTION, "J_p, J_b and H at 24 states, both joint models, base moving", STORED),
    "motion/accelerations": Claim(MOTION, "the platform's accelerations at these states", STORED),
    "motion/engine": Claim(
        MOTION, "accelerations at 200 random states: moving base, friction, loads, exact joints", PINOCCHIO
    ),
    "motion/J_p": Claim(MOTION, "J_p of 20 random machines", PINOCCHIO),
    "motion/J_b": Claim(MOTION, "J_b of the same", PINOCCHIO),
    "motion/eta": Claim(MOTION, "eta (gravity, velocity terms, friction) of the same", PINOCCHIO),
    "motion/reactions": Claim(MOTION, "forces and moments in all joints and on the base, 20 machines", PINOCCHIO),
    "motion/energies": Claim(MOTION, "kinetic energy and power lost to friction, 30 machines", PINOCCHIO),
    "springs/engine": Claim(
        MOTION, "accelerations of 200 random machines with springs in joints, in series and a suspension", PINOCCHIO
    ),
    "springs/frequencies": Claim(MOTION, "frequencies of 200 random machines with springs in their joints", PINOCCHIO),
    "springs/angles": Claim(MOTION, "angles of bending and twist in the joints of 200 random machines", PINOCCHIO),
    "springs/reactions": Claim(
        MOTION, "forces and moments in all joints and on the base of 20 machines with such springs", PINOCCHIO
    ),
    "motion/stored-engine": Claim(
        MOTION, "the engine itself: its accelerations at the stored states", STORED + " (not this library)"
    ),
    "theory/J_p": Claim(MOTION, "J_p as the theory's pages write it, both joint models", "those equations in NumPy"),
    "theory/J_b": Claim(MOTION, "J_b as the theory's pages write it, both joint models", "those equations in NumPy"),
    "theory/eta": Claim(MOTION, "eta as the theory's pages write it, both joint models", "those equations in NumPy"),
    "laws/power": Claim(
        LAWS, "rate of energy = power of actuators, wrench and base, less friction", DIFFERENCES, "of the largest power"
    ),
    "laws/virtual-work": Claim(LAWS, "H transposed maps the platform's twist to leg rates", "rates of the leg vectors"),
    "laws/leg-rates": Claim(LAWS, "leg rates and accelerations are derivatives of the lengths", DIFFERENCES),
    "laws/kinetic-energy": Claim(
        LAWS, "kinetic energy on a still base = half of twist times J_p", "energies summed over the bodies"
    ),
    "laws/frame": Claim(
        LAWS,
        "turning and moving the world and gravity changes nothing",
        "the same machine elsewhere",
        "eps cond(J_p)",
    ),
    "laws/uniform": Claim(
        LAWS, "a common velocity, and an acceleration shared with gravity, change nothing", "the law", "eps cond(J_p)"
    ),
    "laws/weight": Claim(LAWS, "accelerated together, platform and base feel weight (sign of E2)", "eta under gravity"),
    "laws/reference-point": Claim(
        LAWS, "another reference point of the platform: the same motion", "the law", "eps cond(J_p)"
    ),
    "laws/across": Claim(LAWS, "both joint models agree where legs stand across their axes", "each other"),
    "geometry/stored": Claim(GEOMETRY, "leg lengths at the 24 states", STORED),
    "geometry/lengths": Claim(GEOMETRY, "leg lengths of random machines", "distances by SciPy's rotations"),
    "geometry/forward": Claim(
        GEOMETRY, "poses found from lengths have these lengths, five machines", "inverse kinematics"
    ),
    "geometry/clearance": Claim(
        GEOMETRY,
        "distance of two legs, crossing and touching ones too",
        "SciPy's minimiser",
        "m (legs of 1 m)",
    ),
    "rest/tangent": Claim(
        REST, "M_b, C, C_b, K, K_b under gravity and load, both joint models", DIFFERENCES + " of the accelerations"
    ),
    "rest/hessian": Claim(REST, "K", "second differences of the potential energy"),
    "rest/closed-form": Claim(REST, "K of massless legs: springs, geometric stiffness, weight, load", "closed form"),
    "rest/together": Claim(
        REST, "base and platform displaced as one feel nothing but turned gravity", "weight of the turned machine"
    ),
    "rest/newton": Claim(REST, "equilibrium of a soft machine under load", "SciPy's root of the accelerations", "m"),
    "rest/stiffening": Claim(
        REST, "difference from Eq. 5 falls as 1/stiffness: tenfold legs, a tenth", "the ratio 10", "of the ratio"
    ),
    "rest/damping": Claim(REST, "damping ratios of massless legs", "closed form c omega / 2k"),
    "rest/state-space": Claim(
        REST, "the state space's frequency response", "M, C and K at each frequency (python-control)"
    ),
    "modes/stored": Claim(MODES, "all six at the 24 states", STORED),
    "modes/ordinary": Claim(MODES, "all six, five machines, both joint models", DIGITS, "eps cond(B)"),
    "modes/joint-springs": Claim(
        MODES, "all six with springs in joints, weak to stiff, at singular poses too", DIGITS, "eps cond(B)"
    ),
    "modes/near-singular": Claim(MODES, "all six near singular poses, cond(B) up to 1e8", DIGITS, "eps cond(B)"),
    "modes/sensitivities": Claim(
        MODES, "derivatives by masses, stiffnesses, joints", DIFFERENCES, "of omega + 10 |slope|"
    ),
    "modes/stiffness-law": Claim(MODES, "sum of K d(omega)/dK = omega/2", "Euler's theorem"),
    "published/appendix": Claim(
        PUBLISHED, "frequencies of manipulator II, five readings of the paper's Appendix A", "published table", "rad/s"
    ),
    "published/appendix-digits": Claim(PUBLISHED, "the same", DIGITS),
    "published/condition": Claim(PUBLISHED, "cond(H) = 136.7985 of manipulator II", "published table", "absolute"),
    "published/compliance": Claim(
        PUBLISHED, "compliance of a 20 N/um hexapod at a point", DEHAEZE, "half units of the last digit"
    ),
    "published/cube": Claim(
        PUBLISHED,
        "stiffness of four cubic hexapods (one entry lies exactly at a half)",
        DEHAEZE,
        "half units of the last digit",
    ),
    "published/lengths": Claim(PUBLISHED, "leg lengths of a tilted hexapod", "ROBOOP (four decimals)", "m"),
    "published/pose": Claim(
        PUBLISHED, "pose found from the printed lengths (5e-5 m, cond(H) = 40)", "ROBOOP", "m, and of R"
    ),
    "sweeps/omega": Claim(SWEEPS, "frequencies in every instruction set, cond(B) up to 1e10", DIGITS, "eps cond(B)"),
    "sweeps/joint-springs": Claim(
        SWEEPS, "frequencies with springs in joints, weak to stiff, cond(B) up to 1e10", DIGITS, "eps cond(B)"
    ),
    "sweeps/cond_H": Claim(SWEEPS, "cond(H) of the same", DIGITS, "eps cond(H)"),
    "sweeps/single": Claim(
        SWEEPS, "frequencies of 301 poses, three machines", "single poses by Jacobi rotations", "eps cond(B)"
    ),
    "sweeps/massless": Claim(SWEEPS, "frequencies with massless legs", "NumPy's singular values", "eps cond(B)"),
    "sweeps/gradient": Claim(SWEEPS, "gradient of the index by the pose", "single poses' exact derivatives"),
    "sweeps/worst": Claim(
        SWEEPS, "worst pose of a box, all packaged machines", "least of a sweep of 131072 poses", "ratio of indices"
    ),
    "sweeps/global": Claim(
        SWEEPS, "how much lower a global search gets than the worst pose of a box", "SciPy's differential evolution"
    ),
    "time/energy": Claim(
        TIME, "energy after 1000 periods of the lowest mode without friction", "conservation", "of the motion's energy"
    ),
    "time/works": Claim(
        TIME, "works of base, wrench, commands and friction balance the energy", "conservation", "of the largest work"
    ),
    "time/order": Claim(TIME, "halving the step divides the error by 2^8", "order 8", "orders"),
    "time/top": Claim(TIME, "orientation of a free symmetric top after ten seconds", "closed form", "of R"),
    "time/engine": Claim(TIME, "accelerations along a violent trajectory, 100 points", PINOCCHIO),
    "time/scipy": Claim(
        TIME, "trajectory with all six base motions", "SciPy in the inertial frame, quaternions", "m (of 1e-3)"
    ),
    "time/tangent": Claim(TIME, "small free vibration over ten periods", "the tangent's mode", "of the amplitude"),
    "time/statics": Claim(TIME, "slow loads and commands end in equilibrium", "static equilibrium", "of the travel"),
    "time/centrifugal": Claim(
        TIME,
        "a platform on a spinning base stays where it is balanced",
        "SciPy's root in the rotating frame",
        "of the displacement",
    ),
    "frequency/textbook": Claim(FREQUENCY, "transmissibility of one mass on springs, loss factor too", "closed form"),
    "frequency/digits": Claim(
        FREQUENCY, "relative response of a general machine", "40-digit arithmetic", "of the largest"
    ),
    "frequency/control": Claim(FREQUENCY, "all responses", "python-control on the state space", "of the largest"),
    "frequency/reciprocity": Claim(FREQUENCY, "compliance is symmetric", "Maxwell-Betti", "of the largest"),
    "frequency/white": Claim(
        FREQUENCY,
        "RMS under white noise, damping ratios from 5e-9",
        "closed form",
        "of 1e-9 and what the band leaves out",
    ),
    "frequency/lyapunov": Claim(
        FREQUENCY,
        "RMS of six modes under coupled noise",
        "Lyapunov equation (SciPy)",
        "of 1e-8 and the solver's own error",
    ),
    "frequency/structural": Claim(FREQUENCY, "RMS with structural damping alone", "closed form"),
    "frequency/stepped": Claim(
        FREQUENCY, "stepped sine of the non-linear machine, 1e-6 m and rad, six axes", "the tangent's response"
    ),
    "frequency/settled": Claim(
        FREQUENCY, "stepped sine at 1e-4 and 0.02 rad", "a simulation until all transients died"
    ),
    "frequency/fitted": Claim(
        FREQUENCY, "stepped sine with the paper's friction", "least squares on a simulation from rest"
    ),
    "frequency/quadratic": Claim(
        FREQUENCY, "its difference from the tangent grows as amplitude^2", "the exponent 2", "of the exponent"
    ),
    "frequency/peaks": Claim(FREQUENCY, "where its peaks lie", "the tangent's damped frequencies"),
    "design/slopes": Claim(DESIGN, "derivatives of frequencies by nine kinds of variables", "central differences"),
    "design/repeated": Claim(DESIGN, "slopes of a triple frequency along a direction", "frequencies nearby"),
    "design/height": Claim(DESIGN, "optimum where two modes meet", "closed form"),
    "design/isotropic": Claim(DESIGN, "best machine of massless legs", "the bound sqrt(2k/M) for any geometry"),
    "design/path-minimum": Claim(DESIGN, "least index on a path", "20001 samples"),
    "design/path-mean": Claim(DESIGN, "integral of the index along a path", "SciPy's quadrature"),
    "design/path-work": Claim(DESIGN, "work of the actuators along a path", "change of energy and friction's loss"),
    "design/ensemble": Claim(DESIGN, "frequencies of 37 designs at once", "one by one"),
    "design/uncertain": Claim(DESIGN, "mean index for an uncertain stiffness", "closed form"),
    "design/sobol": Claim(
        DESIGN, "shares of the variance (Sobol indices)", "closed form for small spreads", "absolute"
    ),
    "control/force": Claim(CONTROL, "poles with one force loop", PREUMONT, "of the largest"),
    "control/velocity": Claim(CONTROL, "poles with one velocity loop", PREUMONT, "of the largest"),
    "control/position": Claim(CONTROL, "poles of PD loops, three machines", "python-control", "of the largest"),
    "control/nonlinear": Claim(
        CONTROL, "RMS of the non-linear machine under six sampled controllers, with noise", "the tangent's prediction"
    ),
    "control/damper": Claim(
        CONTROL, "sampled velocity feedback tends to a damper as the sampling time", "the ratio 2", "of the ratio"
    ),
    "control/gamma": Claim(CONTROL, "H-infinity bound", "1.2 times python-control's least"),
}


class Ledger:
    """Takes down what tests measure, and holds each of them to the bound that the committed file names."""

    def __init__(self, committed: dict | None) -> None:
        self.committed = committed
        self.found: dict[str, dict] = {}

    def __call__(self, key: str, found: object, bound: float) -> None:
        """Asserts that every number found is below the bound in size; none may be NaN."""
        claim, worst = CLAIMS[key], float(np.max(np.abs(np.asarray(found))))
        entry = self.found.setdefault(key, {"found": 0.0, "bound": bound, "tests": []})
        assert entry["bound"] == bound, f"{key} has the bounds {entry['bound']} and {bound}; a claim has one"
        entry["found"] = max(entry["found"], worst)
        test = os.environ["PYTEST_CURRENT_TEST"].split("[")[0].split(" (")[0]
        if test not in entry["tests"]:
            entry["tests"].append(test)
        assert worst < bound, (
            f"{claim.claim}, against {claim.against}: {worst:.3g} is not below {bound:.3g} {claim.unit}"
        )
        if self.committed is not None:
            written = self.committed.get(key)
            assert written is not None, f"docs/validation.json has no {key}. {RENEW}"
            assert written["bound"] == bound, (
                f"docs/validation.json has the bound {written['bound']} for {key}. {RENEW}"
            )
            assert test in written["tests"], f"docs/validation.json does not have {test} for {key}. {RENEW}"

    def write(self, path: Path) -> None:
        """The whole table. Raises ValueError where a claim was never measured."""
        missing = [key for key in CLAIMS if key not in self.found]
        if missing:
            raise ValueError(f"no test measured {', '.join(missing)}")
        where = {
            "python": platform.python_version(),
            "numpy": np.__version__,
            "machine": f"{platform.system()} {platform.machine()}",
        }
        rows = [{"key": key, **claim._asdict(), **self.found[key]} for key, claim in CLAIMS.items()]
        path.write_text(json.dumps({"measured_on": where, "claims": rows}, indent=1) + "\n", encoding="utf-8")


def committed() -> dict[str, dict]:
    """Rows of docs/validation.json by key."""
    return {row["key"]: row for row in json.loads(FILE.read_text(encoding="utf-8"))["claims"]}
