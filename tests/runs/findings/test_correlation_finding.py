"""The sentences of a correlation: what rises when, how sure it is, and what speaks against it."""

from __future__ import annotations

import re
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import cytodisk as cd
from cytodisk.runs.findings.correlation_finding import correlation_finding
from cytodisk.runs.findings.finding import Finding
from cytodisk.runs.told.correlation_words import finding_lines

STUDY: Any = SimpleNamespace(
    provenance={"parameters": {"layers": 3, "sectors": 20}},
)


def correlation(*, lag: int = 3, cells: int = 1, **row: Any) -> Any:
    """Layer 0 is significant; so is layer 1, a frame later.

    15 of layer 0's 20 windows have p < 0.05, 3 of them with the other sign and 2 at another lag.
    """
    about = {"status": "ok", "jitter": 0.0, "stress": "", "statistic": "pearson", "restarts": 0}
    about |= {"drifting_signal": 0.0, "drifting_with": 0.0, "geometry_not_tested": ""} | row
    layers = pd.DataFrame({"layer": [0, 1, 2], "lag": [lag, lag + 1, -8], "q": [0.002, 0.01, 0.6]})
    layers = layers.assign(
        correlation=[0.42, 0.3, -0.1], threshold=[0.2, 0.22, 0.25], lag_s=5.0 * layers["lag"]
    )
    layers = layers.assign(correlation_partial=[0.38, 0.2, 0.0], q_partial=[0.003, 0.01, 0.9], geometry=False)
    windows = pd.DataFrame({"layer": np.repeat([0, 1, 2], 20), "sector": np.tile(np.arange(20), 3)})
    windows = windows.assign(p=np.where(windows["sector"] < 15, 0.01, 0.5))
    windows["correlation"] = np.where(windows["sector"] < 3, -0.4, 0.4)
    windows["lag"] = np.select([windows["sector"] > 12, windows["sector"] > 8], [lag - 4, lag - 1], lag)
    numbers = range(cells)
    return SimpleNamespace(
        cells=pd.DataFrame([{"cell": cell} | about for cell in numbers]),
        layers=pd.concat([layers.assign(cell=cell) for cell in numbers], ignore_index=True),
        windows=pd.concat([windows.assign(cell=cell) for cell in numbers], ignore_index=True),
        clusters=None,
        signal="Rac1",
        with_="velocity",
        name="",
        settings={"geometry": True, "control": []},
    )


def finding(found: Any, *flagged: str) -> Finding:
    one = correlation_finding(STUDY, found, 0, flagged)
    assert one is not None
    return one


def test_what_nothing_speaks_against() -> None:
    found = finding(correlation())
    assert found.kind == "found"
    assert found.sentences == (
        "Rac1 in layer 0 (outermost) rises 15 s before the edge protrudes: correlation 0.42 (0.38 without "
        "geometry), q = 0.002.",
        "10 of 20 sectors show it by themselves (p < 0.05, lag within 1 frame); series shuffled in time "
        "would give fewer than 1. Rac1 comes first, as a cause would; that alone does not make it the cause. "
        "Layer 1 shows the same.",
        "This is one cell: what others do is not known.",
    )


def test_signs_and_lags_in_words() -> None:
    falls = correlation(lag=-3)
    falls.layers["correlation"] *= -1
    assert finding(falls).words.startswith("Rac1 in layer 0 (outermost) falls 15 s after the edge protrudes")
    assert "The edge comes first, and Rac1 follows." in finding(correlation(lag=-3)).words
    assert "rises while the edge protrudes" in finding(correlation(lag=0)).words
    slow = correlation()
    slow.layers["lag_s"] *= 12
    assert "rises 3 min before the edge" in finding(slow).words
    unknown = correlation(lag=1)
    unknown.layers["lag_s"] = np.nan
    assert "rises 1 frame before the edge" in finding(unknown).words
    other = correlation()
    other.signal, other.with_ = "edge", "RhoA"
    assert finding(other).words.startswith("Signal 'edge' in layer 0 (outermost) rises 15 s before RhoA")


@pytest.mark.parametrize(
    ("row", "lag", "words"),
    [
        ({"jitter": 0.2}, 0, "but masks that jitter make a correlation at this lag by themselves"),
        ({"stress": "common pulse"}, 3, "but a single pulse of the whole cell may have made it"),
        ({"drifting_with": 0.9}, 3, "but the level of many series drifts"),
        (
            {"geometry_not_tested": "gone"},
            3,
            "but what the motion of the cell alone would give was not tested",
        ),
    ],
)
def test_a_doubt_stands_in_the_same_sentence(row: dict[str, Any], lag: int, words: str) -> None:
    found = correlation(lag=lag, **row)
    if "jitter" in row:
        found.layers.loc[1, "q"] = 0.5
    told = finding(found)
    assert told.kind == "doubtful"
    assert words in told.sentences[0]
    assert "so it is no finding until that is settled" in told.sentences[0]


def test_geometry_takes_a_finding_away() -> None:
    found = correlation()
    found.layers["geometry"] = True
    found.layers["q_partial"] = 0.4
    told = finding(found)
    assert told.kind == "doubtful"
    assert "but no more than 0.38 (q = 0.4) is left without geometry: so it is no finding" in told.words


