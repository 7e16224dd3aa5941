"""Sentences about predictions: both directions, what was given, what speaks against it."""

from typing import Any

import pandas as pd
import pytest

from cytodisk.runs.findings.prediction_finding import pooled_finding, prediction_finding
from cytodisk.runs.link_words import effect_words, less_error, prediction_name, signal_words
from cytodisk.runs.predict.prediction_verdict import directions
from cytodisk.runs.qc_flags.one_prediction import UnwrittenPrediction, with_one_prediction
from cytodisk.runs.qc_flags.study_flags import prediction_flags_of
from cytodisk.runs.told.prediction_words import prediction_finding_lines, prediction_lines
from made_study import MadeStudy, made_study, predicting_activity

PAIR = ("Rac1", "velocity")

AT_FIRST = "at first (later coefficients have the other sign: it ends, or turns to"


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> MadeStudy:
    made = {cell: predicting_activity(cell, frames=20) for cell in (0, 1)}
    return made_study(tmp_path_factory.mktemp("findings") / "out", made)


def link(source: str, target: str, layer: int, q: float, **more: Any) -> dict[str, Any]:
    known = {"cell": 0, "source": source, "target": target, "given": "", "layer": layer, "q": q}
    known |= {"gain": 0.05, "gain_excess": 0.04, "order": 2, "source_order": 3, "effect": 0.2, "n": 500}
    known |= {"gain_partial": 0.045, "gain_excess_partial": 0.035, "q_partial": q, "geometry": False}
    known |= {"gain_reversed": 0.05, "weaker": False, "drifting": 0.0}
    return known | {"p": q, "stress": "", "status": "ok", "reason": ""} | more


def found_with(study: MadeStudy, rows: list[dict[str, Any]], **more: Any) -> UnwrittenPrediction:
    """A prediction of these links, and of a cell that nothing speaks against but what is given."""
    cell = {"cell": 0, "status": "ok", "reason": "", "frames": 120, "gaps": 0, "surrogates": 999}
    cell |= {"jitter": 0.0, "velocity_jitter": 0.01, "geometry_not_tested": "", "restarts": 0}
    cell |= {"drifting": 0.0, "not_given": "RhoA"}
    settings = {"geometry": True, "given": None, "signals": list(PAIR), "surrogates": 999}
    own = {name: more.pop(name) for name in list(more) if name in cell}
    names = more.pop("names", PAIR)
    links = pd.DataFrame(rows)
    keys = {name: links[name] for name in ("cell", "source", "target", "layer")}
    lags = more.pop("lags", pd.DataFrame(keys).assign(lag=1, coefficient=0.2, low=0.1, high=0.3))
    pooled = links.assign(cells=1)
    tables = {"links": links, "cells": pd.DataFrame([cell | own]), "pooled": pooled, "lags": lags}
    return UnwrittenPrediction(study.path, *names, "", settings | more, tables)


def pair(*there: dict[str, Any], back: float = 0.4) -> list[dict[str, Any]]:
    return [*there, link("velocity", "Rac1", 0, back), link("velocity", "Rac1", 1, 0.9)]


def test_one_way(study: MadeStudy) -> None:
    found = found_with(study, pair(link(*PAIR, 0, 0.002), link(*PAIR, 1, 0.01, gain_excess=0.01)))
    told = prediction_finding(study, found, 0)
    assert told is not None
    assert told.kind == "found"
    assert told.size == 0.04
    assert told.sentences[0] == (
        "Rac1 predicts edge velocity in layer 0 (outermost): 4.9 % less error with its past 15 s (4.4 % "
        "without geometry, q = 0.002); more Rac1 is followed by protrusion; layer 1 does, too."
    )
    assert told.sentences[1] == (
        "The other way round, edge velocity does not predict Rac1 in any layer (all q ≥ 0.4)."
    )
    assert told.sentences[2] == (
        "Nothing else was given; a common driver that was not given, such as RhoA, can do the same."
    )


def test_both_ways_say_which_is_stronger(study: MadeStudy) -> None:
    rows = pair(link(*PAIR, 0, 0.002, gain_excess=0.12), back=0.01)
    told = prediction_finding(study, found_with(study, rows), 0)
    assert told is not None
    assert "of both directions Rac1 → edge velocity is 3 times as strong" in told.sentences[1]


