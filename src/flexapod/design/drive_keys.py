"""The keys of `[drive]`: screw, gear and motor of the legs."""

from flexapod.design.key import ANY, Key

_LEGS: tuple[tuple[int, ...], ...] = ((), (6,))
_CURVE = ((ANY,),)
_SHARE = "Give a share of 1, such as 0.9 for 90 %."


def drive_keys() -> dict[str, Key]:
    """The keys below `drive`, with their rules."""
    return {
        "lead": Key(
            "lead of the screw: travel of the leg for one turn of the screw", "length", _LEGS, "Give a lead > 0.",
            least=1e-6, most=1e3,
        ),
        "gear_ratio": Key(
            "turns of the motor for one turn of the screw", None, _LEGS, "Leave it out for a motor on the screw.",
            least=1e-6, most=1e6,
        ),
        "efficiency": Key(
            "efficiency of the screw where the motor drives the leg", None, _LEGS, _SHARE, least=1e-3, most=1.0
        ),
        "back_efficiency": Key(
            "efficiency of the screw where the leg's force drives it; the screw locks itself at <= 0", None, _LEGS,
            "Leave it out for 2 - 1 / efficiency, of the same friction.", least=-1e3, most=1.0,
        ),
        "gear_efficiency": Key(
            "efficiency of the gear, in both directions", None, _LEGS, _SHARE, least=1e-3, most=1.0
        ),
        "rotor_inertia": _inertia("the motor's rotor, and of what turns with it (brake, coupling)"),
        "gear_inertia": _inertia("the gear, at the motor's shaft"),
        "screw_inertia": _inertia("the screw or nut, whichever turns, and of what turns with it"),
        "motor.speeds": Key(
            "speeds at which the motor's torques are given, from 0 on", "angular velocity", _CURVE,
            "Give rising speeds from 0 on, at least two; put _rpm at the end of the key for turns a minute.", least=0.0,
        ),
        "motor.peak_torques": _torques("short-time (peak)"),
        "motor.continuous_torques": _torques("continuous (thermal)"),
        "motor.max_speed": Key(
            "greatest speed allowed, of motor or screw at the motor's shaft", "angular velocity", _LEGS,
            "Leave it out for the last of the speeds.", least=0.0, open_=True,
        ),
    }  # fmt: skip


def _inertia(what: str) -> Key:
    return Key(f"moment of inertia of {what}", "inertia", _LEGS, "Leave it out for 0.", least=0.0)


def _torques(which: str) -> Key:
    return Key(f"{which} torque of the motor at each of the speeds", "moment", _CURVE, "Torques are >= 0.", least=0.0)
