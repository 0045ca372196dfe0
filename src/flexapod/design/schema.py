"""The keys of a design file: what each one means, its unit, its shapes and its range."""

from flexapod.design.drive_keys import drive_keys
from flexapod.design.key import ANY, Key

_ONE: tuple[tuple[int, ...], ...] = ((),)
_LEGS: tuple[tuple[int, ...], ...] = ((), (6,))
_VECTOR = ((3,),)
_NODES = ((ANY,),)
_JOINTS = ((6, 3),)
_INERTIA = "Write the same number on both sides of the diagonal; principal moments alone may be given as three numbers."
_FLAT_ANGLE = 3.141592653589793
_ROW_REMEDY = "Give one row [x, y, z] for each of the six legs."
_ANGLE_REMEDY = "If the number is in degrees, put _deg at the end of the key."


def _part(joint: str) -> dict[str, Key]:
    """The keys of one leg part; `joint` is where its mass centre is measured from."""
    return {
        "mass": Key(
            "mass of this part of the leg",
            "mass",
            _LEGS,
            "Give a mass that is not negative; leave legs.lower and legs.upper both out for massless legs.",
            least=0.0,
        ),
        "mass_center": Key(f"mass centre from the {joint}, leg axes", "length", ((3,), (6, 3))),
        "inertia": Key(
            "inertia about the part's own mass centre, leg axes",
            "inertia",
            ((3, 3), (6, 3, 3)),
            _INERTIA,
            symmetric=True,
        ),
        "rod.mass": Key("mass of a uniform round rod", "mass", _LEGS, "A rod has a mass > 0.", least=0.0, open_=True),
        "rod.length": Key(
            f"length of the rod, which starts at the {joint} and lies along the leg",
            "length",
            _LEGS,
            "A rod has a length > 0.",
            least=0.0,
            open_=True,
        ),
        "rod.radius": Key("radius of the rod", "length", _LEGS, "Leave it out for a thin rod.", least=0.0),
        "rod.bending_stiffness": Key(
            "Young's modulus times second moment of area, for the frequency at which the leg bends",
            "bending stiffness",
            _LEGS,
            "In N m2; a tube of radii R and r has pi E (R^4 - r^4) / 4.",
            least=0.0,
            open_=True,
        ),
    }


def _law() -> dict[str, Key]:
    """The numbers of the laws of stiffness: of a screw, of two columns of oil, of a table."""

    def positive(meaning: str, dimension: str, remedy: str, least: float = 0.0, open_: bool = True) -> Key:
        return Key(meaning, dimension, _LEGS, remedy, least=least, open_=open_)

    chamber = "Give the area of the piston on that side, less that of the rod."
    dead = "Some oil is left in ports and hoses: give its volume over the area, which is > 0."
    return {
        "fixed": positive("stiffness that does not change with the length", "stiffness", "Give that of the nut."),
        "axial_rigidity": positive(
            "Young's modulus times cross section", "force", "In N; for steel 2.1e11 Pa times the area in m2."
        ),
        "zero_length": positive(
            "length of the leg at which only the fixed stiffness is left", "length", "Give a length >= 0.", open_=False
        ),
        "bulk_modulus": positive("bulk modulus of the oil", "pressure", "Oil with some air has about 1.4e9 Pa."),
        "area": positive("area of both chambers", "area", chamber),
        "area_1": positive("area in the chamber that lengthens the leg", "area", chamber),
        "area_2": positive(
            "area in the chamber that shortens the leg", "area", "Give 0 for one chamber only.", open_=False
        ),
        "dead_1": positive("column left in the first chamber where the leg is shortest", "length", dead),
        "dead_2": positive("column left in the second chamber where the leg is longest", "length", dead),
        "stroke": positive("longest minus shortest leg", "length", "Give a stroke > 0."),
        "shortest": positive("shortest leg", "length", "Give the length between the joints at the lower end."),
        "lengths": Key(
            "lengths of a table of stiffnesses", "length", _NODES, "Give rising lengths > 0.", least=0.0, open_=True
        ),
        "stiffnesses": Key(
            "axial stiffness at each of the lengths",
            "stiffness",
            _NODES,
            "A leg without stiffness holds nothing.",
            least=0.0,
            open_=True,
        ),
    }