def test_what_is_left_at_another_lag_is_told_with_it() -> None:
    """A layer keeps enough at its lag while the partial correlation is larger elsewhere; or does not."""
    found = correlation()
    found.layers["lag_partial"] = found.layers["lag"] + 2
    assert "correlation 0.42 (0.38 at lag +25 s without geometry), q = 0.002" in finding(found).words
    found.layers["lag_partial"] = found.layers["lag"] + 1
    assert "correlation 0.42 (0.38 without geometry), q = 0.002" in finding(found).words
    found.layers["geometry"] = True
    told = finding(found)
    assert told.kind == "doubtful"
    assert "but less than half of it is left at this lag without geometry: so it is no finding" in told.words


def test_flags_of_the_run_stand_in_the_same_sentence() -> None:
    told = finding(correlation(), "area jumps", "edge mismatch")
    assert told.kind == "doubtful"
    assert told.sentences[0].endswith(
        ", but QC flags are raised that bear on it: area jumps and edge mismatch."
    )


def test_nothing_and_what_could_have_been_seen() -> None:
    found = correlation()
    found.layers["q"] = 0.5
    told = finding(found)
    assert told.kind == "nothing"
    assert told.sentences[0] == (
        "Rac1 and edge velocity show no correlation beyond chance in any of 3 layers: the largest is 0.42 in "
        "layer 0 at lag +15 s (q = 0.5)."
    )
    assert "reach 0.20 to 0.25, by layer, in 5 % of tries" in told.sentences[1]


def test_other_cells_are_counted() -> None:
    found = correlation(cells=3)
    found.layers.loc[found.layers["cell"] == 2, "lag"] = 9
    assert finding(found).sentences[2] == "The same (layer, sign, lag within 1 frame) in 2 of 3 cells."
    found.cells.loc[1, "stress"] = "common pulse"  # no more than a doubt, but no cell to count on
    assert finding(found).sentences[2].endswith("in 1 of 3 cells.")


def test_without_surrogates_and_without_the_cell() -> None:
    found = correlation()
    found.layers = found.layers.drop(columns="q")
    told = finding(found)
    assert (told.kind, "was not tested (--surrogates 0)" in told.words) == ("doubtful", True)
    assert correlation_finding(STUDY, found, 7) is None


def test_a_cluster_alone() -> None:
    found = correlation()
    found.layers["q"] = 0.5
    cluster = {
        "cell": 0,
        "cluster": 1,
        "lag": -2,
        "lag_s": -10.0,
        "correlation": 0.31,
        "windows": 18,
        "p": 0.004,
    }
    found.clusters = pd.DataFrame([cluster | {"layers": "0–2", "sectors": "12–25", "p_partial": 0.01}])
    assert finding(found).sentences[0] == (
        "Rac1 in sectors 12–25, layers 0–2 rises 10 s after the edge protrudes: correlation 0.31 in 18 "
        "neighbouring windows, p = 0.004 (0.01 without geometry)."
    )


def test_what_else_is_in_doubt_is_told_together() -> None:
    """A clear layer beside one at a lag of jitter; and all in doubt."""
    found = correlation(jitter=0.2)
    found.layers.loc[1, ["lag", "lag_s"]] = 0, 0.0
    assert finding(found).sentences[2].endswith("; not yet to be believed: layer 1 (jitter).")
    pulse = correlation(stress="common pulse")
    pulse.layers.loc[2, "q"] = 0.01
    told = "Also significant, and also in doubt: layers 1 and 2 (common pulse)."
    assert finding(pulse).sentences[1] == told
    pulse.layers["geometry"] = pulse.layers["layer"] == 2
    assert finding(pulse).sentences[1] == (
        "Also significant, and also in doubt: layer 1 (common pulse) and layer 2 (common pulse, not without "
        "geometry)."
    )


def test_a_variant_is_named() -> None:
    found = correlation()
    found.name = "early frames"
    assert "before the edge protrudes (early frames): correlation" in finding(found).words
    found.layers["q"] = 0.5
    assert finding(found).words.startswith("Rac1 and edge velocity (early frames) show no correlation")


def test_one_layer_and_none() -> None:
    found = correlation()
    found.layers = found.layers[:1].assign(q=0.5)
    assert "in the one layer there is: the largest is 0.42" in finding(found).words
    found.layers["correlation"] = np.nan
    assert "could not be correlated in any layer" in finding(found).words


def test_cells_whose_finding_is_not_told_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cytodisk.runs.qc_flags.study_flags.run_flags", lambda _: [])
    *told, last = finding_lines(correlation(cells=5), STUDY)
    assert [line.partition(":")[0] for line in told] == [f"Finding, cell {cell}" for cell in range(3)]
    assert last == "… and those of 2 more cells: they stand in the report"


def test_numbers_as_names_of_channels() -> None:
    found = correlation()
    found.signal = "488"
    assert finding(found).words.startswith("Channel 488 in layer 0 (outermost) rises")


def test_sectors_by_chance_are_no_fewer_than_those_of_series_without_a_coupling() -> None:
    """Of 200 sectors of noise that share nothing, as many look alike by themselves as the sentence grants."""
    rng = np.random.default_rng(0)
    series = [xr.DataArray(rng.normal(size=(60, 1, 200)), dims=("time", "layer", "sector")) for _ in range(2)]
    peaks = cd.peak_correlation(cd.cross_correlate(*series, max_lag=5, surrogates=99))
    windows = peaks.to_dataframe().reset_index().assign(cell=0, layer=0)
    found = correlation(lag=1)
    found.windows = windows
    told = finding(found).sentences[1]
    alike, granted = (int(re.findall(words, told)[0]) for words in (r"^(\d+) of 200", r"at most about (\d+)"))
    assert granted == 5
    assert alike <= granted < (windows["p"] < 0.05).sum()
