import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.layer_looks import shown_layers
from cytodisk.plot.movie.activity_maps import (
    draw_activity_map,
    draw_layers,
    draw_velocity_map,
)
from cytodisk.plot.style import MISSING_COLOUR
from cytodisk.scale import Scale


@pytest.fixture
def table() -> FloatArray:
    """5 frames of 8 sectors, one value missing."""
    values = np.arange(40.0).reshape(5, 8)
    values[2, 3] = np.nan
    return values


def test_time_goes_right_and_sectors_up(ax: Axes, table: FloatArray) -> None:
    drawn = draw_activity_map(ax, table, scale=Scale(frame_interval_s=10.0))
    array = np.ma.asarray(drawn.get_array())
    assert np.array_equal(array.filled(np.nan), table.T, equal_nan=True)
    assert drawn.get_extent() == [-5.0, 45.0, -0.5, 7.5]
    assert drawn.origin == "lower"
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("time (s)", "sector (0 at +x, towards +y)")


def test_missing_is_light_grey(ax: Axes, table: FloatArray) -> None:
    drawn = draw_activity_map(ax, table)
    assert tuple(drawn.to_rgba(drawn.get_array())[3, 2]) == to_rgba(MISSING_COLOUR)
    assert ax.get_xlabel() == "frame"


def test_limits_leave_outliers_out(ax: Axes) -> None:
    values = np.tile(np.linspace(0.0, 1.0, 100), (10, 1))
    values[0, 0] = 1e6
    drawn = draw_activity_map(ax, values)
    assert drawn.get_clim()[1] <= 1.0
    assert draw_activity_map(ax, values, limits=(2.0, 3.0)).get_clim() == (2.0, 3.0)


def test_colour_bar_says_the_label(ax: Axes, table: FloatArray) -> None:
    draw_activity_map(ax, table, label="mean $Rac1")
    (bar,) = ax.child_axes
    assert bar.get_ylabel() == "mean $Rac1 (a.u.)"


def test_velocity_is_red_outwards_and_white_at_rest(ax: Axes) -> None:
    velocity = np.array([[-0.1, 0.0, 0.3], [np.nan] * 3])
    drawn = draw_velocity_map(ax, velocity, scale=Scale(frame_interval_s=5.0))
    low, high = drawn.get_clim()
    assert low == -high
    inwards, rest, outwards = drawn.to_rgba(drawn.get_array())[:, 0, :3]
    assert outwards[0] > outwards[2] + 0.2
    assert inwards[2] > inwards[0] + 0.2
    assert min(rest) > 0.95
    assert ax.child_axes[0].get_ylabel() == "edge velocity (px/s)"


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_velocity_of_nothing(ax: Axes, value: float) -> None:
    assert draw_velocity_map(ax, np.full((3, 4), value)).get_clim() == (-1.0, 1.0)


def test_dimensions_are_known_by_name(ax: Axes, table: FloatArray) -> None:
    drawn = draw_activity_map(ax, xr.DataArray(table.T, dims=("sector", "time")))
    assert np.shape(drawn.get_array()) == (8, 5)


@pytest.mark.parametrize(
    ("layers", "shown"), [(1, [0]), (3, [0, 1, 2]), (4, [0, 1, 2, 3]), (6, [0, 2, 3, 5]), (10, [0, 3, 6, 9])]
)
def test_layers_from_edge_to_centre(layers: int, shown: list[int]) -> None:
    assert shown_layers(layers) == shown


def test_layers_share_colours_and_time() -> None:
    values = np.arange(5.0)[:, None, None] + 100.0 * np.arange(6)[:, None] + np.zeros(8)
    axes = list(Figure().subplots(5, 1))
    velocity, *maps = draw_layers(axes, values, np.ones((5, 8)), scale=Scale(frame_interval_s=60.0))
    assert velocity.get_clim() == (-1.0, 1.0)
    assert len({drawn.get_clim() for drawn in maps}) == 1
    assert [float(np.ma.asarray(drawn.get_array())[0, 0]) for drawn in maps] == [0.0, 200.0, 300.0, 500.0]
    assert [ax.get_xlabel() for ax in axes] == ["", "", "", "", "time (min)"]
    assert [ax.get_title(loc="left") for ax in axes][1:] == [
        "layer 0 (edge)",
        "layer 2",
        "layer 3",
        "layer 5 (centre)",
    ]
    assert sum(len(ax.child_axes) for ax in axes) == 2


def test_maps_refuse(ax: Axes, table: FloatArray) -> None:
    with pytest.raises(ParameterError, match=r"values.*shape \(40,\)"):
        draw_activity_map(ax, table.ravel())
    uneven = xr.DataArray(table, {"frame": ("time", [0, 1, 3, 4, 5])}, ("time", "sector"))
    with pytest.raises(ParameterError, match="values must hold frames at even steps"):
        draw_activity_map(ax, uneven)
    with pytest.raises(ParameterError, match=r"axes.*1"):
        draw_layers([ax], table[:, None], table)
    with pytest.raises(ParameterError, match=r"velocity.*\(4, 8\).*\(5, 1, 8\)"):
        draw_layers([ax, ax], table[:, None], table[:4])


def test_few_fast_places_do_not_pale_the_velocity(ax: Axes) -> None:
    velocity = np.full((10, 10), -1.0)
    velocity[3, :2] = 100.0
    assert draw_velocity_map(ax, velocity).get_clim() == (-3.0, 3.0)
