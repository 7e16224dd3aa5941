"""The atlas and the difference of conditions, on the disk and on a cell."""

from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch

from cytodisk.errors import ParameterError, WindowError
from cytodisk.plot.population.difference_map import DifferenceMap
from cytodisk.plot.population.population_maps import (
    CLUSTER_NAME,
    SECTOR_NAME,
    SIGNIFICANT_NAME,
    UNTESTED_NAME,
    count_words,
    difference_key,
    draw_atlas,
    draw_difference,
)
from cytodisk.windows.polar_windows import CellWindows, polar_windows

GRID = polar_windows(3, 8)
DIMS = ("layer", "sector")


def atlas() -> xr.Dataset:
    dims, names = ("condition", *DIMS), {"condition": ["control", "drug $5"]}
    mean = np.arange(48.0).reshape(2, 3, 8)
    counts = np.full((2, 3, 8), 12)
    counts[1, 0] = 11
    arrays = {"mean": (dims, mean), "n_cells": (dims, counts), "n_experiments": (dims, counts // 12)}
    return xr.Dataset(arrays, coords=names)


def comparison(**arrays: Any) -> xr.Dataset:
    difference = np.linspace(-1.0, 2.0, 24).reshape(3, 8)
    p = np.full((3, 8), 0.5)
    p[0, :3], p[2, 7] = 0.01, np.nan
    return xr.Dataset({"difference": (DIMS, difference), "p_fwer": (DIMS, p)} | arrays)


def labels() -> np.ndarray:
    found = np.zeros((3, 8))
    found[0, :4], found[2, 2:4] = 1, 2
    return found


def patches(ax: Axes, name: str) -> list[PathPatch]:
    return [one for one in ax.patches if isinstance(one, PathPatch) and one.get_gid() == name]


def test_conditions_share_their_colours() -> None:
    axes = Figure().subplots(1, 2)
    drawn = draw_atlas(axes, atlas(), GRID)
    assert drawn[0].get_clim() == drawn[1].get_clim()
    assert [ax.get_title() for ax in axes] == ["control", "drug $5"]
    assert np.array_equal(np.asarray(drawn[1].get_array()), np.arange(24.0, 48.0))
    words = [text.get_text() for text in axes[1].texts]
    assert "12 cells\n1 experiment" in words


def test_dims_in_any_order_and_others_refused() -> None:
    axes = Figure().subplots(1, 2)
    drawn = draw_atlas(axes, atlas().transpose("sector", "layer", "condition"), GRID)
    assert np.array_equal(np.asarray(drawn[0].get_array()), np.arange(24.0))
    with pytest.raises(ParameterError, match=r"atlas\.sel\(channel=…\)"):
        draw_atlas(axes, atlas().expand_dims(channel=["GFP"]), GRID)
    with pytest.raises(ParameterError, match="axes must be 2, got 1"):
        draw_atlas(axes[:1], atlas(), GRID)
    with pytest.raises(WindowError, match="one number a window"):
        draw_atlas(axes, atlas(), polar_windows(2, 8))


def test_counts_that_are_unknown_are_not_written() -> None:
    one = atlas().sel(condition="control")
    assert count_words(one.drop_vars(["n_cells", "n_experiments"])) == ""
    assert count_words(one.drop_vars("n_experiments")) == "12 cells"
    assert count_words(one.assign(n_experiments=0 * one["n_experiments"])) == "12 cells\nexperiments\nunknown"


def test_a_turned_atlas_lies_where_the_cell_has_its_sectors(ax: Axes, windows: CellWindows) -> None:
    """Sector 0 of the atlas is sector 3 of the cell, which is then called 0."""
    (drawn,) = draw_atlas([ax], atlas().isel(condition=[0]), windows, first=3)
    table = np.asarray(drawn.get_array()).reshape(3, 8)
    assert np.array_equal(np.roll(table, -3, axis=1), np.arange(24.0).reshape(3, 8))
    plain = Figure().add_subplot()
    draw_atlas([plain], atlas().isel(condition=[0]), windows)
    turned = {text.get_text(): text.xy for text in ax.texts if text.get_gid() == SECTOR_NAME}  # type: ignore[attr-defined]
    still = {text.get_text(): text.xy for text in plain.texts if text.get_gid() == SECTOR_NAME}  # type: ignore[attr-defined]
    assert set(turned) == set(still) == {"0", "2", "4", "6"}
    assert turned["0"] != still["0"]


@pytest.mark.parametrize("on_cell", [False, True])
def test_what_is_significant_is_outlined(ax: Axes, windows: CellWindows, on_cell: bool) -> None:
    clusters = pd.DataFrame({"cluster": [1, 2], "p": [0.01, 0.3]})
    found = DifferenceMap.of(comparison(), cluster_labels=labels(), clusters=clusters)
    drawn = draw_difference(ax, found, windows if on_cell else GRID)
    assert drawn.get_clim() == (-found.limit, found.limit)
    assert len(patches(ax, SIGNIFICANT_NAME)) == 1
    (around,) = patches(ax, CLUSTER_NAME)  # the other has p of 0.3
    assert around.get_linestyle() != "solid"
    (hatched,) = patches(ax, UNTESTED_NAME)
    assert hatched.get_hatch()
    if not on_cell:
        extents = patches(ax, SIGNIFICANT_NAME)[0].get_path().get_extents()
        assert extents.y1 == pytest.approx(1.0)  # sectors 0 to 2 of layer 0 lie right and below
        assert extents.x1 == pytest.approx(1.0)


def test_regions_turn_with_the_values(ax: Axes, windows: CellWindows) -> None:
    found = DifferenceMap.of(comparison())
    draw_difference(ax, found, windows, first=4)
    turned = patches(ax, SIGNIFICANT_NAME)[0].get_path().get_extents()
    other = Figure().add_subplot()
    rolled = DifferenceMap.of(comparison().roll(sector=4))
    draw_difference(other, rolled, windows)
    assert np.allclose(turned.bounds, patches(other, SIGNIFICANT_NAME)[0].get_path().get_extents().bounds)


def test_nothing_is_outlined_where_nothing_was_tested(ax: Axes) -> None:
    found = DifferenceMap.of(comparison().drop_vars("p_fwer"))
    draw_difference(ax, found, GRID)
    assert not patches(ax, SIGNIFICANT_NAME)
    assert len(patches(ax, UNTESTED_NAME)) == 1
    assert [handle.get_label() for handle in difference_key(found)] == ["not tested: 24 of 24 windows"]


def test_key_counts_what_is_there() -> None:
    found = DifferenceMap.of(comparison(), cluster_labels=labels())
    key = [handle.get_label() for handle in difference_key(found)]
    assert key == [
        "window, p ≤ 0.05 (max-T): 3 of 23",
        "cluster, p ≤ 0.05: 6 windows",
        "not tested: 1 of 24 windows",
    ]


def test_several_comparisons_are_corrected_together() -> None:
    p = comparison()["p_fwer"]
    clusters = pd.DataFrame({"cluster": [1, 2], "p": [0.01, 0.03], "p_holm": [0.02, 0.06]})
    windows = comparison(p_holm=(DIMS, np.where(p == p[0, 0], 0.06, p)))
    found = DifferenceMap.of(windows, cluster_labels=labels(), clusters=clusters)
    assert not found.significant.any()
    assert sorted(np.unique(found.cluster)) == [0, 1]
    assert found.correction == "max-T, Holm"
    alone = DifferenceMap.of(comparison(p_holm=(DIMS, p.to_numpy())))
    assert (int(alone.significant.sum()), alone.correction) == (3, "max-T")


def test_limits_hold_almost_all() -> None:
    found = DifferenceMap.of(comparison())
    assert 1.9 < found.limit < 2.0
    assert found.cut_off == "max"
    flat = DifferenceMap.of(comparison(difference=(DIMS, np.zeros((3, 8)))))
    assert (flat.limit, flat.cut_off) == (1.0, "neither")


def test_other_comparisons_are_refused() -> None:
    with pytest.raises(ParameterError, match="must be a Dataset with the variable difference"):
        DifferenceMap.of(comparison()["difference"])  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=r"windows\.sel\(channel=…\)"):
        DifferenceMap.of(comparison().expand_dims(channel=["GFP"]))
    with pytest.raises(ParameterError, match="alpha must be between 0 and 1"):
        DifferenceMap.of(comparison(), alpha=5.0)
    with pytest.raises(ParameterError, match="cluster_labels has shape"):
        DifferenceMap.of(comparison(), cluster_labels=np.zeros((2, 8)))
