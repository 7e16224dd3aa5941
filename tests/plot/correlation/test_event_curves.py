from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

from cytodisk.analysis.event_average import average_around
from cytodisk.analysis.events import edge_events
from cytodisk.errors import ParameterError
from cytodisk.plot.correlation.event_curves import ONSET_NAME, band_key, draw_event_average, draw_events


@pytest.fixture
def velocity() -> xr.DataArray:
    """An event of two sectors around sector 0, one that the movie begins with, and one back."""
    values = np.zeros((10, 6))
    values[2:5, 0] = 1.0
    values[3:6, 5] = 1.0
    values[:2, 2] = 1.0
    values[7:9, 3] = -1.0
    coords = {
        "frame": ("time", np.arange(20, 30)),
        "sector": np.arange(6),
        "time_s": ("time", 2.0 * np.arange(20, 30)),
    }
    return xr.DataArray(values, coords, ("time", "sector"), attrs={"units": "µm/s"})


@pytest.fixture
def events(velocity: xr.DataArray) -> pd.DataFrame:
    return edge_events(velocity, threshold=0.5)


def sides(lines: LineCollection) -> set[tuple[tuple[float, float], ...]]:
    return {tuple(sorted((float(x), float(y)) for x, y in side)) for side in lines.get_segments()}


def test_patches_have_outlines_at_their_place_in_time(
    ax: Axes, velocity: xr.DataArray, events: pd.DataFrame
) -> None:
    retraction = events[events["kind"] == "retraction"]
    drawn = draw_events(ax, velocity, retraction)
    # Frames 27 and 28 of 2 s, around sector 3.
    assert sides(drawn) == {
        ((53.0, 2.5), (53.0, 3.5)),
        ((57.0, 2.5), (57.0, 3.5)),
        ((53.0, 2.5), (55.0, 2.5)),
        ((55.0, 2.5), (57.0, 2.5)),
        ((53.0, 3.5), (55.0, 3.5)),
        ((55.0, 3.5), (57.0, 3.5)),
    }
    assert ax.get_xlim() == (39.0, 59.0)
    assert ax.get_xlabel() == "time (s)"
    assert ax.child_axes[0].get_ylabel() == "edge velocity (µm/s)"


def test_a_patch_around_sector_0_is_open_there(
    ax: Axes, velocity: xr.DataArray, events: pd.DataFrame
) -> None:
    found = sides(draw_events(ax, velocity, events[events["sector"].isin([0, 5])]))
    for time in (3, 4):  # both sectors move
        left, right = 2.0 * (20 + time - 0.5), 2.0 * (20 + time + 0.5)
        assert ((left, -0.5), (right, -0.5)) not in found
        assert ((left, 5.5), (right, 5.5)) not in found
    assert ((43.0, -0.5), (45.0, -0.5)) in found  # sector 0 alone


def test_known_onsets_are_marked(ax: Axes, velocity: xr.DataArray, events: pd.DataFrame) -> None:
    draw_events(ax, velocity, events)
    (marks,) = [one for one in ax.collections if one.get_gid() == ONSET_NAME]
    assert isinstance(marks, LineCollection)
    assert sides(marks) == {
        ((43.0, -0.5), (43.0, 0.5)),
        ((45.0, 4.5), (45.0, 5.5)),
        ((53.0, 2.5), (53.0, 3.5)),
    }


def test_many_patches_leave_thin_onsets_of_protrusions(ax: Axes) -> None:
    values = np.where(np.arange(40)[:, None] % 4 < 2, 1.0, -1.0) * np.where(np.arange(16) % 2, 1.0, -1.0)
    coords = {"frame": ("time", np.arange(40)), "sector": np.arange(16)}
    velocity = xr.DataArray(values, coords, ("time", "sector"), attrs={"units": "px/frame"})
    events = edge_events(velocity, threshold=0.5)
    assert events["patch"].nunique() > 150
    drawn = draw_events(ax, velocity, events)
    (marks,) = [one for one in ax.collections if one.get_gid() == ONSET_NAME]
    assert isinstance(marks, LineCollection)
    assert sides(drawn) == set()
    starts = events[(events["kind"] == "protrusion") & events["onset_known"]]
    assert len(sides(marks)) == len(starts) < len(events) / 2
    few = draw_events(Figure().add_subplot(), velocity, events[events["patch"] < 150])
    assert sides(few)


def test_no_events_draw_the_map_alone(ax: Axes, velocity: xr.DataArray, events: pd.DataFrame) -> None:
    assert sides(draw_events(ax, velocity, events[:0])) == set()
    (image,) = ax.images
    np.testing.assert_array_equal(image.get_array(), velocity.to_numpy().T)


