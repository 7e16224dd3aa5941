"""The commands that print figures of waves: their functions do what they say."""

import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def load() -> Iterator[Any]:
    sys.path.insert(0, str(BENCHMARKS))
    try:
        yield import_module
    finally:
        sys.path.remove(str(BENCHMARKS))


@pytest.mark.slow
def test_speeds_are_measured(load: Any) -> None:
    case = load("waves_cases").WaveCase("running", 0.5, 1, 12, 10.0, 3.0, 0.3, -1, "unequal", 5)
    values, lengths, speed = case.series()
    assert values.shape == lengths.shape == (30, 12)
    assert speed == -0.5
    assert load("waves_speed").measured(case, 19)[:3] == (True, True, True)


@pytest.mark.slow
def test_rates_and_lengths_are_lines(load: Any) -> None:
    null = load("waves_null")
    found = null.tested("AR", 24, 6, 2, 19)
    assert found.shape == (2, 2)
    assert null.rate_line("AR", 24, np.r_[np.full(950, 0.5), np.full(50, 0.01)])[1]
    assert not null.rate_line("AR", 24, np.r_[np.full(850, 0.5), np.full(150, 0.01)])[1]
    assert not null.length_line("AR", np.zeros(50), np.ones(50))[1]


def test_areas_and_lengths_of_places(load: Any) -> None:
    patterns = load("waves_patterns")
    assert patterns.area(np.array([2.0, 3.0]), np.array([1.0, 2.5])) == 0.75
    square = np.array([[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]])
    assert patterns.place_lengths(square).tolist() == [[1.0] * 4]
