from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cytodisk.pages.population import pooled_gain_page
from cytodisk.pages.population.pooled_gain_page import gain_page, shown_links
from cytodisk.pages.population.pooled_wave_page import wave_page
from cytodisk.plot.style import SINGLE_COLUMN_MM, WIDE_MM, paper_style
from cytodisk.runs.population.pooling.movie_by_movie import in_order
from cytodisk.runs.population.pooling.pool_parameters import PoolParameters
from cytodisk.runs.population.predictions.pooled_gains import pool_gains
from cytodisk.runs.population.predictions.pooled_prediction_columns import POOLED_PREDICTION_TABLES
from cytodisk.runs.population.wave_numbers.pooled_wave_columns import POOLED_WAVE_TABLES
from cytodisk.runs.population.wave_numbers.pooled_wave_numbers import pool_waves, wave_numbers
from cytodisk.store.populations.pooled_prediction import PooledPrediction
from cytodisk.store.populations.pooled_waves import PooledWaves
from cytodisk.store.predictions.prediction_store import write_prediction
from cytodisk.store.waves.waves_store import write_waves

LINKS = [("Rac1", "velocity"), ("velocity", "Rac1"), ("RhoA", "velocity")]


def cells_of(conditions: tuple[str, ...]) -> pd.DataFrame:
    rows = [(f"{name} {k}", 0, name, f"{name} {k}", "ok") for name in conditions for k in range(6)]
    return pd.DataFrame(rows, columns=["input", "cell", "condition", "experiment", "status"])


@pytest.fixture(scope="module")
def gains(tmp_path_factory: pytest.TempPathFactory) -> PooledPrediction:
    """Rac1 predicts velocity at the edge in the control alone."""
    rng = np.random.default_rng(0)
    cells = cells_of(("control", "drug"))
    rows = []
    for row in cells.itertuples():
        for source, target in LINKS:
            for layer in range(3):
                is_true = (source, layer, row.condition) == ("Rac1", 0, "control")
                score = 5.0 * is_true + rng.normal()
                rows.append((row.input, 0, source, target, layer, score, 0.01 * score))
    links = pd.DataFrame(rows, columns=["input", "cell", "source", "target", "layer", "score", "gain_excess"])
    links = links.assign(gain_excess_partial=np.nan, score_partial=np.nan)
    links = links.assign(gain=links["gain_excess"] + 0.01, gain_reversed=0.0)
    tables = {"cells": cells} | pool_gains(links, cells, PoolParameters(permutations=99)).tables
    columns = POOLED_PREDICTION_TABLES
    ordered = {name: in_order(table, columns[name]) for name, table in tables.items()}
    folder = tmp_path_factory.mktemp("batch")
    stored = write_prediction(folder, ("", "", ""), ordered, columns, {"signals": []})
    return PooledPrediction(stored.path, "", "", "", stored.settings)


def test_each_link_has_a_panel_and_dots_only_where_the_source_predicts(gains: PooledPrediction) -> None:
    assert shown_links(gains.pooled) == LINKS
    with paper_style():
        sheet = gain_page(gains)
    axes = sheet.figure.axes
    assert [ax.get_title(loc="left") for ax in axes if ax.get_title(loc="left")] == [
        "Rac1 → velocity",
        "velocity → Rac1",
        "RhoA → velocity",
    ]
    dots = [
        (ax.get_title(loc="left"), line.get_xdata().tolist())
        for ax in axes
        for line in ax.lines
        if line.get_gid() == "beyond chance"
    ]
    assert ("Rac1 → velocity", [2.5]) in dots  # layer 0 lies on the right
    assert sheet.figure.get_figwidth() * 25.4 == pytest.approx(SINGLE_COLUMN_MM)
    assert SINGLE_COLUMN_MM < WIDE_MM


def test_links_without_a_panel_are_said(gains: PooledPrediction, monkeypatch: pytest.MonkeyPatch) -> None:
    def words() -> list[str]:
        return [text.get_text() for text in gain_page(gains).figure.texts]

    assert not any("links" in one for one in words())
    monkeypatch.setattr(pooled_gain_page, "MOST_LINKS", 2)
    assert "2 of 3 links, with the largest gains; pooled.parquet has all" in words()


def test_dots_of_what_may_be_noise_are_hollow(
    gains: PooledPrediction, monkeypatch: pytest.MonkeyPatch
) -> None:
    def styles() -> list[str]:
        lines = [line for ax in gain_page(gains).figure.axes for line in ax.lines]
        return [str(line.get_fillstyle()) for line in lines if line.get_gid() == "beyond chance"]

    assert styles() == ["full"]
    weaker = gains.pooled.assign(weaker=gains.pooled["source"] == "Rac1")
    monkeypatch.setitem(gains.__dict__, "pooled", weaker)
    assert styles() == ["none"]


def test_numbers_of_waves_have_a_panel_where_a_cell_has_a_wave(tmp_path: Path) -> None:
    cells = cells_of(("control",)).assign(layer=np.nan, kind="rotating", p=0.01, period_s=90.0)
    cells = cells.assign(speed_um_s=0.1, direction=0.9, persistence_s=np.nan, order=np.arange(6) / 5 + 1.0)
    numbers = [
        wave_numbers(one, one[["cell", "layer", "order", "p"]]).assign(input=name)
        for name, one in cells.groupby("input")
    ]
    joined = pd.concat(numbers, ignore_index=True)
    pooled = pool_waves(joined, cells, PoolParameters(permutations=99)).tables
    tables = {"cells": cells, "numbers": joined.rename(columns={"channel": "number"})} | pooled
    columns = POOLED_WAVE_TABLES
    ordered = {name: in_order(table, columns[name]) for name, table in tables.items() if len(table)}
    stored = write_waves(tmp_path, "velocity", ordered, columns, {})
    with paper_style():
        sheet = wave_page(PooledWaves(stored.path, "velocity", "", stored.settings))
    labels = [ax.get_ylabel() for ax in sheet.figure.axes if ax.get_ylabel()]
    assert labels == ["order (0: none)", "speed along the edge (µm/s)", "period (s)"]
