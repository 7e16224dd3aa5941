"""Waves in words: the numbers first, which way on the picture, and what speaks against them."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from wave_studies import SeriesStudy, series_study

import cytodisk as cd
from cytodisk.runs.findings.finding import Finding
from cytodisk.runs.findings.wave_words import waves_around
from cytodisk.runs.findings.waves_finding import waves_finding, waves_summary
from cytodisk.runs.qc_flags.one_of_waves import with_waves
from cytodisk.runs.qc_flags.study_flags import wave_flags_of
from cytodisk.runs.qc_flags.wave_doubts import HIDING
from cytodisk.runs.told.wave_lines import wave_finding_lines, wave_lines
from cytodisk.store.waves.waves_store import Waves

USUAL: dict[str, Any] = {
    "status": "ok",
    "reason": "",
    "qc_flags": "",
    "layer": None,
    "kind": "rotating",
    "way": "clockwise",
    "mode": 2,
    "period": 19.0,
    "period_s": 95.0,
    "shortest_period": 8.0,
    "longest_period": 60.0,
    "speed": 1 / 190,
    "edge_speed": 0.12,
    "direction": 0.9,
    "persistence_s": 200.0,
    "order": 4.0,
    "p": 0.002,
    "q": 0.002,
    "p_partial": np.nan,
    "frames": 58,
    "periods": 3.0,
    "drifting": 0.0,
    "jitter": 0.0,
    "restarts": 0,
    "geometry_not_tested": "",
    "inside": "",
    "p_inside_partial": np.nan,
}


class MadeWaves(Waves):
    """Waves whose table of cells is in memory."""

    def _table(self, name: str) -> Any:
        return self.settings[name]


def made(*rows: dict[str, Any], signal: str = "velocity") -> Waves:
    cells = pd.DataFrame([{"cell": cell} | USUAL | row for cell, row in enumerate(rows)])
    settings = {"cells": cells, "layers": cells, "surrogates_made": 499}
    return MadeWaves(Path("out/waves"), signal, "", settings)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> SeriesStudy:
    values = cd.simulate.wave_series("none", 0, 20, 8)
    return series_study(tmp_path_factory.mktemp("words"), [values])


def told(study: SeriesStudy, waves: Waves, *flagged: str) -> Finding:
    found = waves_finding(study, waves, 0, flagged)
    assert found is not None
    return found


def test_the_finding_with_its_numbers_comes_first(study: SeriesStudy) -> None:
    found = told(study, made({}))
    assert found.kind == "found"
    assert found.sentences[0] == (
        "Waves run along the edge of cell 0: 2 waves around the cell, 0.12 µm/s clockwise as seen in the "
        "image (towards higher sectors), period 95 s, p = 0.002."
    )
    assert "one crest is once around the cell after 190 s" in found.sentences[1]
    other = told(study, made({"way": "anticlockwise", "edge_speed": -0.12, "direction": -0.9}))
    assert "0.12 µm/s anticlockwise as seen in the image (towards lower sectors)" in other.words


def test_other_kinds_have_no_way(study: SeriesStudy) -> None:
    standing = told(study, made({"kind": "standing", "way": "", "mode": 1})).words
    assert standing.startswith(
        "A standing wave moves the edge of cell 0 out and in: 1 wave around the cell, period"
    )
    whole = told(study, made({"kind": "oscillating", "way": "", "mode": 0})).words
    assert whole.startswith("The whole edge of cell 0 moves out and in at once: period 95 s, p = 0.002.")
    assert "clockwise" not in standing + whole


SPIRAL: dict[str, Any] = {
    "layer": 1,
    "inside": "spiral",
    "inside_way": "clockwise",
    "inside_mode": 2,
    "inside_period": 19.0,
    "inward_speed": 0.05,
    "p_inside": 0.01,
    "inside_order": 5.0,
}


def test_a_signal_has_its_layer_and_what_it_does_inside(study: SeriesStudy) -> None:
    words = told(study, made(SPIRAL, signal="Rac1")).words
    assert words.startswith("Waves of Rac1 run around in layer 1 of cell 0: 2 waves")
    assert "Through all layers crests run as a spiral, clockwise and inwards at 50 nm/s (p = 0.01)." in words
    out = SPIRAL | {"inside": "outwards", "inward_speed": -0.05}
    assert "crests run outwards at 50 nm/s" in told(study, made(out, signal="Rac1")).words
    around = SPIRAL | {"inside": "around", "inward_speed": np.nan}
    assert "All layers take part: crests run around" in told(study, made(around, signal="Rac1")).words
    assert "layers" not in told(study, made(SPIRAL | {"inside": "none"}, signal="Rac1")).words


def test_a_wave_that_only_all_layers_show_is_no_nothing(study: SeriesStudy) -> None:
    row = SPIRAL | {"kind": "none", "way": "", "p": 0.2, "p_inside_partial": 0.01}
    found = told(study, made(row, signal="Rac1"))
    assert found.kind == "found"
    assert found.words.startswith(
        "Waves of Rac1 run through all layers of cell 0: 2 waves around the cell, period 95 s, p = 0.01."
    )
    assert "By itself layer 1 shows none beyond chance (p = 0.2)." in found.words
    gone = made(row | {"p_inside_partial": 0.5}, signal="Rac1")
    assert told(study, gone).kind == "doubtful"
    (flag,) = wave_flags_of(with_waves(study, gone))
    assert flag.name == "waves of the cell's motion"
    assert flag.places[0].note == "Rac1: all layers: p = 0.01, without the cell's motion 0.5"


@pytest.mark.parametrize(
    ("row", "flag", "words"),
    [
        ({"period": 55.0}, "few periods", "the movie holds only 3 periods"),
        ({"period": 8.5}, "few frames a period", "a period has only 8.5 frames"),
        ({"p_partial": 0.3}, "waves of the cell's motion", "the motion of the cell alone gives (p = 0.3)"),
        ({"drifting": 0.5, "period": 40.0}, "drifting waves", "the level of many series drifts"),
        ({"restarts": 2}, "waves over restarts", "tracking started anew"),
        ({"geometry_not_tested": "gone"}, "cell's motion not tested", "was not tested"),
    ],
)
def test_what_speaks_against_a_wave(study: SeriesStudy, row: dict[str, Any], flag: str, words: str) -> None:
    waves = made(row)
    found = told(study, waves)
    assert found.kind == "doubtful"
    assert words in found.sentences[0].partition(", but ")[2]
    flags = wave_flags_of(with_waves(study, waves))
    assert [one.name for one in flags] == [flag]
    assert flags[0].places[0].cell == 0
    assert flags[0].advice.endswith(".")


def test_nothing_is_no_proof(study: SeriesStudy) -> None:
    waves = made({"kind": "none", "way": "", "p": 0.3, "jitter": 0.5})
    found = told(study, waves, "area jumps")
    assert found.kind == "nothing"
    assert found.words.startswith(
        "No waves beyond chance in the edge velocity of cell 0: what is most like one is 2 waves around the "
        "cell, period 95 s (p = 0.3)."
    )
    assert found.words.endswith("QC flags are raised that may hide some: area jumps.")
    assert [one.name for one in wave_flags_of(with_waves(study, waves))] == [HIDING]


def test_flags_of_the_run_are_told(study: SeriesStudy) -> None:
    found = told(study, made({}), "area jumps")
    assert found.kind == "doubtful"
    assert ", but QC flags are raised that bear on it: area jumps." in found.sentences[0]


def test_what_is_wrong_with_a_signal_says_nothing_of_the_edge(study: SeriesStudy) -> None:
    assert told(study, made({}), "saturated signal").kind == "found"
    assert told(study, made({"layer": 0}, signal="Rac1"), "saturated signal").kind == "doubtful"


def test_several_cells_are_summed_up(study: SeriesStudy, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cytodisk.runs.qc_flags.study_flags.run_flags", lambda _: [])
    none = {"kind": "none", "way": ""}
    other = {"way": "anticlockwise", "direction": -0.6, "edge_speed": -0.2, "period": 21.0}
    waves = made(
        {}, none, other, {"kind": "standing", "way": ""}, {"status": "refused", "reason": "too short"}
    )
    assert waves_summary(study, waves) == (
        "Edge velocity: waves in 3 of 4 cells (1 clockwise, 1 anticlockwise, 1 standing); in the median "
        "period 95 s and 0.16 µm/s."
    )
    assert told(study, waves).sentences[-1] == (
        "Waves in 3 of 4 cells (1 clockwise, 1 anticlockwise and 1 standing)."
    )
    lines = list(wave_finding_lines(waves, study))
    assert lines[0].startswith("Edge velocity: waves in 3 of 4 cells")
    assert lines[-1] == "… and those of 1 more cell: they stand in the report"
    assert "cell 4 left out: too short" in list(wave_lines(waves, study))
    assert waves_finding(study, waves, 4) is None
    assert [one.name for one in wave_flags_of(with_waves(study, waves))] == ["no waves looked for"]


def test_layers_are_listed(study: SeriesStudy) -> None:
    rows = made({"layer": 0}, signal="Rac1")
    lines = list(wave_lines(rows, study))
    assert lines[0] == "cell 0, by layer:"
    assert lines[1].startswith(
        "  layer 0 (outermost): rotating, 2 waves around the cell, 0.12 µm/s clockwise"
    )
    assert "in doubt" not in lines[1]


def test_what_speaks_against_a_layer_is_listed(study: SeriesStudy) -> None:
    weak = {"layer": 0, "q": 0.13, "p_partial": 0.11, "period": 60.0, "longest_period": 60.0}
    line = list(wave_lines(made(weak, signal="Rac1"), study))[1]
    assert line.endswith(
        "q = 0.13; in doubt: one of many layers (q), few periods, "
        "waves of the cell's motion (p = 0.11 without it)"
    )
    assert waves_around(0) == "all around at once"