def _circle(plate: str) -> dict[str, Key]:
    pairs = "60, 180 and 300" if plate == "base" else "0, 120 and 240"
    return {
        "radius": Key(
            f"radius of the {plate}'s joint circle", "length", _ONE, "Give a radius > 0.", least=0.0, open_=True
        ),
        "angles": Key(
            f"angles of the six {plate} joints about z, from x",
            "angle",
            ((6,),),
            _ANGLE_REMEDY,
            least=-4 * _FLAT_ANGLE,
            most=4 * _FLAT_ANGLE,
        ),
        "half_angle": Key(
            f"half the angle between the joints of a pair; the pairs are at {pairs} degrees",
            "angle",
            _ONE,
            _ANGLE_REMEDY,
            least=0.0,
            most=_FLAT_ANGLE / 3,
        ),
        "height": Key(f"z of the six {plate} joints", "length", _ONE),
    }


def _under(table: str, keys: dict[str, Key]) -> dict[str, Key]:
    return {f"{table}.{key}": rule for key, rule in keys.items()}


_DAMPING = Key(
    "viscous friction", "angular damping", _LEGS, "Give 0 for a joint without friction.", least=0.0, default=0.0
)

_LOSS = Key(
    "structural loss factor",
    None,
    _LEGS,
    "It is about 0.01 to 0.05 for machines; 2 times the damping ratio.",
    least=0.0,
    most=10.0,
    default=0.0,
)


def _joint_stiffness(meaning: str, shapes: tuple[tuple[int, ...], ...] = _LEGS) -> Key:
    remedy = "Give 0 for a joint that turns freely."
    return Key(meaning, "angular stiffness", shapes, remedy, least=0.0, default=0.0, pair="[first axis, second axis]")


def _suspension(what: str) -> Key:
    remedy = "Write the same number on both sides of the diagonal; SI units, translations before rotations."
    return Key(f"{what} between base and platform, axes of the base, SI units", None, ((6, 6),), remedy, symmetric=True)


