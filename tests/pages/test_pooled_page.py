from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes

from cytodisk.pages.population.pooled_page import pooled_page, write_pooled_figure
from cytodisk.plot.style import SINGLE_COLUMN_MM
from cytodisk.runs.population.correlations.pooled_columns import POOLED_TABLES
from cytodisk.runs.population.correlations.pooled_curves import pool_curves
from cytodisk.runs.population.pooling.pool_parameters import PoolParameters
from cytodisk.store.correlation_store import write_correlation
from cytodisk.store.populations.pooled_correlation import PooledCorrelation

LAGS = np.arange(-3, 4)


@pytest.fixture(scope="module")
def pooled(tmp_path_factory: pytest.TempPathFactory) -> PooledCorrelation:
    """Two conditions of six experiments, of which the control alone correlates, at lag 1 of layer 0."""
    rng = np.random.default_rng(0)
    curves, cells = [], []
    for condition in ("drug", "control"):
        for experiment in range(6):
            group = {"condition": condition, "experiment": f"day {experiment}"}
            place = {"input": f"{condition} {experiment}", "cell": 0}
            cells.append(place | group | {"status": "ok"})
            for layer in range(2):
                size = 0.6 * (condition == "control" and layer == 0) * (LAGS == 1)
                raw = np.tanh(size + rng.normal(0.0, 0.05, len(LAGS)))
                one = pd.DataFrame({"lag": LAGS, "lag_s": 5.0 * LAGS, "correlation": raw})
                curves.append(one.assign(layer=layer, correlation_partial=raw / 2, **place, **group))
    joined, table = pd.concat(curves, ignore_index=True), pd.DataFrame(cells)
    plain = joined.drop(columns=["condition", "experiment"])
    found = pool_curves(plain, table, ("Rac1", "velocity"), PoolParameters())
    tables = found.tables | {"cells": table, "curves": joined}
    stored = write_correlation(
        tmp_path_factory.mktemp("batch"), "Rac1", "velocity", tables, POOLED_TABLES, {}
    )
    return PooledCorrelation(stored.path, "Rac1", "velocity", "", stored.settings)


def lines(ax: Axes, gid: str) -> list[np.ndarray]:
    return [np.asarray(line.get_xydata()) for line in ax.get_lines() if line.get_gid() == gid]


def test_means_are_those_of_the_table_and_the_control_comes_first(pooled: PooledCorrelation) -> None:
    axes = pooled_page(pooled).figure.axes
    assert [ax.get_title(loc="left") for ax in axes] == ["layer 0 (edge)", "layer 1 (centre)"]
    control, drug = lines(axes[0], "mean")
    table = pooled.pooled.query("layer == 0 and curve == 'raw'")
    for line, name in ((control, "control"), (drug, "drug")):
        own = table[table["condition"] == name]
        np.testing.assert_allclose(line, own[["lag_s", "correlation"]], atol=2e-3)


def test_dots_stand_at_lags_beyond_chance_alone(pooled: PooledCorrelation) -> None:
    axes = pooled_page(pooled).figure.axes
    (dots,) = lines(axes[0], "beyond chance")
    assert dots[:, 0].tolist() == [5.0]
    assert not lines(axes[1], "beyond chance")


def test_partial_curves_are_broken_lines(pooled: PooledCorrelation) -> None:
    broken = lines(pooled_page(pooled).figure.axes[0], "partial")
    assert len(broken) == 2
    assert broken[0][:, 1].max() == pytest.approx(np.tanh(0.6) / 2, abs=0.05)


def test_all_that_is_drawn_lies_on_a_column_and_in_the_axes(pooled: PooledCorrelation) -> None:
    sheet = pooled_page(pooled)
    assert sheet.width_mm == SINGLE_COLUMN_MM
    for ax in sheet.figure.axes:
        low, high = ax.get_ylim()
        drawn = [one[:, 1] for gid in ("mean", "partial", "beyond chance") for one in lines(ax, gid)]
        heights = np.concatenate(drawn)
        assert low <= np.nanmin(heights)
        assert np.nanmax(heights) <= high


def test_the_figure_is_written_where_the_correlation_is(pooled: PooledCorrelation) -> None:
    paths = write_pooled_figure(pooled, formats=["png", "svg"])
    assert [path.name for path in paths] == ["curves.png", "curves.svg"]
    assert paths[0].parent == pooled.path / "figures"
    assert Path(paths[1]).read_text().count("control") >= 1
