import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from cytodisk.plot.movie.layer_lines import draw_by_layer
from cytodisk.scale import Scale


def test_measures_by_layer(ax: Axes) -> None:
    values = np.array([[1.0, 2.0], [np.nan, 2.0], [3.0, 2.0]])
    frames = {"frame": ("time", [1, 2, 3])}
    table = xr.DataArray(values, frames, ("time", "layer"), attrs={"units": "µm"})
    edge, centre = draw_by_layer(ax, table, [0, 1], "length", scale=Scale(frame_interval_s=2.0))
    assert edge.get_xdata().tolist() == [2.0, 4.0, 6.0]
    assert edge.get_markevery().tolist() == [True, False, True]
    assert centre.get_markevery().tolist() == [False] * 3
    assert ax.get_xlim() == (1.0, 7.0)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("time (s)", "length (µm)")
