"""The layouts that the core says, beside what Python calls the same things."""

import numpy as np

import flexapod as fx
from flexapod import _core
from flexapod.design.packing import DERIVED
from flexapod.design.schema import KEYS
from flexapod.design.units import printed, si_unit


def test_every_number_of_a_design_is_a_key_of_the_file_in_its_unit():
    for field in _core.DESIGN_LAYOUT:
        if field.name not in DERIVED:
            rule = KEYS[field.name]
            assert field.unit == printed(si_unit(rule.dimension)), field.name
            assert field.shape in {shape for given in rule.shapes for shape in (given, (6, *given))} | {(24,)}, (
                field.name
            )
        assert field.index.shape == field.shape
        assert field.index.flat[0] == field.offset
        if field.stride > 0:
            assert (np.diff(field.index, axis=0) == field.stride).all(), field.name


def test_the_layouts_hold_every_number_once():
    for layout, size in ((_core.DESIGN_LAYOUT, _core.design_size), (_core.MOTION_LAYOUT, _core.motion_size)):
        numbers = np.concatenate([np.unique(field.index) for field in layout])
        assert sorted(numbers) == list(range(size))


def test_symmetric_matrices_have_the_entries_beside_the_diagonal_once():
    for name, size in (("platform.inertia", 6), ("suspension.stiffness", 21), ("suspension.damping", 21)):
        (index,) = (field.index for field in _core.DESIGN_LAYOUT if field.name == name)
        assert np.array_equal(index, index.T)
        assert np.unique(index).size == size


def test_numbers_of_other_springs_come_after_those_that_every_machine_has():
    later = ("legs.series", "legs.joint_", "legs.stiffness_law", "suspension")
    for field in _core.DESIGN_LAYOUT:
        assert (field.index >= _core.plain_size).all() == field.name.startswith(later), field.name
    assert _core.plain_size == 211


def test_a_motion_comes_back_from_its_numbers():
    rng = np.random.default_rng(1)
    pose = fx.Pose.from_rpy(*rng.normal(size=(6, 2, 3)))
    motion = fx.Motion(pose, *rng.normal(size=(4, 2, 3, 3)))
    back = fx.Motion.unpacked(motion.packed)
    assert np.array_equal(back.packed, motion.packed)
    for field in _core.MOTION_LAYOUT:
        of = motion.pose if field.name in ("position", "matrix") else motion
        flat = motion.packed[..., field.index.ravel()].reshape(2, 3, *field.shape)
        assert np.array_equal(flat, getattr(of, field.name)), field.name
    assert np.array_equal(pose.packed, motion.packed[..., : pose.packed.shape[-1]])
