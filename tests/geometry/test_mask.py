import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import ndimage

from cytodisk.errors import MaskError, ParameterError
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.mask_values import parse_mask


def drawn(*rows: str) -> np.ndarray:
    return np.array([[sign == "#" for sign in row] for row in rows])


PIECES = drawn(
    "##...",
    "##..#",
    ".....",
    "...##",
)
RING = drawn(
    ".......",
    ".#####.",
    ".#.#.#.",
    ".#.###.",
    ".#####.",
    ".......",
)


def test_a_clean_mask_comes_back_unchanged() -> None:
    mask = np.zeros((6, 7), dtype=bool)
    mask[2:4, 2:5] = True
    cleaned, report = clean_mask(mask)
    np.testing.assert_array_equal(cleaned, mask)
    assert (report.area_px, report.components, report.holes, report.border_share) == (6, 1, 0, 0.0)
    assert report.notes == ()


def test_fragments_are_dropped_and_counted() -> None:
    cleaned, report = clean_mask(PIECES)
    np.testing.assert_array_equal(np.argwhere(cleaned), [[0, 0], [0, 1], [1, 0], [1, 1]])
    assert (report.components, report.dropped_px, report.area_px) == (3, 3, 4)
    assert "2 fragments dropped (3 px, 42.9%)" in report.notes


def test_the_first_of_equal_pieces_is_kept() -> None:
    cleaned, report = clean_mask(drawn("#.#"))
    np.testing.assert_array_equal(cleaned, [[True, False, False]])
    assert report.dropped_px == 1


def test_pieces_that_touch_at_a_corner_are_one() -> None:
    _, report = clean_mask(drawn("#..", ".#.", "..#"))
    assert (report.components, report.area_px) == (1, 3)


def test_holes_are_filled_and_counted() -> None:
    cleaned, report = clean_mask(RING)
    assert cleaned[1:5, 1:6].all()
    assert (report.holes, report.filled_px, report.area_px) == (2, 3, 20)
    assert report.notes == ("2 holes filled (3 px, 15.0%)",)


def test_a_diagonal_contact_closes_a_hole() -> None:
    cleaned, report = clean_mask(drawn(".#.", "#.#", ".#."))
    assert (report.holes, report.filled_px) == (1, 1)
    assert cleaned[1, 1]


def test_a_notch_at_the_image_border_is_no_hole() -> None:
    _, report = clean_mask(drawn("#.#", "###"))
    assert report.holes == 0


def test_pieces_inside_a_hole_are_filled_over() -> None:
    island = np.ones((7, 7), dtype=bool)
    island[1:6, 1:6] = False
    island[3, 3] = True
    cleaned, report = clean_mask(island)
    assert cleaned.all()
    assert (report.components, report.dropped_px, report.holes, report.filled_px) == (2, 1, 1, 25)


def test_border_share_counts_pixel_edges() -> None:
    mask = np.zeros((5, 5), dtype=bool)
    mask[0, 1:3] = True  # perimeter 6, of which 2 on the border
    _, report = clean_mask(mask)
    assert report.border_share == pytest.approx(2 / 6)
    assert report.touches_border
    assert "touches the image border (33.3% of its edge)" in report.notes


def test_a_full_image_lies_on_the_border_all_around() -> None:
    assert clean_mask(np.ones((3, 4)))[1].border_share == 1.0


@pytest.mark.parametrize(
    ("mask", "policy", "message"),
    [
        (PIECES, {"fragments": "error"}, "mask has 3 pieces: keep one, or pass fragments='largest'"),
        (RING, {"holes": "error"}, r"mask has 2 holes \(3 px\): fill them, or pass holes='fill'"),
        (PIECES, {"border": "error"}, "touches the image border: leave the cell out, or pass border='flag'"),
        (np.zeros((2, 3, 4)), {}, r"mask must be 2D, got shape \(2, 3, 4\)"),
        (np.zeros((4, 5), dtype=bool), {}, r"mask of shape \(4, 5\) is empty"),
        (np.zeros((0, 5), dtype=bool), {}, r"mask of shape \(0, 5\) is empty"),
        (np.array([[0, 1, 3]]), {}, r"mask holds 2 labels \(1 … 3\): pass one cell, as mask == label"),
        (np.array([[0.0, 0.5]]), {}, "float64 with values other than 0 and 1 .*threshold"),
        (np.array([[1.0, np.nan]]), {}, "NaN"),
        (np.array([["a"]]), {}, "mask must be boolean or numeric, got dtype <U1"),
    ],
)
def test_mask_errors_say_what_came_and_what_to_do(
    mask: np.ndarray, policy: dict[str, str], message: str
) -> None:
    with pytest.raises(MaskError, match=message):
        clean_mask(mask, **policy)


@pytest.mark.parametrize("name", ["holes", "fragments", "border"])
def test_an_unknown_policy_is_refused(name: str) -> None:
    with pytest.raises(ParameterError, match=f"{name} must be one of .*error, got 'ignore'"):
        clean_mask(RING, **{name: "ignore"})


@pytest.mark.parametrize("dtype", [bool, np.uint8, np.int32, np.float32])
def test_any_numeric_type_is_read_alike(dtype: type) -> None:
    np.testing.assert_array_equal(parse_mask(RING.astype(dtype)), RING)


def test_a_single_label_of_any_value_is_a_mask() -> None:
    np.testing.assert_array_equal(parse_mask(RING.astype(np.uint16) * 517), RING)


@given(arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 12))).filter(np.any))
def test_cleaning_leaves_one_piece_without_holes_and_its_counts_add_up(mask: np.ndarray) -> None:
    cleaned, report = clean_mask(mask)
    assert ndimage.label(cleaned, np.ones((3, 3)))[1] == 1
    assert ndimage.label(np.pad(~cleaned, 1, constant_values=True))[1] == 1
    assert report.area_px == cleaned.sum() == mask.sum() - report.dropped_px + report.filled_px
    again, second = clean_mask(cleaned)
    np.testing.assert_array_equal(again, cleaned)
    assert (second.components, second.holes) == (1, 0)


def test_flagged_masks_are_said_to_be() -> None:
    good = np.zeros((40, 60), dtype=bool)
    good[5:25, 5:25] = True
    two = good.copy()
    two[5:15, 40:55] = True
    holed = good.copy()
    holed[10:13, 10:15] = False
    for mask, words in ((two, "more than one cell"), (holed, "touching cells"), (~good, "inverted")):
        assert any(words in doubt for doubt in clean_mask(mask)[1].qc_flags)
    crumbs = good.copy()
    crumbs[30:33, 30] = crumbs[35:38, 30] = True
    assert clean_mask(crumbs)[1].qc_flags == (
        "2 small pieces dropped (6 px): if they are cells, number the pieces (--label)",
    )
    speck = good.copy()
    speck[30, 30] = True
    assert clean_mask(speck)[1].qc_flags == ()


def test_a_ragged_list_is_a_mask_error() -> None:
    with pytest.raises(MaskError, match=r"mask must be an array of shape \(H, W\)"):
        clean_mask([[1, 0], [1]])


def test_a_dataarray_goes_by_the_names_of_its_dims() -> None:
    mask = np.zeros((6, 9), dtype=bool)
    mask[1:3, 1:8] = True
    named = xr.DataArray(mask, dims=("y", "x"))
    np.testing.assert_array_equal(clean_mask(named.transpose("x", "y"))[0], clean_mask(mask)[0])
