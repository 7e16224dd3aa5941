import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from cytodisk.plot.movie.mean_velocity import draw_mean_velocity


def test_mean_velocity_and_spread(ax: Axes) -> None:
    velocity = np.tile(np.arange(11.0), (3, 1))
    velocity[1] = np.nan
    velocity[2, 0] = np.nan
    table = xr.DataArray(velocity, {"frame": ("time", [4, 5, 6])}, ("time", "sector"))
    line = draw_mean_velocity(ax, table)
    assert line.get_xdata().tolist() == [4.0, 5.0, 6.0]
    assert np.allclose(line.get_ydata(), [5.0, np.nan, 5.5], equal_nan=True)
    spread = ax.collections[0].get_paths()[0].vertices
    assert {1.0, 9.0} <= set(spread[spread[:, 0] == 4.0, 1])
