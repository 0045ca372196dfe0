"""Machines as MuJoCo and Pinocchio load them from the files that Flexapod wrote, for `reduced.tangent`."""

import json
import xml.etree.ElementTree as ET
from functools import cached_property
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
from tests.oracles.reduced import Tree

WORLD_AXES = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
STEP = 1e-4


class Mujoco:
    """An MJCF file in MuJoCo. `gravity=False` takes the weight away and the springs' preload with it."""

    def __init__(self, file: Path, size: float, gravity: bool = True) -> None:
        self.model = mujoco.MjModel.from_xml_path(str(file))
        self.model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        if not gravity:
            self.model.opt.gravity = 0
            self.model.qpos_spring = self.model.qpos0
        self.data = mujoco.MjData(self.model)
        self.start = self.model.qpos0.copy()
        free = self.model.joint("platform").dofadr[0]
        self.chosen = np.arange(free, free + 6)
        self.steps = STEP * np.array([size, size, size, 1, 1, 1])

    def tree(self, q) -> Tree:
        model, data = self.model, self.data
        data.qpos, data.qvel = q, 0
        mujoco.mj_forward(model, data)
        mass = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, mass)
        equality = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
        assert equality.all()  # no joint limit, no contact
        platform = np.zeros((6, model.nv))
        mujoco.mj_jacBody(model, data, platform[:3], platform[3:], model.body("platform").id)
        closure, gap = data.efc_J.reshape(-1, model.nv).copy(), data.efc_pos.copy()
        force = data.qfrc_passive - data.qfrc_bias
        return Tree(mass, force, np.diag(model.dof_damping), closure, gap, platform)

    def moved(self, q, dv) -> np.ndarray:
        moved = q.copy()
        mujoco.mj_integratePos(self.model, moved, dv, 1)
        return moved


class Pinocchio:
    """A tree in Pinocchio, closed at points. `chosen`: the joints whose velocities stand for the mechanism's."""

    def __init__(self, model, chosen: list[str], size: float) -> None:
        self.model = model
        self.springs: list[tuple[int, float, float]] = []  # joint, stiffness, rest
        self.closures: list[tuple[int, int, float, np.ndarray, np.ndarray]] = []  # frames, friction, springs
        first = [model.joints[model.getJointId(name)] for name in chosen]
        self.chosen = np.concatenate([np.arange(joint.idx_v, joint.idx_v + joint.nv) for joint in first])
        self.start = pin.neutral(model)
        self.steps = STEP * np.where([name.endswith("slide") for name in chosen], size, 1)

    def spring(self, joint: str, stiffness: float, rest: float) -> None:
        self.springs.append((self.model.getJointId(joint), stiffness, rest))

    def close(self, ends, friction: float, stiffness=0, rest=0) -> None:
        """Two ends of a loop that meet: for each, a link and a point of it.

        stiffness, rest: of springs about the axes of the first link against turns of the second.
        """
        frames = []
        for link, point in ends:
            frame = self.model.frames[self.model.getFrameId(link)]
            placement = frame.placement * pin.SE3(np.eye(3), np.array(point))
            name = f"end {len(self.model.frames)}"
            frames.append(self.model.addFrame(pin.Frame(name, frame.parentJoint, placement, pin.OP_FRAME)))
        self.closures.append((*frames, friction, np.broadcast_to(stiffness, 3), np.broadcast_to(rest, 3)))

    @cached_property
    def data(self):
        return self.model.createData()

    def tree(self, q) -> Tree:
        model, data = self.model, self.data
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        upper = np.triu(pin.crba(model, data, q))
        force = -pin.computeGeneralizedGravity(model, data, q)
        for joint, stiffness, rest in self.springs:
            at = model.joints[joint].idx_q
            turned = np.arctan2(q[at + 1], q[at]) if model.joints[joint].nq == 2 else q[at]  # a hinge without limits
            force[model.joints[joint].idx_v] -= stiffness * (turned - rest)
        damping, closure, gap = np.diag(model.damping), [], []
        for a, b, friction, stiffness, rest in self.closures:
            between = self._jacobian(a) - self._jacobian(b)
            if np.any(stiffness):
                turned = data.oMf[a].rotation.T @ data.oMf[b].rotation @ self._started(a, b).T
                force += between[3:].T @ data.oMf[a].rotation @ (stiffness * (pin.log3(turned) - rest))
            closure.append(between[:3])
            gap.append(data.oMf[a].translation - data.oMf[b].translation)
            damping = damping + friction * between[3:].T @ between[3:]
        platform = self._jacobian(model.getFrameId("platform"))
        return Tree(upper + np.triu(upper, 1).T, force, damping, np.vstack(closure), np.concatenate(gap), platform)

    def _started(self, a: int, b: int) -> np.ndarray:
        """Rotation of one frame against another at the start."""
        data = self.model.createData()
        pin.framesForwardKinematics(self.model, data, self.start)
        return data.oMf[a].rotation.T @ data.oMf[b].rotation

    def _jacobian(self, frame: int) -> np.ndarray:
        return pin.getFrameJacobian(self.model, self.data, frame, WORLD_AXES)

    def moved(self, q, dv) -> np.ndarray:
        return pin.integrate(self.model, q, dv)


