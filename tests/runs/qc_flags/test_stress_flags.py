"""QC flags of stress, against tables with that mark alone."""

from pathlib import Path

import pandas as pd
import pytest

from cytodisk.runs.correlate.correlation_columns import CORRELATION_TABLES
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.runs.qc_flags.stress_flags import STRESS_RULES
from cytodisk.store.correlation_store import write_correlation
from cytodisk.store.study import Study

NUMBERS: dict[str, object] = {
    "frames": 300,
    "pulse_share": 0.62,
    "pulse_frames": "17,18,19",
    "episode_ratio": 4.0,
    "episode_frames": "20:39",
    "variance_ratio": 0.4,
    "line_share": 0.5,
    "line_period": 10.0,
    "kurtosis": 7.5,
}


def flags(folder: Path, stress: str | None, statistic: str = "pearson") -> list[QCFlag]:
    """Flags of a study with a good cell and one with marks."""
    cells = pd.DataFrame({"cell": [0, 1], "status": "ok", "reason": "", "statistic": statistic} | NUMBERS)
    if stress is not None:
        cells["stress"] = ["", stress]
    write_correlation(folder, "VASP", "velocity", {"cells": cells}, CORRELATION_TABLES, {})
    study = Study(folder, pd.DataFrame(), {"run": "movie"})
    return [flag for rule in STRESS_RULES for flag in rule(study)]


@pytest.mark.parametrize(
    ("name", "note", "remedy"),
    [
        ("common pulse", "frames 17, 18, 19 hold 62% of the joint energy", "--without-frames 17,18,19"),
        ("restless episode", "frames 20–39 vary 4.0 times as much", "--statistic spearman"),
        (
            "variance change",
            "variance of the second half 0.4 times that of the first",
            "--statistic spearman",
        ),
        ("steady oscillation", "50% of the variance at a period of 10 frames", "--max-lag 6"),
        ("heavy tails", "kurtosis 7.5 (normal: 3)", "--statistic spearman"),
    ],
)
def test_each_mark_has_its_flag(tmp_path: Path, name: str, note: str, remedy: str) -> None:
    (flag,) = flags(tmp_path, name)
    assert flag.name == name
    assert [(place.cell, place.note) for place in flag.places] == [(1, f"VASP with velocity: {note}")]
    assert remedy in flag.advice
    assert "not that nothing is there" in flag.meaning
    ranks = flags(tmp_path / "ranks", name, "spearman")
    assert bool(ranks) == (name == "steady oscillation")


def test_a_short_movie_of_oscillators_has_too_few_shifts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(NUMBERS, "frames", 60)
    (flag,) = flags(tmp_path, "steady oscillation")
    assert "longer movie" in flag.advice
    assert "--max-lag" not in flag.advice


def test_several_marks_and_none(tmp_path: Path) -> None:
    found = flags(tmp_path / "two", "common pulse, steady oscillation")
    assert [flag.name for flag in found] == ["common pulse", "steady oscillation"]
    assert flags(tmp_path / "none", "") == []
    assert flags(tmp_path / "older", None) == []
