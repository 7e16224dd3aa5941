import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.disk.mapping import map_to_disk


@pytest.mark.parametrize("kind", simulate.KINDS)
@pytest.mark.parametrize("chunk", range(3))
def test_every_random_mask_has_a_valid_map_that_loses_no_pixel(kind: str, chunk: int) -> None:
    for seed in range(1000 + 5 * chunk, 1005 + 5 * chunk):
        disk = map_to_disk(simulate.random_mask(kind, seed))
        certificate = disk.certificate
        assert certificate.valid, (seed, certificate.faults)
        assert certificate.flipped_in_cell == certificate.flipped_in_disk == ()
        pixels = np.argwhere(disk.mask).astype(float)
        uv = disk.to_disk(pixels)
        assert np.isfinite(uv).all(), seed
        np.testing.assert_allclose(disk.to_cell(uv), pixels, atol=1e-6, err_msg=str(seed))
        assert np.isfinite(disk.distortion.area)


@pytest.mark.parametrize("edge_length", [0.25, 10.0])
@pytest.mark.parametrize("kind", ["spiky", "comb", "single", "percolation"])
def test_the_finest_and_the_coarsest_mesh_give_valid_maps(kind: str, edge_length: float) -> None:
    disk = map_to_disk(simulate.random_mask(kind, 21), edge_length=edge_length)
    assert disk.certificate.valid
    assert np.isfinite(disk.to_disk(np.argwhere(disk.mask))).all()
