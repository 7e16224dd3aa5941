"""Tables with a row a window, as arrays and back."""

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.store.populations.window_arrays import window_arrays, window_rows


def _arrays() -> xr.Dataset:
    rng = np.random.default_rng(0)
    dims = ("condition", "channel", "layer", "sector")
    coords = {
        "condition": ["b", "a"],
        "channel": ["z", "y"],
        "layer": [0, 1, 2],
        "sector": np.arange(4),
        "compartment": ("layer", ["cytoplasm", "cytoplasm", "nucleus"]),
    }
    found = xr.Dataset({"mean": (dims, rng.normal(size=(2, 2, 3, 4)))}, coords)
    return found.assign(depth=("layer", [0.5, 1.0, np.nan]), status=found["mean"].astype("U3"))


def test_arrays_come_back_from_their_rows() -> None:
    found = _arrays()
    rows = window_rows(found)
    assert len(rows) == 2 * 2 * 3 * 4
    assert rows["compartment"].tolist()[8:12] == ["nucleus"] * 4
    rows.attrs["units"] = {"mean": "a.u."}
    back = window_arrays(rows, "condition")
    xr.testing.assert_equal(back["mean"], found["mean"])
    assert back["condition"].values.tolist() == ["b", "a"]
    assert back["mean"].attrs["units"] == "a.u."
    assert back["compartment"].values.tolist() == found["compartment"].values.tolist()
    assert (back["status"] == found["status"]).all()


def test_curves_have_lags_in_place_of_sectors() -> None:
    table = pd.DataFrame(
        {"channel": "", "layer": np.repeat([0, 1], 3), "lag": [-5.0, 0.0, 5.0] * 2, "p": np.arange(6) / 6}
    )
    found = window_arrays(table)
    assert found["p"].dims == ("channel", "layer", "lag")
    assert float(found["p"].sel(channel="", layer=1, lag=-5.0)) == 0.5
