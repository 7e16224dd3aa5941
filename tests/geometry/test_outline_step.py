"""Steps of outlines: masks as drawn, masks scaled up, and masks that are angular by nature."""

import numpy as np
import pytest
from scipy import ndimage
from skimage.draw import polygon

import cytodisk as cd
from cytodisk.arrays import BoolArray
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.outline_step import outline_step, straight_runs


def step_of(mask: BoolArray) -> int:
    return outline_step(trace_outline(cd.clean_mask(mask)[0]))


@pytest.mark.parametrize("seed", range(1000, 1010))
@pytest.mark.parametrize("scale", [2, 3, 4, 6, 8])
def test_scaled_up(scale: int, seed: int) -> None:
    small = cd.simulate.random_smooth(seed, radius=60 // scale)
    large = np.kron(small, np.ones((scale, scale))) > 0
    assert step_of(large) == scale
    assert step_of(large[scale // 2 :, 1:]) == scale  # whatever the crop
    assert step_of(small) == 1


@pytest.mark.parametrize("scale", [3.7, 5.5])
def test_scaled_up_by_a_broken_number(scale: float) -> None:
    small = cd.simulate.random_smooth(1000, radius=14)
    large = ndimage.zoom(small, scale, order=0, grid_mode=True, mode="nearest")
    assert step_of(large) == int(scale)


@pytest.mark.parametrize("kind", cd.simulate.KINDS)
def test_masks_as_drawn(kind: str) -> None:
    for seed in range(1000, 1006):
        assert step_of(cd.simulate.random_mask(kind, seed)) == 1


def test_straight_edges_are_no_steps() -> None:
    cross = np.zeros((90, 90), dtype=bool)
    cross[30:60, 5:85] = cross[5:85, 30:60] = True
    comb = np.zeros((60, 260), dtype=bool)
    comb[40:55, 5:255] = True
    for tooth in range(10, 250, 20):
        comb[10:40, tooth : tooth + 10] = True
    kite = np.zeros((100, 100), dtype=bool)
    kite[polygon(np.array([5, 90, 60, 20]), np.array([10, 40, 95, 70]))] = True  # type: ignore[no-untyped-call,unused-ignore]
    assert [step_of(mask) for mask in (cross, comb, kite)] == [1, 1, 1]


def test_runs_of_a_plus() -> None:
    plus = np.zeros((5, 5), dtype=bool)
    plus[2, 1:4] = plus[1:4, 2] = True
    lengths, levels = straight_runs(trace_outline(plus))
    assert lengths.tolist() == [1.0] * 12
    assert sorted(set(levels)) == [0.5, 1.5, 2.5, 3.5]
