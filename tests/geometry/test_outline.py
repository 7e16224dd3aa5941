import numpy as np
import pytest
from shapely import contains_xy
from shapely.geometry import Polygon
from skimage.measure import find_contours

from cytodisk import simulate
from cytodisk.errors import MaskError
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.outline import has_one_outline, trace_outline


def test_one_pixel_has_a_diamond_of_half_a_pixel() -> None:
    outline = trace_outline(np.array([[True]]))
    assert sorted(map(tuple, outline.tolist())) == [(-0.5, 0.0), (0.0, -0.5), (0.0, 0.5), (0.5, 0.0)]


def test_a_rectangle_is_cut_at_its_corners_only() -> None:
    mask = np.pad(np.ones((6, 9), dtype=bool), 3)
    assert Polygon(trace_outline(mask)).area == pytest.approx(6 * 9 - 4 * 0.125)


def test_the_outline_runs_from_x_towards_y() -> None:
    y, x = trace_outline(simulate.disk(20.0)).T
    turning = np.unwrap(np.arctan2(y - 28.0, x - 28.0))
    assert turning[-1] - turning[0] > 6.0


@pytest.mark.parametrize("kind", simulate.KINDS)
def test_the_outline_is_simple_and_holds_every_pixel_centre_and_no_other(kind: str) -> None:
    for seed in range(6):
        mask, _ = clean_mask(simulate.random_mask(kind, seed))
        polygon = Polygon(trace_outline(mask)[:, ::-1])
        assert polygon.is_valid
        assert polygon.exterior.is_ccw  # in (x, y) as numbers, which is +x towards +y
        row, column = np.indices(mask.shape)
        np.testing.assert_array_equal(contains_xy(polygon, column, row), mask)
        # An outline cuts at most half a pixel off every pixel.
        assert 0.5 * mask.sum() <= polygon.area <= 1.5 * mask.sum()


def test_a_mask_with_a_hole_or_in_pieces_is_refused() -> None:
    with pytest.raises(MaskError, match=r"2 outlines.*clean_mask"):
        trace_outline(np.array([[True, False, True]]))
    with pytest.raises(MaskError, match="0 outlines"):
        trace_outline(np.zeros((3, 3), dtype=bool))


@pytest.mark.parametrize("seed", range(40))
def test_the_outline_is_the_iso_line_of_scikit_image(seed: int) -> None:
    random = np.random.default_rng(seed)
    height, width = random.integers(1, 40, 2)
    raw = random.random((height, width)) < random.uniform(0.3, 0.9)
    raw[0, 0] = True
    mask, _ = clean_mask(raw)
    (line,) = find_contours(np.pad(mask, 1).astype(float), 0.5, fully_connected="high")
    np.testing.assert_array_equal(trace_outline(mask), line[:-1] - 1.0)


@pytest.mark.parametrize("seed", range(40))
def test_a_mask_has_one_outline_if_it_is_one_piece_without_holes(seed: int) -> None:
    random = np.random.default_rng(seed)
    mask = random.random((4, 5)) < 0.7
    mask[0, 0] = True
    _, report = clean_mask(mask)
    assert has_one_outline(mask) == (report.components == 1 and report.holes == 0)
