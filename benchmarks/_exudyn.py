"""Exudyn on the same machine: a free platform and six kinematic trees (two hinges, one slide) tied to it.

Trees have minimal coordinates, which is the quickest of Exudyn's ways to write this machine: 24 coordinates and 18
constraints. The leg's spring and friction are the slide's proportional and differential control.
"""

from __future__ import annotations

import time
from typing import Any

import exudyn as exu
import exudyn.utilities
import numpy as np
from exudyn import itemInterface as item

import flexapod as fx

STEPS = (1e-4, 5e-5, 3e-5, 2.5e-5, 2.2e-5, 2e-5, 1e-5)  # s


class Machine:
    """A machine on a fixed base, at rest at a pose. A force and moment on the platform start at t = 0."""

    def __init__(self, hexapod: fx.Hexapod, pose: fx.Pose, wrench: Any = (0.0,) * 6) -> None:
        self.pose = pose
        self.container = exu.SystemContainer()
        self.system = self.container.AddSystem()
        platform = self._platform(hexapod, pose, np.asarray(wrench))
        rest = fx.hold(hexapod, pose)
        for i in range(6):
            tree = self._leg(hexapod, pose, i, float(rest.leg_force[i]))
            end = self.system.AddMarker(item.MarkerKinematicTreeRigid(objectNumber=tree, linkNumber=2))
            socket = item.MarkerBodyRigid(bodyNumber=platform, localPosition=hexapod.platform_joints[i])
            self.system.AddObject(item.ObjectJointSpherical(markerNumbers=[end, self.system.AddMarker(socket)]))
        self.system.Assemble()

    def _platform(self, hexapod: fx.Hexapod, pose: fx.Pose, wrench: Any) -> int:
        """The platform's coordinates are its displacement and rotation vector from the pose."""
        mbs = self.system
        inertia = exu.utilities.RigidBodyInertia(
            mass=hexapod.platform_mass,
            inertiaTensor=hexapod.platform_inertia,
            com=hexapod.platform_mass_center,
            inertiaTensorAtCOM=True,
        )
        made = mbs.CreateRigidBody(
            referencePosition=pose.position,
            referenceRotationMatrix=pose.matrix,
            inertia=inertia,
            gravity=hexapod.gravity,
            nodeType=exu.NodeType.RotationRotationVector,
            returnDict=True,
        )
        self.node = made["nodeNumber"]
        marker = mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=made["bodyNumber"]))
        mbs.AddLoad(item.LoadForceVector(markerNumber=marker, loadVector=wrench[:3]))
        mbs.AddLoad(item.LoadTorqueVector(markerNumber=marker, loadVector=wrench[3:]))
        return int(made["bodyNumber"])

    def _leg(self, hexapod: fx.Hexapod, pose: fx.Pose, i: int, force: float) -> int:
        start, k = hexapod.base_joints[i], hexapod.universal_axes[i]
        S = pose.position + pose.matrix @ hexapod.platform_joints[i] - start
        length = float(np.linalg.norm(S))
        s = S / length
        y = np.cross(k, s) / np.linalg.norm(np.cross(k, s))
        cross = np.column_stack([np.cross(y, k), y, k])  # the universal joint's cross: hinges about z, then y
        axes = np.column_stack([s, y, np.cross(s, y)])
        legs = hexapod.legs
        parts = [(part.mass[i], part.mass_center[i], part.inertia[i]) for part in (legs.lower, legs.upper)]
        parts.insert(0, (0.0, np.zeros(3), np.zeros((3, 3))))
        friction = legs.damping.universal[i]
        node = self.system.AddNode(
            item.NodeGenericODE2(
                referenceCoordinates=[0.0] * 3,
                initialCoordinates=[0.0] * 3,
                initialCoordinates_t=[0.0] * 3,
                numberOfODE2Coordinates=3,
            )
        )
        return int(
            self.system.AddObject(
                item.ObjectKinematicTree(
                    nodeNumber=node,
                    gravity=hexapod.gravity,
                    jointTypes=[exu.JointType.RevoluteZ, exu.JointType.RevoluteY, exu.JointType.PrismaticX],
                    linkParents=[-1, 0, 1],
                    jointTransformations=exu.Matrix3DList([cross, cross.T @ axes, np.eye(3)]),
                    jointOffsets=exu.Vector3DList([start, np.zeros(3), np.array([length, 0.0, 0.0])]),
                    linkInertiasCOM=exu.Matrix3DList([np.array(inertia) for _, _, inertia in parts]),
                    linkCOMs=exu.Vector3DList([np.array(center) for _, center, _ in parts]),
                    linkMasses=[float(mass) for mass, _, _ in parts],
                    jointForceVector=[0.0, 0.0, force],
                    jointPositionOffsetVector=[0.0] * 3,
                    jointVelocityOffsetVector=[0.0] * 3,
                    jointPControlVector=[0.0, 0.0, float(legs.stiffness[i])],
                    jointDControlVector=[friction, friction, float(legs.damping.prismatic[i])],
                )
            )
        )

    def frequencies(self) -> Any:
        """Six natural frequencies, rad/s, ascending, by Exudyn's eigenvalues with constraints."""
        values, _ = self.system.ComputeODE2Eigenvalues()
        return np.sqrt(np.sort(values)[:6])

    def record(self) -> None:
        """Have the platform's coordinates recorded at every step."""
        coordinates = exu.OutputVariableType.Coordinates
        self.sensor = self.system.AddSensor(
            item.SensorNode(nodeNumber=self.node, outputVariableType=coordinates, storeInternal=True, writeToFile=False)
        )
        self.system.Assemble()

    def recorded(self) -> Any:
        """Displacement and rotation vector of the platform, (m, 6), from the start."""
        return self.system.GetSensorStoredData(self.sensor)[:, 1:7]

    def simulate(self, duration: float, step: float) -> float:
        """From rest; CPU time. Trapezoidal rule with constraints on velocities: the quickest of those tried that damp
        nothing (generalised alpha with a spectral radius of 1 takes 1.2 times as long).
        """
        steps = round(duration / step)
        settings = exu.SimulationSettings()
        time_integration = settings.timeIntegration
        time_integration.endTime, time_integration.numberOfSteps, time_integration.verboseMode = duration, steps, 0
        time_integration.newton.useModifiedNewton = True
        time_integration.newton.relativeTolerance = 1e-5
        settings.linearSolver.solverType = exu.LinearSolverType.EXUdense
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = 0.99 * step
        began = time.process_time()
        self.system.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)
        return time.process_time() - began
