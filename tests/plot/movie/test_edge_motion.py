import numpy as np
import pytest
from matplotlib.axes import Axes

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.movie.edge_motion import draw_area_change, draw_tracks
from cytodisk.plot.style import INWARD_COLOUR, OUTWARD_COLOUR
from cytodisk.scale import Scale


@pytest.fixture
def circle() -> FloatArray:
    """40 unit normals, (row, column), from +x towards +y."""
    angle = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    return np.column_stack([np.sin(angle), np.cos(angle)])


def test_tracks_have_the_colour_of_their_time(ax: Axes, circle: FloatArray) -> None:
    points = 50.0 + (20.0 + np.arange(6.0))[:, None, None] * circle
    points[2] = np.nan
    lines = draw_tracks(ax, points, every=2, paths=5, scale=Scale(frame_interval_s=10.0))
    assert np.array_equal(np.asarray(lines.get_array()), [0.0, 40.0])
    assert lines.get_clim() == (0.0, 50.0)
    first = lines.get_segments()[0]
    assert np.array_equal(first[0], first[-1])
    assert np.allclose(first[:-1], points[0][:, ::-1])
    paths = [line for line in ax.lines if len(line.get_xdata()) == 6]
    assert len(paths) == 5
    assert ax.child_axes[0].get_ylabel() == "time (s)"


def test_tracks_refuse_one_frame_alone(ax: Axes, circle: FloatArray) -> None:
    with pytest.raises(ParameterError, match=r"points_yx.*\(40, 2\)"):
        draw_tracks(ax, circle)


def test_area_lost_goes_down(ax: Axes) -> None:
    won, lost = draw_area_change(ax, [1.0, 2.0, np.nan], [3.0, -1.0, np.nan], scale=Scale(0.5, 2.0))
    assert np.array_equal(won.get_xdata(), [0.0, 2.0, 4.0])
    assert np.array_equal(won.get_ydata(), [1.0, 2.0, np.nan], equal_nan=True)
    assert np.array_equal(lost.get_ydata(), [-3.0, -1.0, np.nan], equal_nan=True)
    assert (won.get_color(), lost.get_color()) == (OUTWARD_COLOUR, INWARD_COLOUR)
    assert ax.get_ylabel() == "area per frame (µm²)"
    with pytest.raises(ParameterError, match=r"protruded has shape \(1,\), retracted \(2,\)"):
        draw_area_change(ax, [1.0], [1.0, 2.0])
