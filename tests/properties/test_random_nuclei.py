import numpy as np
import pytest

from cytodisk.disk.mapping import map_to_disk
from cytodisk.simulate import random_pair

PAIRS, CHUNK = 500, 20
FIRST = 100_000  # seeds that the benchmark does not take
FAST = 120
CHUNKS = [
    pytest.param(first, marks=[pytest.mark.slow] if first >= FIRST + FAST else [])
    for first in range(FIRST, FIRST + PAIRS, CHUNK)
]


@pytest.mark.parametrize("first", CHUNKS)
def test_every_random_pair_has_a_valid_map_that_keeps_its_compartments(first: int) -> None:
    for seed in range(first, first + CHUNK):
        mask, nucleus = random_pair(seed)
        disk = map_to_disk(mask, nucleus=nucleus, nucleus_radius="area" if seed % 4 == 0 else 0.5)
        certificate = disk.certificate
        assert certificate.valid, (seed, certificate.faults)
        assert certificate.flipped_in_cell == certificate.flipped_in_disk == ()
        pixels = np.argwhere(disk.mask)
        uv = disk.to_disk(pixels)
        assert np.isfinite(uv).all(), seed
        np.testing.assert_allclose(disk.to_cell(uv), pixels, atol=1e-6, err_msg=str(seed))
        assert disk.nucleus is not None
        inside = np.hypot(*uv.T) <= disk.nucleus.radius
        np.testing.assert_array_equal(inside, nucleus[tuple(pixels.T)], err_msg=str(seed))


@pytest.mark.parametrize("seed", [173, 716, 784, 863, 2674])
def test_pairs_that_were_refused_warned_or_did_not_converge_once(seed: int) -> None:
    mask, nucleus = random_pair(seed)
    disk = map_to_disk(mask, nucleus=nucleus)
    assert disk.certificate.valid
    assert disk.converged
