"""The benchmark of rings between nucleus and edge: what it draws, and the rows it prints."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import cytodisk as cd

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def load() -> Iterator[Any]:
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        yield __import__
    finally:
        sys.path.remove(str(ROOT / "benchmarks"))


def test_a_drawn_nucleus_is_round_and_lies_at_the_deepest_place(load: Any) -> None:
    mask = np.zeros((60, 90), dtype=bool)
    mask[10:50, 5:45] = mask[25:35, 40:85] = True
    nucleus = load("drawn_nuclei").drawn_nucleus(mask)
    assert nucleus.sum() == pytest.approx(np.pi * 10**2, rel=0.05)
    assert np.argwhere(nucleus).mean(axis=0) == pytest.approx([29.5, 24.5], abs=0.6)


def test_a_row_a_method_says_what_folds(
    load: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A disk and a cell with spikes: only in the second, and only interpolated rings fold."""
    spiky = cd.simulate.cell_with_nucleus(shape="spiky", seed=1, radius_px=25).mask
    stack = np.zeros((2, *np.maximum(spiky.shape, 60)), dtype=np.uint8)
    stack[0, :57, :57], stack[1, : spiky.shape[0], : spiky.shape[1]] = cd.simulate.disk(20), spiky
    tifffile.imwrite(tmp_path / "masks.tif", stack, metadata={"axes": "TYX"})
    benchmark = load("nucleus_rings")
    cells = list(load("drawn_nuclei").cells_with_drawn_nuclei(tmp_path / "masks.tif"))
    found = [one for cell in cells for one in benchmark.measure(cell, benchmark.Counts(4, 12, 2))]
    folded = {one.method: one.flipped for one in found if one.cell == 1 and one.flipped}
    assert "interpolated" in folded
    assert not {"cytodisk", "by distance"} & set(folded)
    assert not any(one.flipped for one in found if one.cell == 0)
    benchmark.print_table(found)
    first, heads, *rows = capsys.readouterr().out.splitlines()
    assert first == "2 cells with a drawn nucleus"
    assert "outer fifth" in heads
    assert len(rows) == len(benchmark.METHODS)
    ours = rows[-1].split()
    assert ours[:2] == ["cytodisk", "0"]