KEYS: dict[str, Key] = {
    "gravity": Key("gravity, inertial frame", "acceleration", _VECTOR),
    "base.joints": Key("base joints, base frame", "length", _JOINTS, _ROW_REMEDY),
    "base.universal_axes": Key("axes of the universal joints fixed in the base", None, _JOINTS, _ROW_REMEDY),
    **_under("base.circle", _circle("base")),
    "platform.joints": Key("platform joints, platform frame", "length", _JOINTS, _ROW_REMEDY),
    **_under("platform.circle", _circle("platform")),
    "platform.mass": Key(
        "platform with payload",
        "mass",
        _ONE,
        "Give the mass of platform and payload together.",
        least=0.0,
        open_=True,
    ),
    "platform.mass_center": Key("mass centre, platform frame", "length", _VECTOR),
    "platform.inertia": Key(
        "inertia about the mass centre, platform axes",
        "inertia",
        ((3, 3),),
        _INERTIA,
        symmetric=True,
    ),
    "legs.stiffness": Key(
        "axial stiffness",
        "stiffness",
        _LEGS,
        "A leg without stiffness holds nothing: give that of actuator, joints and mounts in series.",
        too_large="Use a large finite value for a rigid leg.",
        least=0.0,
        open_=True,
    ),
    "legs.series_stiffness": Key(
        "further axial springs in series with the leg",
        "stiffness",
        ((ANY,), (), (6, ANY)),
        "Leave out what is rigid; a spring of no stiffness holds nothing.",
        too_large="Leave out what is rigid.",
        least=0.0,
        open_=True,
    ),
    "legs.loss_factor": _LOSS,
    "legs.damping.prismatic": Key(
        "viscous friction along the leg", "damping", _LEGS, "Give 0 for a leg without friction.", least=0.0, default=0.0
    ),
    "legs.damping.universal": _DAMPING,
    "legs.damping.spherical": _DAMPING,
    "legs.joint_stiffness.universal": _joint_stiffness(
        "rotational stiffness of the base joint about its two axes", ((2,), (), (6,), (6, 2))
    ),
    "legs.joint_stiffness.spherical": _joint_stiffness("bending stiffness of the platform joint, across the leg"),
    "legs.joint_stiffness.torsion": _joint_stiffness("torsional stiffness between leg and platform, about the leg"),
    "legs.joint_stiffness.loss_factor": _LOSS,
    "legs.joint_rest.position": Key(
        "platform frame's origin where joints and suspension are without force, base frame", "length", _VECTOR
    ),
    "legs.joint_rest.orientation": Key(
        "roll, pitch, yaw where joints and suspension are without force",
        "angle",
        _VECTOR,
        _ANGLE_REMEDY,
        least=-2 * _FLAT_ANGLE,
        most=2 * _FLAT_ANGLE,
    ),
    **_under("legs.stiffness_law", _law()),
    **_under("legs.lower", _part("base joint")),
    **_under("legs.upper", _part("platform joint")),
    "limits.leg_length": Key(
        "shortest and longest leg",
        "length",
        ((2,), (6, 2)),
        "Give [min, max] of the distance between the leg's two joints.",
        least=0.0,
    ),
    "limits.universal_angle": Key(
        "cone half angle at the base joints",
        "angle",
        _ONE,
        _ANGLE_REMEDY,
        least=0.0,
        most=_FLAT_ANGLE,
        open_=True,
    ),
    "limits.spherical_angle": Key(
        "cone half angle at the platform joints",
        "angle",
        _ONE,
        _ANGLE_REMEDY,
        least=0.0,
        most=_FLAT_ANGLE,
        open_=True,
    ),
    "limits.leg_distance": Key(
        "least distance between leg axes", "length", _ONE, "Leave it out for no limit.", least=0.0
    ),
    "limits.universal_moment": Key(
        "largest bending moment of a base joint's stiffness",
        "moment",
        _ONE,
        "Leave it out for no limit.",
        least=0.0,
        open_=True,
    ),
    "limits.spherical_moment": Key(
        "largest bending moment of a platform joint's stiffness",
        "moment",
        _ONE,
        "Leave it out for no limit.",
        least=0.0,
        open_=True,
    ),
    "limits.leg_compression": Key(
        "greatest force with which a leg pushes", "force", _ONE, "Leave it out for no limit.", least=0.0
    ),
    "limits.leg_tension": Key(
        "greatest force with which a leg pulls", "force", _ONE, "Leave it out for no limit.", least=0.0
    ),
    "limits.leg_rate": Key(
        "greatest speed of a leg's extension", "velocity", _ONE, "Give a speed > 0.", least=0.0, open_=True
    ),
    "limits.leg_acceleration": Key(
        "greatest acceleration of a leg's extension",
        "acceleration",
        _ONE,
        "Give an acceleration > 0.",
        least=0.0,
        open_=True,
    ),
    "limits.leg_power": Key(
        "greatest mechanical power of a leg's actuator", "power", _ONE, "Give a power > 0.", least=0.0, open_=True
    ),
    **_under("drive", drive_keys()),
    "suspension.stiffness": _suspension("stiffness"),
    "suspension.damping": _suspension("damping"),
    "suspension.point": Key("point that the suspension acts at, platform frame", "length", _VECTOR),
    "home.turned.position": Key(
        "platform frame's origin at home before it is turned about the pivot, base frame", "length", _VECTOR
    ),
    "home.turned.angles": Key(
        "angles of home in the order of rotation_order, the first turn first", "angle", _VECTOR, _ANGLE_REMEDY
    ),
    "home.turned.pivot": Key("point that the angles turn the platform about, platform frame", "length", _VECTOR),
    "home.position": Key("platform frame's origin at home, base frame", "length", _VECTOR),
    "home.orientation": Key(
        "roll, pitch, yaw at home about the fixed axes x, y, z",
        "angle",
        _VECTOR,
        _ANGLE_REMEDY,
        least=-2 * _FLAT_ANGLE,
        most=2 * _FLAT_ANGLE,
    ),
    "cubic.edge": Key("edge of the cube", "length", _ONE, "Give an edge > 0.", least=0.0, open_=True),
    "cubic.height": Key(
        "common height of the six edges, edge / sqrt(3)", "length", _ONE, "Give a height > 0.", least=0.0, open_=True
    ),
    "cubic.middle": Key(
        "share of each edge between its two joints",
        None,
        _ONE,
        "Give a share between 0 and 1, such as 0.7; at 1 neighbouring legs meet at common joints.",
        least=0.0,
        most=1.0,
        open_=True,
    ),
    "cubic.center_in_base": Key("cube's centre, base frame", "length", _VECTOR),
    "cubic.center_in_platform": Key("cube's centre, platform frame, at home", "length", _VECTOR),
}


POINTS = "points"  #: the table whose keys are names of the user's own
POINT = Key("point of the platform under a name of your own, platform frame", "length", _VECTOR)


def rule_of(key: str) -> Key:
    """The rule of a dotted key that holds numbers; those of `points` are the user's own names."""
    return POINT if key.startswith(f"{POINTS}.") else KEYS[key]


def is_of_each_leg(key: str) -> bool:
    """Whether six values may be given, one for each leg, in place of one of the first shape."""
    return key.startswith(("legs.", "drive.")) and (6, *KEYS[key].shapes[0]) in KEYS[key].shapes


#: Keys whose values are text, with an example of each.
TEXT_KEYS = {
    "name": "my hexapod",
    "joints.csv": "joints.csv",
    "home.turned.rotation_order": "XYZ",
    "legs.stiffness_law.kind": "screw",
}
TABLES = frozenset(
    key.rsplit(".", depth)[0] for key in {*KEYS, *TEXT_KEYS} for depth in range(1, key.count(".") + 1)
) | {POINTS}
