"""One link of a cell: coefficients in standard deviations, and why it, or a part of it, was not tested."""

import numpy as np
import pytest
import xarray as xr

from cytodisk.analysis.prediction.prediction_parameters import PredictionParameters
from cytodisk.runs.predict.tested_link import TestedLink
from cytodisk.runs.predict.tested_link import tested_link as made_link

HOW = PredictionParameters(order=1, source_order=2, surrogates=0)


def series(seed: int) -> dict[str, xr.DataArray]:
    """A channel of two layers, and velocity that it drives a frame later; deviations 3 and 0.5."""
    random = np.random.default_rng(seed)
    channel, velocity = random.normal(size=(60, 2, 5)), random.normal(size=(60, 5))
    velocity[1:] += channel[:-1, 0]
    layers = {"layer": [0, 1]}
    return {
        "Rac1": xr.DataArray(3.0 * channel, layers, ("time", "layer", "sector")),
        "velocity": xr.DataArray(0.5 * velocity, dims=("time", "sector")),
    }


def link(left: dict[str, xr.DataArray]) -> TestedLink:
    return made_link("Rac1", "velocity", (), (series(0), left), HOW, [None, None])


def test_coefficients_are_in_standard_deviations_and_sum_up_to_the_effect() -> None:
    found = link({})
    lags, rows = found.lag_rows(5.0), found.rows(np.arange(2))
    assert lags["lag_s"].tolist() == [5.0, 10.0] * 2
    assert lags.groupby("layer")["coefficient"].sum().to_numpy() == pytest.approx(rows["effect"].to_numpy())
    first = lags[(lags["layer"] == 0) & (lags["lag"] == 1)].iloc[0]
    assert first["low"] < np.sqrt(0.5) < first["high"]
    assert rows["reason"].tolist() == ["", ""]


def test_what_was_not_tested_without_geometry_says_why() -> None:
    left = series(1)
    left["Rac1"] = left["Rac1"].where(left["Rac1"]["layer"] == 0)
    rows = link(left).rows(np.arange(2))
    assert rows["gain_partial"].notna().tolist() == [True, False]
    assert rows["status"].tolist() == ["ok", "ok"]
    assert rows["reason"].tolist() == ["", "without geometry: source is NaN in every frame and sector"]
    left["velocity"] = left["velocity"] * 0.0
    both = link(left).rows(np.arange(2))
    assert both["gain"].notna().all()
    assert both["reason"].str.startswith("without geometry: no layer can be tested: target is constant").all()