def test_events_of_another_velocity_are_refused(
    ax: Axes, velocity: xr.DataArray, events: pd.DataFrame
) -> None:
    with pytest.raises(ParameterError, match=r"velocity must be a DataArray .* got ndarray"):
        draw_events(ax, velocity.to_numpy(), events)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="table of edge_events"):
        draw_events(ax, velocity, events.drop(columns="patch"))
    with pytest.raises(ParameterError, match="beyond the 5 frames"):
        draw_events(ax, velocity[:5], events)
    with pytest.raises(ParameterError, match="in sectors that velocity has not"):
        draw_events(ax, velocity[:, :3], events)


def average_of(velocity: xr.DataArray, events: pd.DataFrame, layers: int = 6, **options: Any) -> xr.Dataset:
    values = np.arange(10.0)[:, None, None] + 100.0 * np.arange(layers)[:, None] + np.zeros(6)
    activity = xr.DataArray(
        values, {"frame": velocity["frame"], "time_s": velocity["time_s"]}, ("time", "layer", "sector")
    )
    return average_around(activity, events, before=2, after=3, **options)


def with_bands(average: xr.Dataset) -> xr.Dataset:
    """Bands that so few patches do not give."""
    return average.assign(lower=average["mean"] - 1.0, upper=average["mean"] + 2.0)


def test_layers_against_delay(ax: Axes, velocity: xr.DataArray, events: pd.DataFrame) -> None:
    average = with_bands(average_of(velocity, events.assign(patch=range(len(events)))))
    lines = draw_event_average(ax, average, label="Rac1")
    assert [line.get_label() for line in lines] == [
        "layer 0 (edge)",
        "layer 2",
        "layer 3",
        "layer 5 (centre)",
    ]
    for line, layer in zip(lines, (0, 2, 3, 5), strict=True):
        np.testing.assert_array_equal(line.get_xdata(), [-4.0, -2.0, 0.0, 2.0, 4.0, 6.0])
        np.testing.assert_array_equal(line.get_ydata(), average["mean"].isel(layer=layer))
    bands = [one for one in ax.collections if isinstance(one, PolyCollection)]
    for band, layer in zip(bands, (0, 5), strict=True):  # those between would hide them
        low, high = band.get_paths()[0].get_extents().intervaly
        assert low == float(average["lower"].isel(layer=layer).min())
        assert high == float(average["upper"].isel(layer=layer).max())
    assert len({line.get_linestyle() for line in lines[:3]}) == 3 - 1  # dashes of both kinds are "--"
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names[-1] == "95 %, bootstrap of patches (layers 0, 5)"
    (zero,) = [line for line in ax.lines if line not in lines]
    assert list(np.asarray(zero.get_xdata())) == [0.0, 0.0]
    assert ax.get_xlabel() == "delay after onset of protrusion (s)"
    assert ax.get_ylabel() == "Rac1 (a.u.)"
    assert ax.get_title(loc="right") == "2 events in 2 patches"


def test_labels_say_what_was_done(ax: Axes, velocity: xr.DataArray, events: pd.DataFrame) -> None:
    draw_event_average(ax, average_of(velocity, events, normalise="sd", at="end"), label="Rac1")
    assert ax.get_ylabel() == "Rac1 (sd of window)"
    assert ax.get_xlabel() == "delay after end of protrusion (s)"
    draw_event_average(ax, average_of(velocity, events, normalise="mean", kind="retraction"), label="Rac1")
    assert ax.get_ylabel() == "Rac1 − mean of window (a.u.)"
    assert ax.get_title(loc="right") == "1 event in 1 patch"


def test_without_layers_there_is_one_line_and_no_legend(
    ax: Axes, velocity: xr.DataArray, events: pd.DataFrame
) -> None:
    average = average_around(velocity.drop_vars("time_s"), events, before=1, after=2)
    (line,) = draw_event_average(ax, average, label="edge velocity")
    np.testing.assert_array_equal(line.get_xdata(), [-1, 0, 1, 2])
    assert ax.get_legend() is None
    assert ax.get_xlabel() == "delay after onset of protrusion (frames)"
    assert ax.get_ylabel() == "edge velocity (µm/s)"


def test_averages_that_cannot_be_drawn_are_refused(
    ax: Axes, velocity: xr.DataArray, events: pd.DataFrame
) -> None:
    with pytest.raises(ParameterError, match="Dataset of average_around"):
        draw_event_average(ax, velocity)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="select one channel"):
        draw_event_average(ax, average_of(velocity, events).expand_dims("channel"))


def test_bands_have_a_key_where_there_are_any(velocity: xr.DataArray, events: pd.DataFrame) -> None:
    average = average_of(velocity, events, layers=2, confidence=0.9)
    (key,) = band_key(with_bands(average))
    assert key.get_label() == "90 %, bootstrap of patches"
    assert band_key(average) == []
    with pytest.raises(ParameterError, match="must be the Dataset of average_around"):
        band_key(xr.Dataset())
