import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from page_driver import Page, errors
from report_study import FRAMES, LAYERS, NAMES, SECTORS
from selenium import webdriver
from selenium.webdriver.support.ui import Select

from cytodisk.pages.report import shown_predictions, shown_waves
from cytodisk.pages.report.page import write_report
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.pages.report.shown_predictions import predictions_of
from cytodisk.pages.report.shown_waves import waves_of
from cytodisk.runs.predict.prediction_columns import PREDICTION_TABLES
from cytodisk.runs.waves.waves_columns import WAVE_TABLES
from cytodisk.store.predictions.prediction_store import write_prediction
from cytodisk.store.study import Study, open_study
from cytodisk.store.waves.waves_store import write_waves

SIGNAL = NAMES[1]


def columns_of(table: pd.DataFrame, columns: dict[str, tuple], name: str) -> pd.DataFrame:
    """The table with all its columns, those that are not there empty."""
    kinds = {column.name: column.kind.to_pandas_dtype() for column in columns[name]}
    missing = {
        one: "" if kind is np.object_ else False if kind is np.bool_ else np.nan
        for one, kind in kinds.items()
        if one not in table
    }
    return table.assign(**missing)[[*kinds]]


def predicted(study: Study) -> None:
    """Velocity is predicted in layer 1; what it predicts in layer 2 may be noise of measurement alone."""
    parts = []
    for source, target, q in ((SIGNAL, "velocity", 0.01), ("velocity", SIGNAL, 0.6)):
        one = pd.DataFrame({"cell": 0, "source": source, "target": target, "layer": range(LAYERS)})
        one = one.assign(
            gain=0.1, gain_excess=0.01 * one["layer"], p=q, q=np.where(one["layer"] == 1, q, 0.7)
        )
        one["weaker"] = (one["source"] == "velocity") & (one["layer"] == 2)
        one.loc[one["weaker"], "q"] = 0.02
        parts.append(one.assign(order=1, source_order=1, n=90, effect=0.4, status="ok"))
    links = columns_of(pd.concat(parts, ignore_index=True), PREDICTION_TABLES, "links")
    cells = pd.DataFrame({"cell": [0], "status": "ok", "frames": FRAMES, "surrogates": 99, "gaps": 0})
    lags = links[["cell", "source", "target", "layer"]].assign(lag=1, coefficient=0.4)
    tables = {
        "links": links,
        "lags": columns_of(lags, PREDICTION_TABLES, "lags"),
        "cells": columns_of(cells, PREDICTION_TABLES, "cells"),
    }
    settings = {"signals": [SIGNAL, "velocity"], "geometry": False}
    write_prediction(study.path, (SIGNAL, "velocity", ""), tables, PREDICTION_TABLES, settings)


def with_waves(study: Study) -> None:
    """A wave of velocity runs around the cell: one period in six frames."""
    row = {"kind": "rotating", "mode": 1, "period": 6.0, "period_s": 30.0, "speed_um_s": 0.2, "p": 0.01}
    row |= {"direction": 0.9, "persistence_s": 40.0, "order": 2.3, "q": 0.01, "status": "ok", "speed": 0.03}
    one = pd.DataFrame([{"cell": 0, "layer": np.nan} | row])
    places = pd.MultiIndex.from_product(
        [[0], range(FRAMES), range(SECTORS)], names=["cell", "frame", "sector"]
    )
    phase = places.to_frame(index=False).assign(layer=np.nan, amplitude=1.0)
    turn = 2 * np.pi * (phase["frame"] / 6.0 - phase["sector"] / SECTORS)
    phase["phase"] = np.angle(np.exp(1j * turn))
    cells = one.assign(frames=FRAMES, surrogates=99, edge_speed=0.2, periods=2.0, restarts=0)
    tables = {
        "cells": columns_of(cells, WAVE_TABLES, "cells"),
        "layers": columns_of(one.assign(edge_speed=0.2), WAVE_TABLES, "layers"),
        "phase": columns_of(phase, WAVE_TABLES, "phase"),
    }
    for name, table in tables.items():
        if "layer" in table:
            tables[name] = table.astype({"layer": "Int64"})
    write_waves(study.path, "velocity", tables, WAVE_TABLES, {})


