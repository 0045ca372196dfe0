"""The same machine with the platform's frame at another point: its reference point is that point."""

import dataclasses

import flexapod as fx


def moved_origin(hexapod: fx.Hexapod, point) -> fx.Hexapod:
    """The machine whose platform frame has its origin at a point (3,), m, of the old one."""
    suspension, rest = hexapod.suspension, hexapod.legs.joint_rest
    if suspension is not None:
        suspension = dataclasses.replace(suspension, point=suspension.point - point)
    legs = hexapod.legs if rest is None else dataclasses.replace(hexapod.legs, joint_rest=moved(rest, point))
    return dataclasses.replace(
        hexapod,
        platform_joints=hexapod.platform_joints - point,
        platform_mass_center=hexapod.platform_mass_center - point,
        home=None if hexapod.home is None else moved(hexapod.home, point),
        suspension=suspension,
        legs=legs,
        points={name: place - point for name, place in hexapod.points.items()},
        short_forms=(),
    )


def moved(pose: fx.Pose, point) -> fx.Pose:
    """The pose of that frame where the old one has a pose."""
    return fx.Pose(pose.position + pose.matrix @ point, pose.matrix)
