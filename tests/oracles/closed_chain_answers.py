"""What Pinocchio answers for the states on which the paper's errors are shown: `src/flexapod/paper/engine.json`.

Run as a script it writes the file anew; test_paper.py checks that the stored answers are what the engine gives.
"""

import json
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation
from tests.oracles.closed_chain import ClosedChain

import flexapod as fx

FILE = Path(fx.__file__).parent / "paper" / "engine.json"
GOLDEN = Path(__file__).parents[1] / "data" / "golden.json"
NOTE = (
    "Accelerations of the platform by Pinocchio (closed chain of rigid bodies, exact universal joints). SI units, "
    "inertial axes; rotation takes body axes to inertial axes; force and moment in the platform's axes. Written by "
    "tests/oracles/closed_chain_answers.py."
)
NAMES = {"I": "mukherjee-i", "II": "mukherjee-ii"}
RATES = ("velocity", "angular_velocity", "acceleration", "angular_acceleration")
STEP = 1e-4  # of the leg's length (m) and rad: central differences then err by about its square


def cases() -> dict[str, list[dict]]:
    """Every state without its answer, by what it is for."""
    return {
        "moving": moving(),
        "spinning base": [spinning_base()],
        "carried": [carried()],
        "soft legs": soft_legs(),
    }


def moving() -> list[dict]:
    """The stored states of tests/data/golden.json with exact joints: everything moves at about 1 rad/s."""
    found = []
    for case in json.loads(GOLDEN.read_text(encoding="utf-8"))["cases"]:
        if case["joint"] != "universal":
            continue
        machine, mass = case["design"].split(" M=")
        loads = [case[key] for key in ("leg_force", "force_platform_frame", "moment_platform_frame")]
        bodies = [_golden_motion(case[body]) for body in ("platform", "base")]
        found.append(_case(NAMES[machine], {"platform.mass": float(mass)}, *bodies, *loads))
    return found


def _golden_motion(body: dict) -> fx.Motion:
    return fx.Motion(fx.Pose(body["position"], body["rotation"]), **{key: body[key] for key in RATES if key in body})


def spinning_base() -> dict:
    """Manipulator I on a turntable at 5 rad/s, turning with it, with stiff grease in the universal joints."""
    changes = {"legs.damping.universal": 2.0}
    hexapod, pose = fx.load("mukherjee-i").replace(changes), fx.Pose([0.1, 0.2, 0.8])
    spin = np.array([0.0, 0.0, 5.0])
    platform = fx.Motion(pose, np.cross(spin, pose.position), spin)
    base = fx.Motion(fx.Pose([0.0, 0.0, 0.0]), angular_velocity=spin)
    return _case("mukherjee-i", changes, platform, base, fx.hold(hexapod, pose).leg_force)


def carried() -> dict:
    """Manipulator I carried rigidly by a base that has turned for 1 s at a constant angular velocity from upright."""
    w, pose = np.array([0.5, 0.4, 0.6]), fx.Pose([0.1, 0.2, 0.8])
    R = Rotation.from_rotvec(w).as_matrix()
    held = fx.hold(fx.load("mukherjee-i"), pose).leg_force
    at = R @ pose.position
    platform = fx.Motion(fx.Pose(at, R), np.cross(w, at), w)
    base = fx.Motion(fx.Pose(np.zeros(3), R), angular_velocity=w)
    return _case("mukherjee-i", {}, platform, base, held)


def soft_legs() -> list[dict]:
    """Manipulator II on legs of 8000 N/m at rest, displaced either way along and about x, y, z by small steps."""
    changes = {"legs.stiffness": 8e3}
    hexapod, pose = fx.load("mukherjee-ii").replace(changes), fx.Pose([0.0, 0.0, 0.085])
    rest = fx.hold(hexapod, pose)
    found = []
    for step in np.diag(STEP * np.array([0.1, 0.1, 0.1, 1.0, 1.0, 1.0])):
        for x in (step, -step):
            moved = fx.Pose(pose.position + x[:3], Rotation.from_rotvec(x[3:]))
            stretch = fx.inverse_kinematics(hexapod, moved) - rest.unstretched_length
            still = fx.Motion.fixed()
            found.append(_case("mukherjee-ii", changes, fx.Motion(moved), still, -hexapod.legs.stiffness * stretch))
    return found


def _case(design, changes, platform, base, leg_force, force=(0.0,) * 3, moment=(0.0,) * 3) -> dict:
    return {
        "design": design,
        "changes": changes,
        "platform": _plain(platform, RATES[:2]),
        "base": _plain(base, RATES),
        "leg_force": np.asarray(leg_force).tolist(),
        "force": list(force),
        "moment": list(moment),
    }


def _plain(motion: fx.Motion, rates) -> dict:
    pose = {"position": motion.pose.position.tolist(), "rotation": motion.pose.matrix.tolist()}
    return pose | {name: getattr(motion, name).tolist() for name in rates}


def answer(case: dict) -> np.ndarray:
    """(6,) acceleration of the platform by the engine."""
    hexapod = fx.load(case["design"]).replace(case["changes"])
    platform, base = (_golden_motion(case[body]) for body in ("platform", "base"))
    loads = [np.array(case[name]) for name in ("leg_force", "force", "moment")]
    return np.concatenate(ClosedChain(hexapod).acceleration(platform, base, *loads))


def main() -> None:
    answered = {kind: [case | {"engine": answer(case).tolist()} for case in listed] for kind, listed in cases().items()}
    lines = ",\n".join(
        f" {json.dumps(kind)}: [\n" + ",\n".join(f"  {json.dumps(case)}" for case in listed) + "\n ]"
        for kind, listed in answered.items()
    )
    FILE.write_text(f'{{\n "note": {json.dumps(NOTE)},\n{lines}\n}}\n', encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
