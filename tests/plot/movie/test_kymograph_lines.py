import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

from cytodisk.analysis.kymograph import line_kymograph
from cytodisk.errors import ParameterError
from cytodisk.plot.movie.kymograph_lines import draw_boundary_kymograph, draw_line_kymograph


@pytest.fixture
def kymograph() -> xr.DataArray:
    """Two channels, 4 frames of 3 s, along 10 px of 0.5 µm."""
    values = np.arange(4 * 2 * 12 * 20.0).reshape(4, 2, 12, 20)
    attrs = {"pixel_size_um": 0.5, "frame_interval_s": 3.0}
    signals = xr.DataArray(values, {"channel": ["a", "b"]}, ("time", "channel", "y", "x"), attrs=attrs)
    return line_kymograph([(3, 2), (3, 12)], signals)


def test_time_goes_right_and_the_line_up(ax: Axes, kymograph: xr.DataArray) -> None:
    drawn = draw_line_kymograph(ax, kymograph.sel(channel="b"), label="Rac1")
    np.testing.assert_array_equal(drawn.get_array(), kymograph.sel(channel="b").to_numpy().T)
    assert drawn.get_extent() == pytest.approx((-1.5, 10.5, -0.25, 5.25))
    assert drawn.origin == "lower"
    assert ax.get_xlabel() == "time (s)"
    assert ax.get_ylabel() == "distance along the line (µm)"
    assert ax.child_axes[0].get_ylabel() == "Rac1 (a.u.)"


def test_limits(ax: Axes, kymograph: xr.DataArray) -> None:
    one = kymograph.sel(channel="a")
    low, high = draw_line_kymograph(ax, one).get_clim()
    assert float(one.min()) <= low < high <= float(one.max())
    assert draw_line_kymograph(ax, one, limits=(5.0, 7.0)).get_clim() == (5.0, 7.0)


def test_the_edge_by_angle(ax: Axes) -> None:
    values = np.arange(24.0).reshape(3, 8)
    values[1] = np.nan
    attrs = {"units": "a.u.", "depth": 1.5, "depth_units": "µm"}
    drawn = draw_boundary_kymograph(ax, xr.DataArray(values, dims=("time", "point"), attrs=attrs))
    assert np.array_equal(np.ma.asarray(drawn.get_array()).filled(np.nan), values.T, equal_nan=True)
    assert drawn.get_extent() == [-0.5, 2.5, 0.0, 360.0]
    assert ax.get_xlabel() == "frame"
    assert ax.child_axes[0].get_ylabel() == "intensity, 1.5 µm deep (a.u.)"


def test_other_arrays_are_refused(ax: Axes, kymograph: xr.DataArray) -> None:
    with pytest.raises(ParameterError, match="select one, as in"):
        draw_line_kymograph(ax, kymograph)
    with pytest.raises(ParameterError, match="dims time and point"):
        draw_boundary_kymograph(ax, kymograph.sel(channel="a"))
    with pytest.raises(ParameterError, match="not evenly spaced"):
        draw_line_kymograph(ax, kymograph.sel(channel="a").isel(distance=[0, 1, 4]))
