from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.edge_motion import (
    INWARD_COLOUR,
    OUTWARD_COLOUR,
    draw_area_change,
    draw_tracks,
    draw_velocity_arrows,
)


@pytest.fixture
def circle() -> FloatArray:
    """40 unit normals, (row, column), from +x towards +y."""
    angle = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    return np.column_stack([np.sin(angle), np.cos(angle)])


def _arrows(ax: Axes, normals: FloatArray, moved: FloatArray, **options: Any) -> Any:
    """A disk of radius 20 px whose points move along their normals."""
    points = 50.0 + 20.0 * normals
    following = points + moved[:, None] * normals
    return draw_velocity_arrows(ax, points, following, normals, moved, points, following, **options)


def test_arrows_have_the_colour_of_their_direction(ax: Axes, circle: FloatArray) -> None:
    moved = np.where(np.arange(40) < 20, 2.0, -1.0)
    arrows = _arrows(ax, circle, moved, every=4)
    assert arrows.N == 10
    colours = [tuple(colour) for colour in arrows.get_facecolors()]
    assert colours == [to_rgba(OUTWARD_COLOUR)] * 5 + [to_rgba(INWARD_COLOUR)] * 5


@pytest.mark.parametrize("along", ["path", "normal"])
def test_arrows_end_on_the_next_outline(ax: Axes, circle: FloatArray, along: str) -> None:
    arrows = _arrows(ax, circle, np.full(40, 2.0), every=1, along=along)
    tips = arrows.get_offsets() + np.column_stack([arrows.U, arrows.V]) / arrows.scale
    assert np.hypot(*(tips - 50.0).T) == pytest.approx(np.full(40, 22.0))


def test_arrows_along_the_normal_leave_sliding_out(ax: Axes, circle: FloatArray) -> None:
    points = 50.0 + 20.0 * circle
    slid = np.roll(points, -1, axis=0)
    arrows = draw_velocity_arrows(ax, points, slid, circle, np.zeros(40), points, slid, along="normal")
    assert not np.hypot(arrows.U, arrows.V).any()


def test_missing_points_have_no_arrow(ax: Axes, circle: FloatArray) -> None:
    moved = np.full(40, 1.0)
    moved[8] = np.nan
    assert _arrows(ax, circle, moved, every=4).N == 9


def test_scale_is_told(ax: Axes, circle: FloatArray) -> None:
    _arrows(ax, circle, np.full(40, 2.0), pixel_size_um=0.5, stretch=3.0)
    words = [text.get_text() for text in ax.texts] + [key.text.get_text() for key in _keys(ax)]
    assert words == ["5 µm", "1 µm per frame (× 3)"]


def test_small_steps_are_stretched_on_request(ax: Axes, circle: FloatArray) -> None:
    arrows = _arrows(ax, circle, np.full(40, 0.1), stretch=None)
    assert 1.0 / arrows.scale == pytest.approx(50.0)
    assert 2.0 < 0.1 / arrows.scale < 6.1


def _keys(ax: Axes) -> list[Any]:
    return [artist for artist in ax.get_children() if type(artist).__name__ == "QuiverKey"]


def test_a_still_edge_has_no_key(ax: Axes, circle: FloatArray) -> None:
    _arrows(ax, circle, np.zeros(40), stretch=None)
    assert not _keys(ax)


def test_arrows_refuse(ax: Axes, circle: FloatArray) -> None:
    for options, message in (
        ({"every": 0}, "every must be a whole number of at least 1, got 0"),
        ({"stretch": 0.0}, "stretch must be a positive number"),
        ({"along": "edge"}, "along must be 'path' or 'normal'"),
    ):
        with pytest.raises(ParameterError, match=message):
            _arrows(ax, circle, np.ones(40), **options)
    with pytest.raises(ParameterError, match=r"displacement_px \(3,\)"):
        draw_velocity_arrows(ax, circle, circle, circle, np.ones(3), circle, circle)


def test_tracks_have_the_colour_of_their_time(ax: Axes, circle: FloatArray) -> None:
    points = 50.0 + (20.0 + np.arange(6.0))[:, None, None] * circle
    points[2] = np.nan
    lines = draw_tracks(ax, points, every=2, frame_interval_s=10.0, paths=5)
    assert np.array_equal(np.asarray(lines.get_array()), [0.0, 40.0])
    assert lines.get_clim() == (0.0, 50.0)
    first = lines.get_segments()[0]
    assert np.array_equal(first[0], first[-1])
    assert np.allclose(first[:-1], points[0][:, ::-1])
    paths = [line for line in ax.lines if len(line.get_xdata()) == 6]
    assert len(paths) == 5
    assert ax.child_axes[0].get_ylabel() == "time (s)"


def test_tracks_refuse_one_frame_alone(ax: Axes, circle: FloatArray) -> None:
    with pytest.raises(ParameterError, match=r"points_yx must have shape \(T, N, 2\), got \(40, 2\)"):
        draw_tracks(ax, circle)


def test_area_lost_goes_down(ax: Axes) -> None:
    won, lost = draw_area_change(
        ax, [1.0, 2.0, np.nan], [3.0, -1.0, np.nan], frame_interval_s=2.0, unit="µm²"
    )
    assert np.array_equal(won.get_xdata(), [0.0, 2.0, 4.0])
    assert np.array_equal(won.get_ydata(), [1.0, 2.0, np.nan], equal_nan=True)
    assert np.array_equal(lost.get_ydata(), [-3.0, -1.0, np.nan], equal_nan=True)
    assert (won.get_color(), lost.get_color()) == (OUTWARD_COLOUR, INWARD_COLOUR)
    assert ax.get_ylabel() == "area per frame (µm²)"
    with pytest.raises(ParameterError, match=r"protruded has shape \(1,\), retracted \(2,\)"):
        draw_area_change(ax, [1.0], [1.0, 2.0])
