"""The commands that calibrate `predict`: cases are what their names say, tables say what was missed."""

import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def calibration() -> Iterator[Any]:
    sys.path.insert(0, str(BENCHMARKS))
    try:
        yield import_module("prediction_calibration")
    finally:
        sys.path.remove(str(BENCHMARKS))


def test_a_missed_target_is_said(calibration: Any, capsys: pytest.CaptureFixture[str]) -> None:
    values = [{"p": p, "gain": 0.1} for p in (0.01, 0.5, 0.5, 0.5)]
    trials = [calibration.Trial("null", "white", seed, one) for seed, one in enumerate(values)]
    assert not calibration.print_block("null", trials)
    assert "| white | 4 | 0.250 NO |" in capsys.readouterr().out
    assert calibration.print_block("given", [])


def test_cases_with_words_are_those_of_the_block(calibration: Any) -> None:
    waves = ["waves", "waves, neighbours alike", "waves source, ar1 target"]
    assert list(calibration.cases_of("null", "waves")) == waves
    assert len(calibration.cases_of("ways")) == len(calibration.WAY_CASES)


@pytest.mark.slow
def test_a_pair_is_measured_in_both_directions_and_by_each_way(calibration: Any) -> None:
    made = calibration.measure(("one way", "ar1, r = 0.5", 0))
    assert made.values["p"] == 0.01 < made.values["p_back"]
    assert made.values["gain"] > 50 * made.values["gain_back"]
    ways = calibration.measure(("ways", "nothing: white", 0)).values
    assert set(ways) == set(calibration.WAYS)
    assert all(0.0 < p <= 1.0 for p in ways.values())
    assert np.isfinite(calibration.measure(("direction", "both ways, 0.3 there and 0.1 back", 0)).values["p"])


def test_signals_of_a_seed_are_the_same_again(calibration: Any) -> None:
    make = calibration.BLOCKS["null"]["white, 8 sectors"]
    assert make(3).source.shape == (150, 8)
    np.testing.assert_array_equal(make(3).target, make(3).target)
    assert not np.array_equal(make(3).target, make(4).target)