def urdf(file: Path, size: float, gravity: bool = True) -> Pinocchio:
    """A URDF file, and the closures and springs beside it."""
    beside = json.loads(file.with_suffix(".loops.json").read_text())
    first = [f"leg1_{joint}" for joint in ("universal_k", "universal_y", "slide")]
    loaded = Pinocchio(pin.buildModelFromUrdf(str(file)), [*first, *beside["platform_joints"]], size)
    loaded.model.gravity.linear = np.array(beside["gravity"]) * gravity
    for spring in beside["springs"]:
        loaded.spring(spring["joint"], spring["stiffness"], spring["rest_position"] * gravity)
    for closure in beside["closures"]:
        ends = [(closure[f"link_{side}"], closure[f"point_{side}"]) for side in "ab"]
        stiffness, rest = (np.array(closure.get(f"spherical_{key}", np.zeros(3))) for key in ("stiffness", "rest"))
        loaded.close(ends, closure["spherical_damping"], stiffness, rest * gravity)
    return loaded


def sdf(file: Path, size: float, gravity: bool = True) -> Pinocchio:
    """An SDF file, read element by element as the format's specification says."""
    world = ET.parse(file).getroot().find("world")
    model = pin.Model()
    model.gravity.linear = _numbers(world, "gravity") * gravity
    links = {link.get("name"): link for link in world.iter("link")}
    placed = {name: _pose(link) if name != "base" else pin.SE3.Identity() for name, link in links.items()}
    carrier = {"base": 0}
    damping: list[float] = [0.0] * 6
    hinges = []
    carrier["platform"] = model.addJoint(0, pin.JointModelFreeFlyer(), placed["platform"], "platform_free")
    for joint in world.iter("joint"):
        kind, name, parent, child = (
            joint.get("type"),
            joint.get("name"),
            joint.findtext("parent"),
            joint.findtext("child"),
        )
        if kind not in ("universal", "prismatic"):
            continue
        between = placed[parent].inverse() * placed[child]  # the joint's frame is its child's
        make = pin.JointModelPrismaticUnaligned if kind == "prismatic" else pin.JointModelRevoluteUnaligned
        index = carrier[parent]
        for axis in [each for each in joint if each.tag in ("axis", "axis2")]:
            index = model.addJoint(index, make(_numbers(axis, "xyz")), between, f"{name}_{axis.tag}")
            between = pin.SE3.Identity()
            damping.append(float(axis.findtext("dynamics/damping")))
            if axis.find("dynamics/spring_stiffness") is not None and kind == "universal":
                hinges.append((f"{name}_{axis.tag}", axis.find("dynamics")))
        carrier[child] = index
    for name, index in carrier.items():
        if index:
            model.appendBodyToJoint(index, _body(links[name].find("inertial")), pin.SE3.Identity())
            model.addFrame(pin.Frame(name, index, pin.SE3.Identity(), pin.BODY))
    model.damping = np.array(damping)
    loaded = Pinocchio(model, ["platform_free"], size)
    loaded.steps = STEP * np.array([size, size, size, 1, 1, 1])
    for name, dynamics in hinges:
        stiffness, rest = (float(dynamics.findtext(f"spring_{key}")) for key in ("stiffness", "reference"))
        loaded.spring(name, stiffness, rest * gravity)
    for joint in world.iter("joint"):
        if joint.get("type") == "prismatic":
            stiffness, rest = (joint.findtext(f"axis/dynamics/spring_{key}") for key in ("stiffness", "reference"))
            loaded.spring(f"{joint.get('name')}_axis", float(stiffness), float(rest) * gravity)
        elif joint.get("type") == "ball":
            point = _numbers(joint, "pose")[:3]
            end = (placed[joint.findtext("parent")].inverse() * placed["platform"]).act(point)
            loaded.close([(joint.findtext("parent"), end), (joint.findtext("child"), point)], 0.0)
    return loaded


def _numbers(element, tag: str) -> np.ndarray:
    return np.array([float(number) for number in element.findtext(tag).split()])


def _pose(element) -> pin.SE3:
    six = _numbers(element, "pose")
    return pin.SE3(pin.rpy.rpyToMatrix(six[3:]), six[:3])


def _body(inertial) -> pin.Inertia:
    names = (("xx", "xy", "xz"), ("xy", "yy", "yz"), ("xz", "yz", "zz"))
    inertia = np.array([[float(inertial.findtext(f"inertia/i{name}")) for name in row] for row in names])
    return pin.Inertia(float(inertial.findtext("mass")), _numbers(inertial, "pose")[:3], inertia)
