"""The benchmark of rings between nucleus and edge: the rows it prints."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cytodisk as cd

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def load() -> Iterator[Any]:
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        yield __import__
    finally:
        sys.path.remove(str(ROOT / "benchmarks"))


def test_a_row_a_method_says_what_folds(load: Any, capsys: pytest.CaptureFixture[str]) -> None:
    """A disk and a cell with spikes: only in the second, and only interpolated rings fold."""
    benchmark, case = load("nucleus_rings"), load("schwann_nuclei").Case
    spiky = cd.simulate.cell_with_nucleus(shape="spiky", seed=1, radius_px=25)
    cases = [
        case("simulated", "disk", cd.simulate.disk(20), cd.simulate.disk(9, margin=19), (0, 0)),
        case("simulated", "spiky", spiky.mask, spiky.nucleus, (0, 0)),
        case("simulated", "without nucleus", spiky.mask, np.zeros_like(spiky.mask), (0, 0)),
    ]
    found = [one for cell in cases for one in benchmark.measure(cell, benchmark.Counts(4, 12, 2))]
    folded = {one.method for one in found if one.cell == "spiky" and one.flipped}
    assert "interpolated" in folded
    assert not {"cytodisk", "by distance"} & folded
    assert not any(one.flipped for one in found if one.cell == "disk")
    benchmark.print_table(found)
    first, heads, *rows = capsys.readouterr().out.splitlines()
    assert first == "2 cells of simulated"
    assert "outer fifth" in heads
    assert len(rows) == len(benchmark.METHODS)
    assert rows[-1].split()[:2] == ["cytodisk", "0"]
