from pathlib import Path

import numpy as np
import pytest
import tifffile
from scipy import ndimage

from cytodisk import simulate
from cytodisk.disk.circle import boundary_angles
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.outline import trace_outline


def worst_turn(mask: np.ndarray, other: np.ndarray) -> float:
    """Largest change of angle of an outline point that both masks have, in degrees."""
    one, two = (trace_outline(each) for each in (mask, other))
    after = dict(zip(map(tuple, two.tolist()), boundary_angles(two), strict=True))
    change = [
        after[point] - angle
        for point, angle in zip(map(tuple, one.tolist()), boundary_angles(one), strict=True)
        if point in after
    ]
    return float(np.degrees(np.abs(np.angle(np.exp(1j * np.array(change)))).max()))


def one_pixel_more_or_less(mask: np.ndarray, random: np.random.Generator) -> np.ndarray:
    grown, shrunk = ndimage.binary_dilation(mask) & ~mask, mask & ~ndimage.binary_erosion(mask)
    while True:
        candidates = np.argwhere(grown if random.random() < 0.5 else shrunk)
        changed = mask.copy()
        changed[tuple(candidates[random.integers(len(candidates))])] ^= True
        _, report = clean_mask(changed)
        if (report.components, report.holes) == (1, 0):
            return changed


@pytest.mark.parametrize(
    "mask",
    [simulate.disk(30.0), simulate.migrating(0), simulate.star(), simulate.dumbbell(), simulate.branching(3)],
    ids=["disk", "migrating", "star", "dumbbell", "branching"],
)
def test_a_pixel_at_the_edge_turns_the_disk_by_less_than_two_degrees(mask: np.ndarray) -> None:
    mask, _ = clean_mask(mask)
    random = np.random.default_rng(0)
    assert max(worst_turn(mask, one_pixel_more_or_less(mask, random)) for _ in range(15)) < 2.0


@pytest.mark.parametrize("name", ["example", "neuron", "star5"])
def test_a_pixel_at_the_edge_of_a_reference_mask(data_dir: Path, name: str) -> None:
    mask, _ = clean_mask(tifffile.imread(data_dir / "reference_masks" / f"{name}.tif"))
    random = np.random.default_rng(1)
    assert max(worst_turn(mask, one_pixel_more_or_less(mask, random)) for _ in range(10)) < 2.0
