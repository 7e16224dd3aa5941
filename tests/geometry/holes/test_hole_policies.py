import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import ndimage

from cytodisk.errors import MaskError
from cytodisk.geometry.mask import FilledMask, clean_mask


def square_with_holes() -> np.ndarray:
    """20 × 20 pixels with holes of 6 and 9 pixels; in the second lies a pixel that is no part of the cell."""
    mask = np.zeros((24, 30), dtype=bool)
    mask[2:22, 5:25] = True
    mask[5:7, 8:11] = False
    mask[12:15, 12:15] = False
    mask[13, 13] = True
    return mask


def test_excluded_holes_stay_holes_and_are_counted_apart() -> None:
    mask = square_with_holes()
    cleaned, report = clean_mask(mask, holes="exclude")
    expected = mask.copy()
    expected[13, 13] = False  # a piece that touches nothing of the cell
    np.testing.assert_array_equal(cleaned, expected)
    assert (report.area_px, report.holes, report.filled_px, report.excluded_px) == (385, 2, 0, 15)
    assert report.outline_px == 400
    assert report.excluded_share == 15 / 400
    assert report.notes[-1] == "2 holes excluded (15 px, 3.8%)"
    assert not any("hole" in flag for flag in report.qc_flags)


def test_the_default_fills_them_as_ever() -> None:
    mask = square_with_holes()
    filled, report = clean_mask(mask)
    assert (report.area_px, report.holes, report.filled_px, report.excluded_px) == (400, 2, 15, 0)
    np.testing.assert_array_equal(filled, clean_mask(mask, holes="fill")[0])


def test_a_mask_without_holes_is_the_same_under_each_policy() -> None:
    mask = np.ones((5, 6), dtype=bool)
    reports = [clean_mask(mask, holes=policy)[1] for policy in ("fill", "exclude", "error")]
    assert reports[0] == reports[1] == reports[2]


def test_large_excluded_holes_are_flagged_with_their_share() -> None:
    mask = np.ones((10, 10), dtype=bool)
    mask[3:7, 3:7] = False
    flags = clean_mask(mask, holes="exclude")[1].qc_flags
    assert any(flag.startswith("holes take 16% of the area within the outline") for flag in flags)


def test_error_says_both_other_policies() -> None:
    with pytest.raises(MaskError, match=r"2 holes \(15 px\).*holes='fill'.*--holes exclude"):
        clean_mask(square_with_holes(), holes="error")


def test_a_nucleus_in_a_hole_counts_as_cell() -> None:
    mask = square_with_holes()
    nucleus = np.zeros_like(mask)
    nucleus[12:15, 12:14] = True  # six of the nine pixels of the second hole
    found = FilledMask.of(mask).under("exclude", nucleus)
    assert found.holes is not None
    assert found.holes.sum() == 9
    assert not (found.holes & nucleus).any()
    report = found.report
    assert (report.area_px, report.filled_px, report.excluded_px, report.nucleus_in_holes_px) == (
        391,
        6,
        9,
        6,
    )
    assert report.notes[-2:] == (
        "the nucleus lies in a hole of the mask (6 px)",
        "9 px of holes excluded (2.2%)",
    )


def test_a_hole_that_is_all_nucleus_is_no_hole() -> None:
    mask = np.ones((12, 12), dtype=bool)
    mask[4:8, 4:8] = False
    nucleus = ~mask
    for policy in ("fill", "exclude", "error"):
        found = FilledMask.of(mask).under(policy, nucleus)
        assert found.holes is None
        assert (found.report.area_px, found.report.excluded_px) == (144, 0)
        assert found.report.nucleus_in_holes_px == 16
        assert not found.report.qc_flags or "hole" not in " ".join(found.report.qc_flags)
        assert found.report.notes[0] == "the nucleus lies in a hole of the mask (16 px)"


@given(arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 12))).filter(np.any))
def test_excluding_gives_the_largest_piece_as_it_is(mask: np.ndarray) -> None:
    cleaned, report = clean_mask(mask, holes="exclude")
    filled, _ = clean_mask(mask)
    labels, _ = ndimage.label(mask, np.ones((3, 3)))
    areas = np.bincount(labels.ravel())[1:]
    np.testing.assert_array_equal(cleaned, labels == 1 + areas.argmax())
    assert report.area_px == cleaned.sum()
    assert report.excluded_px == filled.sum() - cleaned.sum()


def test_a_gap_around_the_nucleus_is_not_taken_for_touching_cells() -> None:
    mask = np.ones((30, 30), dtype=bool)
    mask[8:20, 8:20] = False
    nucleus = np.zeros_like(mask)
    nucleus[9:19, 9:19] = True
    filled = FilledMask.of(mask).under("fill", nucleus).report
    assert (filled.filled_px, filled.nucleus_in_holes_px) == (144, 144)
    assert not any("touching cells" in flag for flag in filled.qc_flags)
    excluded = FilledMask.of(mask).under("exclude", nucleus).report
    assert (excluded.filled_px, excluded.excluded_px, excluded.area_px) == (100, 44, 856)
    mask[25:29, 3:27] = False  # another hole
    assert any(
        "touching cells" in flag for flag in FilledMask.of(mask).under("fill", nucleus).report.qc_flags
    )