@pytest.mark.parametrize(
    ("of_link", "of_cell", "words"),
    [
        ({"geometry": True, "q_partial": 0.5}, {}, "not without what the cell's motion alone would give"),
        ({"geometry": True}, {}, "less than a quarter of that is left without geometry"),
        ({}, {"velocity_jitter": 0.3}, "masks that jitter make each of them predict the other"),
        ({}, {"jitter": -0.1}, "masks that jitter make each of them predict the other"),
        ({"stress": "common pulse"}, {}, "a single pulse of the whole cell"),
        ({"weaker": True}, {}, "it is the weaker of both directions, and noise of measurement alone"),
        ({"drifting": 0.6}, {}, "the level of many series drifts"),
        ({}, {"restarts": 1}, "tracking started anew"),
        ({"weaker": True}, {"restarts": 1, "jitter": 0.1}, "(also in doubt: jitter, tracking started anew)"),
        ({"gain_partial": float("nan")}, {}, "what the motion of the cell alone would give was not tested"),
        ({}, {"geometry": False}, "what the motion of the cell alone would give was not tested"),
    ],
)
def test_doubts_are_the_second_half_of_the_sentence(
    study: MadeStudy, of_link: dict[str, Any], of_cell: dict[str, Any], words: str
) -> None:
    told = prediction_finding(study, found_with(study, pair(link(*PAIR, 0, 0.01, **of_link)), **of_cell), 0)
    assert told is not None
    assert told.kind == "doubtful"
    assert words in told.sentences[0]
    assert told.sentences[0].endswith("so it is no finding until that is settled.")


def test_nothing_and_not_compared(study: MadeStudy) -> None:
    told = prediction_finding(study, found_with(study, pair(link(*PAIR, 0, 0.3))), 0)
    assert told is not None
    assert told.kind == "nothing"
    assert told.sentences[0] == "Rac1 does not predict edge velocity in any layer (all q ≥ 0.3)."
    rows = [one | {"q": float("nan")} for one in pair(link(*PAIR, 0, 0.3))]
    told = prediction_finding(study, found_with(study, rows, surrogates=0), 0)
    assert told is not None
    assert "not compared with chance (--surrogates 0): Rac1 → edge velocity 4.9 % less error" in told.words


def test_a_network_names_its_links(study: MadeStudy) -> None:
    rows = [link("Rac1", "velocity", 0, 0.01), link("RhoA", "velocity", 0, 0.02, geometry=True)]
    rows += [link("RhoA", "Rac1", 0, 0.6), link("Rac1", "RhoA", 0, 0.7)]
    how: Any = {"names": ("", ""), "signals": ["Rac1", "RhoA", "velocity"], "not_given": ""}
    told = prediction_finding(study, found_with(study, rows, **how), 0)
    assert told is not None
    assert told.sentences == (
        "Of 4 links among Rac1, RhoA and edge velocity, 1 holds: Rac1 → edge velocity (layer 0, 4.9 % less "
        "error, q = 0.01; more Rac1 is followed by protrusion).",
        "Not yet to be believed: RhoA → edge velocity (geometry).",
        "Each link was tested with all other signals given; a common driver that was not imaged can do the "
        "same.",
    )


