"""Labels say the units and times that the arrays, or a scale, bring."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.arrays import BoolArray
from cytodisk.plot.units import scale_for, velocity_unit, with_unit
from cytodisk.scale import Scale, ShownUnit

FRAMES, LAYERS, SECTORS = 4, 3, 8
UNKNOWN, SIZE_ALONE, INTERVAL_ALONE, BOTH = Scale(), Scale(0.5), Scale(None, 2.0), Scale(0.5, 2.0)
SCALES = [UNKNOWN, SIZE_ALONE, INTERVAL_ALONE, BOTH]
Movie: TypeAlias = Callable[[Scale], cd.DiskMovie]


@pytest.fixture(scope="module")
def masks() -> BoolArray:
    return cd.simulate.movie("growing", 0, frames=FRAMES, radius_px=12.0).masks


@pytest.fixture(scope="module")
def movie(masks: BoolArray) -> Movie:
    known: dict[Scale, cd.DiskMovie] = {}

    def of(scale: Scale) -> cd.DiskMovie:
        if scale not in known:
            size, interval = scale.pixel_size_um, scale.frame_interval_s
            known[scale] = cd.map_movie(masks, pixel_size_um=size, frame_interval_s=interval)
        return known[scale]

    return of


def _stack(count: int) -> list[Axes]:
    figure = Figure()
    return [figure.add_subplot(count, 1, number + 1) for number in range(count)]


def _time(scale: Scale) -> str:
    return "frame" if scale.frame_interval_s is None else "time (s)"


def _bar(ax: Axes) -> str:
    return str(ax.child_axes[0].get_ylabel())


def _scale_bar(ax: Axes) -> str:
    (words,) = [text.get_text() for text in ax.texts if text.get_gid() == "scale bar"]
    return words.split()[1]


@pytest.mark.parametrize("scale", SCALES)
def test_velocity_and_area_of_a_movie(movie: Movie, scale: Scale) -> None:
    velocity = cd.edge_velocity(movie(scale), sectors=SECTORS)
    words = f"edge velocity ({scale.velocity_unit})"
    line_ax, map_ax, area_ax, *layer_axes = _stack(7)
    cd.plot.draw_mean_velocity(line_ax, velocity)
    cd.plot.draw_velocity_map(map_ax, velocity)
    assert (line_ax.get_ylabel(), _bar(map_ax)) == (words, words)
    changes = cd.edge_changes(movie(scale), sectors=SECTORS).sum("sector", keep_attrs=True)
    cd.plot.draw_area_change(area_ax, changes["protruded_area"], changes["retracted_area"])
    assert area_ax.get_ylabel() == f"area per frame ({scale.area_unit})"
    values = np.zeros((FRAMES, LAYERS, SECTORS))
    cd.plot.draw_layers(layer_axes, values, velocity, scale=scale)
    assert _bar(layer_axes[0]) == words
    for ax in (line_ax, map_ax, area_ax, layer_axes[-1]):
        assert ax.get_xlabel() == _time(scale)


@pytest.mark.parametrize("scale", SCALES)
def test_plain_numbers_with_a_scale(scale: Scale) -> None:
    table, words = np.ones((FRAMES, SECTORS)), f"edge velocity ({scale.velocity_unit})"
    one, two, three, four, five, *pair = _stack(7)
    cd.plot.draw_mean_velocity(one, table, scale=scale)
    cd.plot.draw_velocity_map(two, table, scale=scale)
    cd.plot.draw_activity_map(three, table, scale=scale)
    cd.plot.draw_area_change(four, table[:, 0], table[:, 0], scale=scale)
    cd.plot.draw_by_layer(five, table, [0], "correlation", scale=scale)
    cd.plot.draw_map_pair(pair, table, table, by_velocity=True, scale=scale)
    assert (one.get_ylabel(), _bar(two), _bar(pair[1])) == (words, words, words)
    assert (_bar(three), _bar(pair[0])) == ("mean (a.u.)", "mean (a.u.)")
    assert four.get_ylabel() == f"area per frame ({scale.area_unit})"
    assert five.get_ylabel() == "correlation"
    assert {ax.get_xlabel() for ax in (one, two, three, four, five, *pair)} == {_time(scale)}


@pytest.mark.parametrize("scale", SCALES)
def test_scale_bars(movie: Movie, masks: BoolArray, scale: Scale) -> None:
    made = movie(scale)
    grid = cd.polar_windows(LAYERS, SECTORS)
    windows, unit = grid.on(made[0]), scale.length_unit
    arrows, tracks, cell, area, means, strip, field, examples = _stack(8)
    cd.plot.draw_velocity_arrows(arrows, made, 0, scale=scale)
    cd.plot.draw_tracks(tracks, made.points_yx, scale=scale)
    cd.plot.draw_cell(cell, masks[0], made[0], scale=scale)
    cd.plot.draw_area_distortion(area, made[0], scale=scale)
    cd.plot.draw_window_means(means, windows, np.ones((LAYERS, SECTORS)), scale=scale)
    cd.plot.draw_strip([strip], [windows], [""], scale=scale)
    cd.plot.frame_cell(field, made[0], scale=scale)
    score = cd.plot.draw_shape_examples(examples, _score(), {0: masks[0]}, [[0]], scale=scale)
    assert len(score.get_paths()) == 1
    for ax in (arrows, tracks, cell, area, means, strip, field, examples):
        assert _scale_bar(ax) == unit
    assert _bar(tracks) == _time(scale)
    (key,) = [artist for artist in arrows.get_children() if type(artist).__name__ == "QuiverKey"]
    assert f" {unit} per frame" in key.text.get_text()


def _score() -> pd.DataFrame:
    return pd.DataFrame({"cell": [0], "complexity": [1.0], "umap_1": [0.0], "umap_2": [0.0]})


def test_an_array_brings_the_unit_of_its_signal(ax: Axes) -> None:
    area = xr.DataArray(np.ones((3, 4)), dims=("time", "sector"), attrs={"units": "µm²"})
    cd.plot.draw_activity_map(ax, area, label="area")
    assert _bar(ax) == "area (µm²)"


def test_a_unit_that_was_lost_is_not_made_up() -> None:
    velocity = xr.DataArray(np.ones((3, 4)), dims=("time", "sector"))
    assert velocity_unit(velocity, None, ShownUnit("s"), 1.0).name == "unit unknown"
    assert velocity_unit(velocity, BOTH, ShownUnit("s"), 1.0).name == "µm/s"
    assert velocity_unit(np.ones((3, 4)), None, ShownUnit("frame"), 1.0).name == "px/frame"
    assert velocity_unit(velocity, BOTH, ShownUnit("min", 1 / 60), 0.001).name == "nm/min"


def test_what_is_passed_goes_before_what_is_carried() -> None:
    carrier = xr.DataArray(0.0, attrs={"pixel_size_um": 0.1, "frame_interval_s": 4.0})
    assert scale_for(carrier) == Scale(0.1, 4.0)
    assert scale_for(carrier, SIZE_ALONE) == Scale(0.5, 4.0)
    assert scale_for(np.zeros(3), BOTH) == BOTH


def test_ratios_have_no_unit() -> None:
    assert [with_unit("r", unit) for unit in ("", "1", "µm")] == ["r", "r", "r (µm)"]
