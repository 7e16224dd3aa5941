"""QC flags of correlations, against tables with that fault alone."""

from pathlib import Path

import pandas as pd
import pytest

from cytodisk.runs.correlate.correlation_columns import CORRELATION_TABLES
from cytodisk.runs.qc_flags import correlation_flags
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.store.correlation_store import write_correlation
from cytodisk.store.study import Study

RULES = (correlation_flags.jitter, correlation_flags.drifting_series, correlation_flags.left_out)


def flags(folder: Path, **faults: object) -> list[QCFlag]:
    """Flags of a study with two cells, of which the second has the faults."""
    cells = pd.DataFrame({"cell": [0, 1], "status": "ok", "reason": "", "jitter": 0.0})
    cells = cells.assign(drifting_signal=0.05, drifting_with=0.0)
    for name, value in faults.items():
        cells.loc[1, name] = value
    write_correlation(folder, "VASP", "velocity", {"cells": cells}, CORRELATION_TABLES, {})
    study = Study(folder, pd.DataFrame(), {"run": "movie"})
    return [flag for rule in RULES for flag in rule(study)]


def test_a_good_correlation_has_none(tmp_path: Path) -> None:
    assert flags(tmp_path) == []
    assert flags(tmp_path, jitter=float("nan")) == []  # too few lags to see any


@pytest.mark.parametrize(
    ("faults", "name", "note"),
    [
        ({"jitter": -0.12}, "jitter", "VASP with velocity: −0.12 at lag 0"),
        (
            {"jitter": 0.05, "velocity_jitter": 0.25},
            "jitter",
            "VASP with velocity: +0.05 at lag 0, 25% of velocity's variance",
        ),
        ({"drifting_signal": 0.6}, "drifting series", "VASP with velocity: 60% of the series"),
        ({"drifting_with": 0.3}, "drifting series", "VASP with velocity: 30% of the series"),
        ({"status": "refused", "reason": "too short"}, "not correlated", "VASP with velocity: too short"),
    ],
)
def test_each_fault_has_its_flag(tmp_path: Path, faults: dict[str, object], name: str, note: str) -> None:
    (flag,) = flags(tmp_path, **faults)
    assert flag.name == name
    assert [(place.cell, place.frame, place.note) for place in flag.places] == [(1, None, note)]
    assert flag.meaning
    assert flag.advice


@pytest.mark.parametrize(("difference", "lags"), [(False, "=-1,0"), (True, "=-2,-1,0,1")])
def test_lags_that_jitter_makes_are_named(tmp_path: Path, difference: bool, lags: str) -> None:
    cells = pd.DataFrame({"cell": [0], "status": "ok", "reason": "", "jitter": 0.2})
    write_correlation(
        tmp_path, "VASP", "velocity", {"cells": cells}, CORRELATION_TABLES, {"difference": difference}
    )
    (flag,) = correlation_flags.jitter(Study(tmp_path, pd.DataFrame(), {"run": "movie"}))
    assert flag.advice.endswith(f"--skip-lags{lags} --name without_jitter")


def test_a_variant_is_told_by_its_name(tmp_path: Path) -> None:
    cells = pd.DataFrame({"cell": [0], "status": "refused", "reason": "too short"})
    write_correlation(tmp_path, "0", "velocity", {"cells": cells}, CORRELATION_TABLES, {}, "early")
    study = Study(tmp_path, pd.DataFrame(), {"run": "movie"})
    (flag,) = correlation_flags.left_out(study)
    assert [place.note for place in flag.places] == ["channel 0 with velocity (early): too short"]


def test_a_study_without_correlations_has_none(tmp_path: Path) -> None:
    study = Study(tmp_path, pd.DataFrame(), {"run": "movie"})
    assert [flag for rule in RULES for flag in rule(study)] == []