def test_several_cells_are_told_together(study: MadeStudy, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cytodisk.runs.qc_flags.study_flags.run_flags", lambda study: [])
    found = found_with(study, pair(link(*PAIR, 0, 0.01)))
    two = {name: pd.concat([table, table.assign(cell=1)]) for name, table in found.tables.items()}
    both = UnwrittenPrediction(
        study.path, *PAIR, "", found.settings, two | {"pooled": found.pooled, "lags": found.lags}
    )
    told = pooled_finding(study, both)
    assert told is not None
    assert told.words.startswith(
        "Over 2 cells: Rac1 predicts edge velocity in layer 0: 4.9 % less error (q = 0.01); more Rac1 is "
        "followed by protrusion; by itself in 2 of 2 cells. Edge velocity does not predict Rac1 in any layer"
    )
    lines = list(prediction_finding_lines(both, study))
    assert lines[0].startswith("Finding: Over 2 cells")
    assert lines[1].startswith("Finding, cell 0: Rac1 predicts")


def test_over_cells_the_weaker_direction_is_said_and_not_counted(study: MadeStudy) -> None:
    found = found_with(study, pair(link(*PAIR, 0, 0.2)))
    cells = pd.concat([found.cells, found.cells.assign(cell=1)])
    pooled = found.pooled.assign(q=0.01, weaker=True)  # in no cell by itself
    tables = {"links": found.links, "lags": found.lags, "cells": cells, "pooled": pooled}
    told = pooled_finding(study, UnwrittenPrediction(study.path, *PAIR, "", found.settings, tables))
    assert told is not None
    assert told.kind == "nothing"
    assert told.words.count("but it is the weaker of both directions") == 2
    one = UnwrittenPrediction(
        study.path, *PAIR, "", found.settings, tables | {"pooled": pooled.assign(weaker=pooled["layer"] == 1)}
    )
    told = pooled_finding(study, one)
    assert told is not None
    assert told.kind == "found"
    assert "weaker" not in told.words
    assert "edge velocity predicts Rac1 in layer 0" in told.words.replace("Edge", "edge")


def test_lines_by_layer(study: MadeStudy) -> None:
    rows = pair(link(*PAIR, 0, 0.01), link(*PAIR, 1, 0.2), link(*PAIR, 2, 0.5))
    lines = list(prediction_lines(found_with(study, rows), study))
    assert "cell 0, Rac1 → edge velocity, by layer:" in lines
    assert "  layers 1–2: nothing, all q ≥ 0.2" in lines
    assert "cell 0, edge velocity → Rac1: nothing, all q ≥ 0.4" in lines
    assert lines[-1] == f"1 cell tested: {study.path}"


@pytest.mark.parametrize(("q", "words"), [(0.01, "; mostly gone without"), (0.3, "; not without")])
def test_a_layer_says_how_much_is_left_without_geometry(study: MadeStudy, q: float, words: str) -> None:
    rows = pair(link(*PAIR, 0, 0.01, geometry=True, gain_partial=0.001, q_partial=q))
    lines = prediction_lines(found_with(study, rows), study)
    assert any(f"{words} geometry (0.1 %, q = {q:.2g})" in line for line in lines)


def test_words() -> None:
    assert signal_words("velocity") == "edge velocity"
    assert signal_words("edge") == "signal 'edge'"
    assert prediction_name() == "network"
    assert prediction_name(*PAIR, "x") == "Rac1 and velocity (x)"
    assert less_error(0.0) == "0 % less error"
    assert effect_words("velocity", "Rac1", -0.1) == "protrusion is followed by less Rac1"
    assert effect_words("Rac1", "velocity", -0.1) == "more Rac1 is followed by retraction"
    assert effect_words("Rac1", "RhoA", 0.1) == "more Rac1 is followed by more RhoA"
    turned = effect_words("velocity", "Rac1", 0.1, turns=-1)
    assert turned == f"protrusion is followed by less Rac1 {AT_FIRST} more Rac1)"


@pytest.mark.parametrize(
    ("coefficients", "words"),
    [
        ((-0.15, 0.16), f"more Rac1 is followed by retraction {AT_FIRST} protrusion)"),
        ((0.15, -0.08), f"more Rac1 is followed by protrusion {AT_FIRST} retraction)"),
        ((0.15, -0.02), "more Rac1 is followed by protrusion"),
    ],
)
def test_a_sign_that_changes_with_the_lag_is_told(
    study: MadeStudy, coefficients: tuple[float, float], words: str
) -> None:
    lags = pd.DataFrame({"lag": [1, 2], "coefficient": coefficients})
    lags = lags.assign(cell=0, source="Rac1", target="velocity", layer=0)
    lags = lags.assign(low=lags["coefficient"] - 0.01, high=lags["coefficient"] + 0.01)
    found = found_with(study, pair(link(*PAIR, 0, 0.002)), lags=lags)
    told = prediction_finding(study, found, 0)
    assert told is not None
    assert told.sentences[0].endswith(f"; {words}.")
    assert any(f"; {words}; without geometry" in line for line in prediction_lines(found, study))


UNKNOWN = {"gain_partial": float("nan"), "reason": "without geometry: 12 rows are too few"}


@pytest.mark.parametrize(
    ("of_link", "of_cell", "name", "words"),
    [
        ({"geometry": True}, {}, "geometry", "Rac1 → velocity, layer 0: 4.9 % → 4.4 % less error"),
        ({}, {"velocity_jitter": 0.3}, "jitter", "30% of velocity's variance"),
        ({"stress": "heavy tails"}, {}, "heavy tails", "Rac1 → velocity"),
        ({"weaker": True}, {}, "weaker direction", "Rac1 → velocity, layer 0"),
        ({"drifting": 0.6}, {"drifting": 0.6}, "drifting series", "60% of the series of Rac1 and velocity"),
        (
            UNKNOWN,
            {},
            "geometry not tested",
            "Rac1 → velocity, layer 0, without geometry: 12 rows are too few",
        ),
        ({}, {"geometry_not_tested": "no images"}, "geometry not tested", "no images"),
        ({}, {"frames": 30}, "few frames", "30 frames"),
        ({}, {"status": "refused", "reason": "4 frames"}, "not predicted", "4 frames"),
        ({}, {}, "common driver", "RhoA not given"),
    ],
)
def test_flags(
    study: MadeStudy, of_link: dict[str, Any], of_cell: dict[str, Any], name: str, words: str
) -> None:
    found = found_with(study, pair(link(*PAIR, 0, 0.01, **of_link)), **of_cell)
    flags = {flag.name: flag for flag in prediction_flags(study, found)}
    assert words in flags[name].places[0].note
    assert flags.keys() <= {name, "common driver"}


def prediction_flags(study: MadeStudy, found: UnwrittenPrediction) -> list[Any]:
    return prediction_flags_of(with_one_prediction(study, found))


def test_nothing_significant_raises_no_flag_of_links(study: MadeStudy) -> None:
    rows = pair(link(*PAIR, 0, 0.3, stress="common pulse", geometry=False))
    assert prediction_flags(study, found_with(study, rows, velocity_jitter=0.5)) == []
    assert [len(way.judged) for way in directions(found_with(study, rows), 0)] == [0, 0]


def test_the_command_of_a_remedy(study: MadeStudy) -> None:
    found = found_with(study, pair(link(*PAIR, 0, 0.01)), asked={"max_order": 4})
    (flag,) = prediction_flags(study, found)
    assert flag.advice.endswith("--source Rac1 --target velocity --max-order 4 --given RhoA --name given")
