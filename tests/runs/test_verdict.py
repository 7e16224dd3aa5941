"""What speaks against a correlation is told of each layer and cluster."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

from cytodisk.runs.correlate.verdict import jittered_rows, verdict_words


def correlation(jitter: float = 0.0, **cells: Any) -> Any:
    """Layers 0 to 3 at lags −2, 0, 3 and 5, of which 2 does not survive and 3 is not significant."""
    row = {"cell": 0, "status": "ok", "jitter": jitter, "stress": "", "statistic": "pearson", "restarts": 0}
    row |= {"drifting_signal": 0.0, "drifting_with": 0.0, "geometry_not_tested": ""} | cells
    layers = pd.DataFrame({"cell": 0, "layer": [0, 1, 2, 3], "lag": [-2, 0, 3, 5], "lag_s": np.nan})
    layers = layers.assign(q=[0.01, 0.01, 0.01, 0.3], correlation_partial=0.2)
    layers["geometry"] = [False, False, True, False]
    return SimpleNamespace(
        cells=pd.DataFrame([row]),
        layers=layers,
        clusters=None,
        with_="velocity",
        settings={"geometry": True, "control": []},
    )


def test_each_layer_goes_where_it_belongs() -> None:
    assert verdict_words(correlation(jitter=0.1), 0) == (
        "Nothing speaks against: layer 0 (lag −2 frames). Only after flags are settled: layer 1 (jitter). "
        "Not without geometry: layer 2."
    )
    assert verdict_words(correlation(), 0).startswith(
        "Nothing speaks against: layer 0 (lag −2 frames), layer 1 (lag 0). Not"
    )


@pytest.mark.parametrize(
    ("cells", "words"),
    [
        ({"jitter": np.nan}, "layer 1 (jitter not known)"),
        ({"stress": "common pulse"}, "layer 0, layer 1 (common pulse)"),
        ({"drifting_signal": 0.9}, "layer 0, layer 1 (drifting series)"),
        ({"geometry_not_tested": "the signal is gone"}, "layer 0, layer 1 (geometry not tested)"),
    ],
)
def test_doubts_are_named(cells: dict[str, Any], words: str) -> None:
    assert f"Only after flags are settled: {words}" in verdict_words(correlation(**cells), 0)


def test_ranks_cure_a_pulse_but_not_an_oscillation() -> None:
    cured = correlation(stress="common pulse, steady oscillation", statistic="spearman")
    assert "layer 0, layer 1 (steady oscillation)" in verdict_words(cured, 0)


def test_nothing_significant_and_nothing_tested() -> None:
    found = correlation()
    found.layers["q"] = 0.5
    assert verdict_words(found, 0) == "No layer and no cluster is significant."
    found.layers = found.layers.drop(columns="q")
    assert verdict_words(found, 0) == ""
    assert verdict_words(correlation(status="refused"), 0) == ""


def test_jitter_has_its_lags() -> None:
    found = correlation(jitter=-0.1)
    assert jittered_rows(found, found.layers).tolist() == [False, True, False, False]
    found.settings["difference"] = True
    assert jittered_rows(found, found.layers).tolist() == [True, True, False, False]
    found.with_ = "actin"
    assert not jittered_rows(found, found.layers).any()