@pytest.fixture
def tested(study: Study, tmp_path: Path) -> Study:
    """A copy of the study, with a prediction and waves."""
    shutil.copytree(study.path, tmp_path / "study")
    found = open_study(tmp_path / "study")
    predicted(found)
    with_waves(found)
    return found


@pytest.fixture
def cell(tested: Study, monkeypatch: pytest.MonkeyPatch) -> ShownCell:
    """A cell with results whose arrays are not packed."""
    for module in (shown_predictions, shown_waves):
        monkeypatch.setattr(module, "pack_floats", np.asarray)
    return ShownCell(tested, 0)


def test_links_have_their_numbers_by_layer_and_their_finding(cell: ShownCell) -> None:
    (found,) = predictions_of(cell)
    assert found["signals"] == [SIGNAL, "velocity"]
    there, back = found["links"]
    assert (there["source"], there["best_q"], back["best_q"]) == (SIGNAL, 0.01, 0.02)
    assert [there["doubtful"], back["doubtful"]] == [False, True]
    assert [np.nansum(there["lost"]), np.asarray(back["lost"])[2]] == [0, 1]
    np.testing.assert_allclose(there["gain_excess"], 0.01 * np.arange(LAYERS))
    assert "The other way round" in found["finding"][found["head"] - 1]  # the page begins with both


def test_layers_that_do_not_count_are_lost_and_links_of_these_alone_doubtful(cell: ShownCell) -> None:
    rows = pd.DataFrame({"layer": range(LAYERS), "q": 0.5, "gain_excess": 0.1, "given": "", "reason": ""})
    rows.loc[:1, "q"], rows.loc[0, "gain_excess"] = 0.01, 0.4
    rows = rows.assign(weaker=rows["layer"] == 0)
    one = shown_predictions._link(cell, "a", "b", rows)
    assert (one["doubtful"], one["best_gain"]) == (False, 0.1)
    np.testing.assert_array_equal(one["lost"], np.arange(LAYERS) == 0)
    one = shown_predictions._link(cell, "a", "b", rows.assign(geometry=rows["layer"] == 1))
    assert one["doubtful"]
    assert not shown_predictions._link(cell, "a", "b", rows.assign(q=0.5))["doubtful"]


def test_waves_have_their_phase_by_frame_and_sector(cell: ShownCell) -> None:
    (found,), notes = waves_of(cell)
    assert notes == []
    assert found["edge"]
    assert found["layers"][0]["period_s"] == 30.0
    phase = found["phase"]["0"]
    assert phase.shape == (FRAMES, SECTORS)
    np.testing.assert_allclose(phase[3, 0], np.pi)
    assert "30 s" in found["finding"][0] or "clockwise" in " ".join(found["finding"])


def test_much_phase_is_left_out_and_said(cell: ShownCell, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shown_waves, "MOST_PHASES", 5)
    _, notes = waves_of(cell)
    assert notes == ["phase of waves of velocity in layers but 0"]


def test_the_page_has_both_sections(tested: Study) -> None:
    html = write_report(tested).read_text(encoding="utf-8")
    assert 'id="predictions"' in html
    assert 'id="waves"' in html
    assert "drawResults" in html


@pytest.mark.slow
def test_a_browser_draws_both_sections(tested: Study, browser: webdriver.Chrome) -> None:
    page = Page(browser, write_report(tested))
    look = "['stroke', 'stroke-dasharray'].map((name) => link.children[1].getAttribute(name))"
    arrows = page.js(f"[...document.querySelectorAll('#figure-network .link')].map((link) => {look})")
    assert sorted(arrows) == [["#0072b2", None], ["#c8c8c8", "4 3"]]  # what does not count is grey and broken
    page.js("cytodisk.set({ layer: 2 })")
    page.settle()
    there, back = page.text("gain-numbers").split(". ")
    assert "in layer 2" in there
    assert "not counted" not in there
    assert "not counted" in back
    assert page.js("document.querySelectorAll('#figure-gain circle:not([fill=white])').length") == 1
    assert "v" in page.js("document.querySelector('#figure-waves .crests').getAttribute('d')")
    assert page.js("document.querySelectorAll('#wave-numbers tbody tr').length") == 1
    Select(page.control("wave-shows")).select_by_value("phase")
    page.settle()
    assert "crest" in page.text("bar-waves")
    assert errors(browser) == []
