"""Figures of sweeps show the numbers they are given."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine
from tests.helpers.stores import BOX, I, stored

import flexapod as fx
from flexapod.plots import sweep as plots_sweep
from flexapod.plots import sweep_surface

FEW = fx.sweep(I, fx.random_poses(BOX, 300))
MANY = fx.sweep(I, fx.random_poses(BOX, 30_000))
GRID = fx.pose_grid(x=np.linspace(-0.1, 0.3, 9), y=np.linspace(0, 0.4, 8), z=np.linspace(0.6, 1, 7))
CUBE = fx.sweep(I, GRID, quantities=("omega_1", "within_limits"))


def test_few_poses_are_dots():
    ax = plots_sweep.index_scatter(FEW)
    x, y = ax.lines[0].get_data()
    assert np.array_equal(x, FEW.cond_H)
    assert np.array_equal(y, FEW.omega_1)
    assert "rad/s" in ax.get_ylabel()
    assert ax.get_xlabel() == "cond(H)"


def test_many_poses_are_counted_in_cells():
    ax = plots_sweep.index_scatter(MANY)
    assert not ax.lines
    (mesh,) = ax.collections
    assert mesh.get_array().sum() == 30_000


def test_a_store_gives_the_same_figure(tmp_path):
    stored(tmp_path / "map.zarr", fx.random_poses(BOX, 30_000), chunk=7000)
    one, other = (plots_sweep.index_scatter(found) for found in (MANY, fx.open_sweep(tmp_path / "map.zarr")))
    assert np.ma.allequal(one.collections[0].get_array(), other.collections[0].get_array())


def test_wide_ranges_get_a_logarithmic_axis():
    wide = fx.sweep(I, fx.random_poses(fx.Box.about(fx.home_pose(I), 0.15, 0.4), 2000))
    assert float(wide.cond_H.max() / wide.cond_H.min()) > 5
    assert plots_sweep.index_scatter(wide).get_xscale() == "log"
    assert plots_sweep.index_scatter(wide, most_cond=300).get_xlim()[1] == 300


def test_map_shows_the_slice_and_its_worst_pose():
    plane = CUBE.isel(z=3)
    ax = plots_sweep.index_map(plane)
    assert np.array_equal(ax.collections[0].get_array(), plane.omega_1.values.T)
    x, y = ax.lines[0].get_data()
    worst = np.unravel_index(plane.omega_1.values.argmin(), (9, 8))
    assert (x[0], y[0]) == (1000 * plane.x.values[worst[0]], 1000 * plane.y.values[worst[1]])
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x (mm)", "y (mm)")
    assert "z 800 mm" in ax.get_title()


def test_map_of_poses_without_an_index_has_holes():
    plane = CUBE.isel(z=3).copy(deep=True)
    plane.omega_1[2, 3] = np.nan
    assert plots_sweep.index_map(plane).collections[0].get_array().mask.sum() == 1


def test_poses_outside_the_limits_are_hatched():
    limited = I.replace({"limits.leg_length": [0.7, 1.05]})
    found = fx.sweep(
        limited,
        fx.pose_grid(x=np.linspace(-0.1, 0.3, 9), y=np.linspace(0, 0.4, 8), z=0.8),
        quantities=("omega_1", "within_limits"),
    )
    assert 0 < int(found.within_limits.sum()) < 72
    ax = plots_sweep.index_map(found)
    assert any("///" in (c.get_hatch() or "") or "///" in str(getattr(c, "hatches", "")) for c in ax.collections)


def test_points_of_the_surface_have_the_index_of_its_level():
    fine = fx.sweep(I, fx.pose_grid(x=np.linspace(-0.1, 0.3, 25), y=np.linspace(0, 0.4, 25), z=np.linspace(0.6, 1, 25)))
    axes = [fine[name].values for name in "xyz"]
    points, faces = sweep_surface._marching_cubes(fine.omega_1.values, 215.0, axes)
    there = fx.sweep(I, np.pad(points, ((0, 0), (0, 3)))).omega_1.values
    # linear between neighbours 17 mm apart: the curvature of the index is worth less than 0.2 %
    assert np.abs(there / 215.0 - 1).max() < 2e-3
    assert len(faces) > 1000
    ax = plots_sweep.iso_surface(fine, 215.0)
    assert "215" in ax.get_title()


@pytest.mark.parametrize(
    ("sweep", "function"), [(CUBE, "iso_surface"), (CUBE.isel(z=0), "index_map"), (CUBE.isel(z=0, y=0), "index_line")]
)
def test_the_figure_follows_from_the_sweep(sweep, function, tmp_path):
    ax = plots_sweep.auto(sweep)
    expected = getattr(plots_sweep, function)(sweep)
    assert ax.get_title() == expected.get_title()
    plots_sweep.save(ax, tmp_path / "figure.png")
    assert (tmp_path / "figure.png").stat().st_size > 5000


@pytest.mark.parametrize(
    ("draw", "words"),
    [
        (lambda: plots_sweep.index_scatter(CUBE), "needs the quantity cond_H"),
        (lambda: plots_sweep.index_map(CUBE), "two|2 varied coordinates"),
        (lambda: plots_sweep.index_map(CUBE.isel(z=0), "leg_force"), "has no leg_force"),
        (lambda: plots_sweep.iso_surface(CUBE, 1e6), "no surface of 1e"),
        (lambda: plots_sweep.save(plots_sweep.index_scatter(FEW), "/none/figure.png"), "cannot be written"),
    ],
)
def test_what_cannot_be_drawn_is_told(draw, words):
    with pytest.raises(fx.FlexapodError, match=words):
        draw()


BASE = plain_machine("motion-base")
WIDE = fx.pose_grid(x=np.linspace(-1.2, 1.2, 15), y=np.linspace(-1.2, 1.2, 13), z=np.linspace(2.0, 2.8, 11))
VOLUME = fx.sweep(BASE, WIDE)


def legend_of(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_the_cross_of_a_map_is_within_the_limits_and_every_mark_is_named():
    plane = VOLUME.isel(z=6)
    assert 0 < int(plane.within_limits.sum()) < plane.within_limits.size
    inside = np.where(plane.within_limits, plane.omega_1, np.inf)
    for all_poses, values in ((False, inside), (True, plane.omega_1.values)):
        ax = plots_sweep.index_map(plane, all_poses=all_poses)
        worst = np.unravel_index(values.argmin(), values.shape)
        x, y = ax.lines[0].get_data()
        assert (x[0], y[0]) == (plane.x.values[worst[0]], plane.y.values[worst[1]])
        assert f"{values.min():.5g}" in legend_of(ax)[0]
        assert "beyond the limits" in legend_of(ax)
    none = plane.copy(deep=True)
    none["within_limits"][:] = False
    assert legend_of(plots_sweep.index_map(none)) == ["beyond the limits"]
    none.omega_1[3, 3] = np.nan
    assert "no value" in legend_of(plots_sweep.index_map(none))


def test_all_lengths_of_a_figure_have_one_unit():
    ax = plots_sweep.index_map(VOLUME.isel(z=6))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x (m)", "y (m)")
    assert "z 2.48 m" in ax.get_title()
    near = plots_sweep.index_map(VOLUME.sel(x=slice(-0.9, 0.9), y=slice(-0.9, 0.9)).isel(z=6))
    assert near.get_xlabel() == "x (m)"  # since z is held at 2.48 m


def test_the_cloud_is_of_the_poses_within_the_limits():
    found = fx.sweep(BASE, fx.random_poses(fx.Box.about(fx.home_pose(BASE), 0.67, 0.4), 3000))
    inside = found.within_limits.values
    _, y = plots_sweep.index_scatter(found).lines[0].get_data()
    assert np.array_equal(y, found.omega_1.values[inside])
    assert len(plots_sweep.index_scatter(found, all_poses=True).lines[0].get_data()[0]) == 3000
    ax = plots_sweep.index_scatter(found)
    assert f"{inside.sum()} poses within the limits, of 3 000" in ax.get_title()
    assert ax.get_title().startswith("motion-base")
    low, high = ax.get_ylim()  # the data fill the axis
    assert np.ptp(y) > 0.85 * (high - low)
    with pytest.raises(fx.PoseError, match="no pose of this sweep within the design's limits has an index"):
        plots_sweep.index_scatter(found.assign(within_limits=found.within_limits & False))


def test_few_poses_in_a_cell_are_dark_on_white():
    assert plots_sweep.index_scatter(MANY).collections[0].get_cmap().name == "viridis"


def test_a_surface_ends_at_the_limits():
    level = 27.0
    inside = np.where(VOLUME.within_limits, VOLUME.omega_1, np.nan)
    axes = [VOLUME[name].values for name in "xyz"]
    points, faces = sweep_surface._marching_cubes(inside, level, axes)
    corners = points[np.unique(faces)]
    assert fx.check_limits(BASE, np.pad(corners, ((0, 0), (0, 3)))).ok.mean() > 0.98  # limits bend between corners
    there = fx.sweep(BASE, np.pad(corners, ((0, 0), (0, 3)))).omega_1.values
    assert np.abs(there / level - 1).max() < 0.01  # linear between neighbours 17 cm apart
    assert "within the limits" in plots_sweep.iso_surface(VOLUME, level).get_title()
    assert "within" not in plots_sweep.iso_surface(VOLUME, level, all_poses=True).get_title()


def test_a_line_is_dotted_beyond_the_limits():
    ax = plots_sweep.index_line(VOLUME.isel(y=6, z=6))
    beyond, within = ax.lines
    assert legend_of(ax) == ["beyond the limits", "within the limits"]
    assert np.isnan(within.get_ydata()).sum() == (~VOLUME.isel(y=6, z=6).within_limits.values).sum()
    assert np.isfinite(beyond.get_ydata()).all()
