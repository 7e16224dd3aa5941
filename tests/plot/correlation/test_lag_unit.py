import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.axes import Axes

import cytodisk as cd
from cytodisk.plot.correlation.lag_axis import LagUnit


def lags(interval_s: float) -> pd.DataFrame:
    return pd.DataFrame({"lag": [0, 1, -2], "lag_s": interval_s * np.array([0.0, 1.0, -2.0])})


@pytest.mark.parametrize(
    ("interval_s", "words", "shown"),
    [(5.0, "lag (s)", -10.0), (30.0, "lag (min)", -1.0), (3600.0, "lag (h)", -2.0)],
)
def test_lags_have_a_unit_that_suits(interval_s: float, words: str, shown: float) -> None:
    unit = LagUnit.of(lags(interval_s))
    assert unit.label == words
    assert unit.shown(lags(interval_s))["lag_s"].iloc[-1] == pytest.approx(shown)


def test_lags_without_seconds_are_in_frames() -> None:
    for table in (lags(np.nan), lags(1.0).drop(columns="lag_s")):
        assert (LagUnit.of(table).column, LagUnit.of(table).label) == ("lag", "lag (frames)")


def test_a_slow_velocity_is_in_nm(ax: Axes) -> None:
    attrs = {"units": "µm/s", "frame_interval_s": 5.0}
    velocity = xr.DataArray(np.full((6, 4), 0.02), dims=("time", "sector"), attrs=attrs)
    line = cd.plot.draw_mean_velocity(ax, velocity)
    assert ax.get_ylabel() == "edge velocity (nm/s)"
    np.testing.assert_allclose(line.get_ydata(), 20.0)
    assert cd.plot.draw_velocity_map(ax, velocity).get_clim() == pytest.approx((-20.0, 20.0))
