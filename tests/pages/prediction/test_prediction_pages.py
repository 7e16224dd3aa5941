"""The pages of predictions: which are drawn, whole and readable, in every format."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from cytodisk.errors import ParameterError
from cytodisk.pages.prediction import prediction_pages
from cytodisk.pages.prediction.prediction_files import write_prediction_figures
from cytodisk.plot.prediction.drawn_links import drawn_links
from cytodisk.runs.predict.predict_study import predict_study
from cytodisk.runs.qc_flags.one_prediction import UnwrittenPrediction
from made_study import MadeStudy, made_activity, made_study, predicting_activity

FEW: Any = {"max_order": 3, "surrogates": 39, "geometry": False}
LONG = "a very long name of a channel, much too long"


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> MadeStudy:
    return made_study(tmp_path_factory.mktemp("pages") / "out", {0: predicting_activity(0, strength=0.6)})


def texts(figure: Figure) -> str:
    return " ".join(text.get_text() for text in figure.findobj(lambda one: hasattr(one, "get_text")))


def names(paths: list[Path]) -> list[str]:
    return [path.name for path in paths]


def test_pages_of_a_pair(study: MadeStudy, drawn: list[Figure]) -> None:
    found = predict_study(study, "Rac1", "velocity", **FEW | {"surrogates": 99})
    steps: list[tuple[int, int]] = []
    paths = write_prediction_figures(study, found, progress=lambda *step: steps.append(step))
    assert names(paths) == [f"cell_00000_{what}.png" for what in ("network", "profile", "lags")]
    assert steps == [(done, 3) for done in range(4)]
    network, profile, lags = drawn
    for figure in drawn:
        assert figure.get_size_inches()[0] == pytest.approx(85 / 25.4)
        assert "nothing given" in texts(figure)
        assert "99 shifted sources" in texts(figure)
    assert "Rac1 → edge velocity, and back" in texts(profile)
    assert "layers 0–1" in texts(network)
    assert "source earlier by (s)" in texts(lags)


def test_pages_of_a_network_with_a_long_name(
    tmp_path: Path, drawn: list[Figure], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(prediction_pages, "_MOST_PROFILES", 5)
    monkeypatch.setattr(prediction_pages, "_MOST_PANELS", 1)
    activity = predicting_activity(1, strength=0.6)
    rac1, rhoa = (activity["mean"].sel(channel=name).to_numpy() for name in ("Rac1", "RhoA"))
    channels = {"Rac1": rac1, LONG: rhoa, "actin": np.roll(rac1, 1, axis=0)}
    made = made_activity(channels, activity["velocity"].to_numpy())
    there = made_study(tmp_path / "out", {0: made})
    found = predict_study(there, **FEW | {"surrogates": 499}, name="all")
    assert names(write_prediction_figures(there, found)) == [
        f"cell_00000_{what}.png" for what in ("network", "profile", "lags")
    ]
    assert "all others given" in texts(drawn[0])
    assert "“all”" in texts(drawn[0])
    assert "first: Rac1, second: a very …o long" in texts(drawn[1])
    assert "5 of 6 pairs, with the largest gains; links.parquet has all" in texts(drawn[1])
    many = len(drawn_links(found.links))
    assert many > 1
    assert f"1 of {many} links, with the largest gains; links.parquet has all" in texts(drawn[2])


def test_nothing_found_is_said(tmp_path: Path, drawn: list[Figure]) -> None:
    there = made_study(tmp_path / "out", {0: predicting_activity(2, coupling="none")})
    found = predict_study(there, "RhoA", "velocity", **FEW)
    write_prediction_figures(there, found)
    assert "No signal predicts another beyond chance." in texts(drawn[0])


def test_what_does_not_count_is_said(study: MadeStudy, drawn: list[Figure]) -> None:
    found = predict_study(study, "Rac1", "velocity", **FEW | {"surrogates": 99}, name="lost")
    tables = {name: getattr(found, name) for name in ("links", "lags", "pooled", "cells")}
    tables["links"] = tables["links"].assign(geometry=[True, False, False, False])
    lost = UnwrittenPrediction(found.path, "Rac1", "velocity", "lost", found.settings, tables)
    write_prediction_figures(study, lost)
    for figure in drawn[:2]:
        assert "not counted: geometry, or noise of measurement, may make it" in texts(figure)


def test_without_shifted_sources_there_is_no_network(study: MadeStudy, drawn: list[Figure]) -> None:
    found = predict_study(study, "Rac1", "velocity", **FEW | {"surrogates": 0}, name="raw")
    assert names(write_prediction_figures(study, found)) == ["cell_00000_profile.png", "cell_00000_lags.png"]
    assert "not compared with chance" in texts(drawn[0])


def test_a_cell_that_was_not_tested_is_refused(study: MadeStudy) -> None:
    found = predict_study(study, "Rac1", "velocity", **FEW, name="one")
    with pytest.raises(ParameterError, match=r"cell 3 is not in .*: it has \[0\]"):
        write_prediction_figures(study, found, cell=3)
