import numpy as np
import pytest
from scipy import ndimage

from cytodisk import simulate
from cytodisk.geometry.depth import depth_of


@pytest.mark.parametrize("kind", simulate.KINDS)
def test_depth_is_the_distance_to_the_nearest_pixel_outside(kind: str) -> None:
    for seed in range(3):
        mask = np.pad(simulate.random_mask(kind, seed), 1)
        np.testing.assert_array_equal(depth_of(mask), ndimage.distance_transform_edt(mask))


def test_depth_of_any_pattern() -> None:
    random = np.random.default_rng(0)
    for share in (0.05, 0.5, 0.95, 0.999):
        mask = np.pad(random.random((40, 63)) < share, 1)
        np.testing.assert_array_equal(depth_of(mask), ndimage.distance_transform_edt(mask))
