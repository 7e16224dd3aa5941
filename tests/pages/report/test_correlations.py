import shutil

import numpy as np
import pandas as pd
import pytest
from report_study import LAGS, LAYERS, NAMES, SECTORS, correlated

from cytodisk.pages.report import shown_correlations as correlations
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.pages.report.shown_correlations import pairs_of
from cytodisk.runs.correlate.correlation_columns import CORRELATION_TABLES
from cytodisk.store.correlation_store import write_correlation
from cytodisk.store.study import Study


@pytest.fixture
def plain(study: Study, monkeypatch: pytest.MonkeyPatch) -> ShownCell:
    """A cell with one correlation whose arrays are not packed."""
    write_correlation(study.path, NAMES[1], "velocity", correlated(), CORRELATION_TABLES, {"max_lag": 3})
    monkeypatch.setattr(correlations, "pack_floats", np.asarray)
    return ShownCell(study, 0)


def test_tables_become_arrays(plain: ShownCell) -> None:
    (pair,), notes = pairs_of(plain)
    assert notes == []
    assert (pair["signal"], pair["with"], pair["lags"]) == (NAMES[1], "velocity", LAGS.tolist())
    assert pair["windows"]["correlation"].shape == (LAYERS, SECTORS)
    np.testing.assert_allclose(pair["windows"]["correlation"][2], 0.01 * np.arange(SECTORS))
    assert pair["curves"]["low"].shape == (LAYERS, SECTORS, len(LAGS))
    np.testing.assert_allclose(pair["curves"]["correlation"][1, 5], 0.1 * LAGS)
    np.testing.assert_allclose(pair["layer_curves"], np.full((LAYERS, len(LAGS)), 0.05))
    np.testing.assert_allclose(pair["layers"]["threshold"], 0.25)


def test_the_largest_clusters_are_listed(study: Study, plain: ShownCell) -> None:
    assert pairs_of(plain)[0][0]["peak_notes"] == []  # they were not looked for
    row = {"cell": 0, "lag": -4, "lag_s": -20.0, "sign": 1, "correlation": 0.31, "windows": 30, "mass": 40.0}
    row |= {"p": 0.002, "layers": "0–2", "sectors": "50–5"}
    five = pd.DataFrame([row | {"cluster": number} for number in range(1, 6)])
    for table, expected in (
        (five, ["cluster 1: sectors 50–5, layers 0–2, lag −20 s, r +0.31, p = 0.002"]),
        (five[:1].assign(layers="3", lag_s=np.nan), ["cluster 1: sectors 50–5, layer 3, lag −4 frames, r"]),
        (five[:0], ["no cluster of neighbouring windows"]),
    ):
        write_correlation(
            study.path, NAMES[1], "velocity", correlated() | {"clusters": table}, CORRELATION_TABLES, {}
        )
        (pair,), _ = pairs_of(plain)
        assert pair["peak_notes"][0].startswith(expected[0])
        assert len(pair["peak_notes"]) == min(max(len(table), 1), 4)


def test_variants_of_the_same_names_are_told_apart(study: Study, plain: ShownCell) -> None:
    settings = {"detrend": "linear"}
    folder = write_correlation(
        study.path, NAMES[1], "velocity", correlated(), CORRELATION_TABLES, settings, "steady"
    ).path
    pairs, _ = pairs_of(plain)
    shutil.rmtree(folder)
    words = f"{NAMES[1]} with velocity"
    assert [pair["label"] for pair in pairs] == [words, f"{words} (steady): linear detrending"]
    assert [pair["differs"] for pair in pairs] == ["", "“steady”, linear detrending"]


def test_those_with_velocity_come_first(study: Study, plain: ShownCell) -> None:
    folder = write_correlation(study.path, NAMES[1], NAMES[0], correlated(), CORRELATION_TABLES, {}).path
    pairs, _ = pairs_of(plain)
    assert [pair["with"] for pair in pairs] == ["velocity", NAMES[0]]
    shutil.rmtree(folder)


def test_what_was_not_computed_is_unknown(study: Study, plain: ShownCell) -> None:
    tables = correlated()
    tables["windows"] = tables["windows"].drop(columns=["p", "q", "threshold"])
    tables["layers"] = tables["layers"].drop(columns=["p", "q", "threshold"])
    write_correlation(study.path, NAMES[1], "velocity", tables, CORRELATION_TABLES, {})
    (pair,), _ = pairs_of(plain)
    assert np.isnan(pair["windows"]["q"]).all()
    assert np.isnan(pair["layers"]["threshold"]).all()
    assert np.isfinite(pair["windows"]["correlation"]).all()


def test_too_many_curves_are_left_out(plain: ShownCell) -> None:
    (pair,), notes = pairs_of(plain, 10)
    assert pair["curves"] is None
    assert notes == ["correlation curves of single windows (only those of layers are shown)"]


def test_cell_that_was_not_correlated(study: Study, plain: ShownCell) -> None:
    tables = {name: table.assign(cell=7) for name, table in correlated().items()}
    for table in tables.values():
        table.attrs["units"] = dict.fromkeys(table, "")
    write_correlation(study.path, NAMES[1], "velocity", tables, CORRELATION_TABLES, {})
    pairs, notes = pairs_of(plain)
    assert pairs == []
    assert notes == [f"correlation of {NAMES[1]} with velocity, which this cell has not"]


def test_the_partial_correlation_is_beside_the_raw_one(study: Study, plain: ShownCell) -> None:
    tables = correlated()
    assert pairs_of(plain)[0][0]["without"] == ""
    tables["layers"] = tables["layers"].assign(correlation_partial=0.01, q_partial=0.8)
    tables["layer_curves"] = tables["layer_curves"].assign(correlation_partial=0.02)
    tables["cells"] = tables["cells"].assign(geometry_not_tested="")
    for table in tables.values():
        table.attrs["units"] = dict.fromkeys(table, "")
    settings = {"geometry": True, "control": ["volume"]}
    write_correlation(study.path, NAMES[1], "velocity", tables, CORRELATION_TABLES, settings)
    (pair,), _ = pairs_of(plain)
    assert pair["without"] == "without geometry and volume"
    np.testing.assert_allclose(pair["layer_partial"], np.full((LAYERS, len(LAGS)), 0.02))
    np.testing.assert_allclose(pair["layers"]["q_partial"], 0.8)
