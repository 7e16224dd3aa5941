"""Fitting a nucleus into its cell: every case has its change, counted, or its error with a remedy."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

import cytodisk as cd
from cytodisk.errors import MaskError, NucleusError, ParameterError
from cytodisk.geometry.nucleus_mask import fit_nucleus
from cytodisk.geometry.outline import has_one_outline

EIGHT = np.ones((3, 3), dtype=bool)


def box(top: int, bottom: int, left: int, right: int, shape: tuple[int, int] = (60, 80)) -> np.ndarray:
    mask = np.zeros(shape, dtype=bool)
    mask[top:bottom, left:right] = True
    return mask


CELL = box(5, 55, 5, 75)  # 50 × 70
NUCLEUS = box(20, 40, 30, 50)


def changes(report: cd.NucleusReport) -> dict[str, float]:
    """What a report counts beside the area, without zeros."""
    counted = {name: value for name, value in vars(report).items() if value}
    return {name: value for name, value in counted.items() if name not in ("area_px", "n_nuclei")}


def test_a_nucleus_inside_comes_back_unchanged() -> None:
    fitted, report = fit_nucleus(CELL, NUCLEUS)
    np.testing.assert_array_equal(fitted, NUCLEUS)
    assert (report.area_px, report.n_nuclei, changes(report)) == (400, 1, {})
    assert (report.notes, report.qc_flags) == ((), ())


@pytest.mark.parametrize("dtype", ["uint8", "int32", "float32"])
def test_numbers_are_masks_too(dtype: str) -> None:
    fitted, _ = fit_nucleus(CELL.astype(dtype), NUCLEUS.astype(dtype))
    np.testing.assert_array_equal(fitted, NUCLEUS)


def test_a_data_array_goes_by_its_names() -> None:
    turned = xr.DataArray(NUCLEUS.T, dims=("x", "y"))
    np.testing.assert_array_equal(fit_nucleus(CELL, turned)[0], NUCLEUS)


def test_holes_are_filled_and_counted() -> None:
    nucleus = NUCLEUS.copy()
    nucleus[25:28, 35:38] = nucleus[30, 40] = False
    fitted, report = fit_nucleus(CELL, nucleus)
    np.testing.assert_array_equal(fitted, NUCLEUS)
    assert changes(report) == {"holes": 2, "filled_px": 10}
    assert report.notes == ("2 holes of the nucleus filled (10 px)",)


def test_a_nucleolus_with_its_own_label_is_part_of_the_nucleus() -> None:
    labels = NUCLEUS.astype(int)
    labels[25:35, 35:45] = 2
    fitted, report = fit_nucleus(CELL, labels)
    np.testing.assert_array_equal(fitted, NUCLEUS)
    assert (report.n_nuclei, changes(report)) == (1, {})


def test_specks_are_dropped_and_counted() -> None:
    specks = box(10, 12, 60, 66) | box(45, 46, 60, 61)
    fitted, report = fit_nucleus(CELL, NUCLEUS | specks)
    np.testing.assert_array_equal(fitted, NUCLEUS)
    assert (report.n_nuclei, changes(report)) == (1, {"dropped_px": 13})
    assert report.notes == ("specks beside the nucleus dropped (13 px)",)


SMALL = box(10, 18, 60, 65)  # 40 px: a tenth of the large one


def test_several_are_refused_with_their_areas_and_both_remedies() -> None:
    with pytest.raises(NucleusError, match=r"2 nuclei, of 400 and 40 px.*--several largest.*several='join'"):
        fit_nucleus(CELL, NUCLEUS | SMALL)


def test_the_largest_of_several_is_taken_on_request() -> None:
    fitted, report = fit_nucleus(CELL, NUCLEUS | SMALL, several="largest")
    np.testing.assert_array_equal(fitted, NUCLEUS)
    assert (report.n_nuclei, changes(report)) == (2, {"dropped_px": 40})
    assert report.notes == ("the largest of 2 nuclei taken (40 px dropped)",)
    assert "2 nuclei" in report.qc_flags[0]


def test_several_are_joined_along_the_shortest_way() -> None:
    left, right = box(20, 40, 15, 30), box(25, 35, 50, 60)
    fitted, report = fit_nucleus(CELL, left | right, several="join")
    assert has_one_outline(fitted)
    assert fitted[left | right].all()
    assert (report.n_nuclei, changes(report)) == (2, {"joined_px": 20})  # columns 30 … 49
    assert report.notes == ("2 nuclei joined (by 20 px)",)


def test_the_way_that_joins_goes_inside_the_cell() -> None:
    horseshoe = box(5, 55, 5, 35) & ~box(5, 45, 15, 25)
    nuclei = box(8, 14, 8, 12) | box(8, 14, 28, 32)
    fitted, report = fit_nucleus(horseshoe, nuclei, several="join")
    assert has_one_outline(fitted)
    assert ndimage.binary_erosion(horseshoe, EIGHT)[fitted].all()
    assert report.joined_px > 60  # down one arm and up the other, not across the gap of 10 px


def test_three_nuclei_are_joined() -> None:
    nuclei = box(10, 16, 10, 16) | box(10, 16, 60, 66) | box(40, 46, 35, 41)
    fitted, report = fit_nucleus(CELL, nuclei, several="join")
    assert has_one_outline(fitted)
    assert (report.n_nuclei, fitted[nuclei].all()) == (3, True)


def test_nuclei_that_no_way_joins_are_refused() -> None:
    dumbbell = box(5, 25, 5, 25) | box(14, 16, 25, 40) | box(5, 25, 40, 60)  # a neck of 2 px
    with pytest.raises(NucleusError, match=r"so narrow that a path would touch its edge.*--several largest"):
        fit_nucleus(dumbbell, box(10, 20, 10, 20) | box(10, 20, 45, 55), several="join")


def test_nuclei_that_touch_are_told_apart_by_their_labels() -> None:
    labels = NUCLEUS.astype(int) + box(20, 40, 40, 50)
    with pytest.raises(NucleusError, match="2 nuclei, of 200 and 200 px"):
        fit_nucleus(CELL, labels)
    fitted, report = fit_nucleus(CELL, labels, several="join")
    np.testing.assert_array_equal(fitted, NUCLEUS)
    assert (report.n_nuclei, changes(report)) == (2, {})
    assert report.notes == ("2 nuclei joined (by 0 px)",)


def test_a_nucleus_that_touches_the_edge_is_clipped_to_a_gap_of_one_pixel() -> None:
    nucleus = box(5, 45, 30, 40)  # its upper end on the cell's edge
    fitted, report = fit_nucleus(CELL, nucleus)
    np.testing.assert_array_equal(fitted, box(6, 45, 30, 40))
    assert report.clipped_px == 10
    assert report.clipped_share == pytest.approx(12 / 100)  # the end of 10, and a side of its two corners
    assert report.notes == ("10 px of the nucleus at the cell's edge clipped",)
    assert report.qc_flags == ("nucleus clipped: 12.0% of its outline lay at the cell's edge or outside",)


def test_a_nucleus_that_touches_with_a_corner_pixel_is_clipped() -> None:
    cell = CELL.copy()
    cell[5:20, 50:] = False  # a notch, whose corner pixel touches the nucleus' corner pixel
    nucleus = box(20, 40, 30, 50)
    fitted, report = fit_nucleus(cell, nucleus)
    assert report.clipped_px == 1
    assert not fitted[20, 49]


def test_the_image_border_is_an_edge_of_the_cell() -> None:
    cell = box(0, 30, 0, 60)
    fitted, report = fit_nucleus(cell, box(0, 25, 20, 26))
    np.testing.assert_array_equal(fitted, box(1, 25, 20, 26))
    assert report.clipped_px == 6


def test_a_nucleus_partly_outside_is_clipped() -> None:
    nucleus = box(2, 45, 30, 40)  # 3 of 43 rows outside: 7 %
    fitted, report = fit_nucleus(CELL, nucleus)
    np.testing.assert_array_equal(fitted, box(6, 45, 30, 40))
    assert (report.outside_px, report.clipped_px) == (30, 10)
    assert report.notes[0] == "30 px of the nucleus outside the cell clipped"


def test_a_nucleus_with_more_than_a_tenth_outside_is_refused() -> None:
    with pytest.raises(NucleusError, match=r"12 % of the nucleus lies outside the cell.*match_nuclei"):
        fit_nucleus(CELL, box(0, 42, 30, 40))


def test_a_nucleus_with_a_fifth_of_its_outline_at_the_edge_is_refused() -> None:
    with pytest.raises(NucleusError, match=r"27.5 % of the nuclear outline lies at the cell's edge.*correct"):
        fit_nucleus(CELL, box(5, 25, 20, 40))


def test_what_clipping_cuts_off_goes_with_it() -> None:
    cell = CELL & ~box(5, 24, 46, 48)  # a slit from above into the nucleus' corner
    nucleus = box(20, 50, 30, 50)
    fitted, report = fit_nucleus(cell, nucleus)
    assert has_one_outline(fitted)
    assert report.area_px == nucleus.sum() - report.outside_px - report.clipped_px


def test_a_nucleus_that_the_edge_cuts_in_two_is_refused() -> None:
    cell = CELL & ~box(5, 30, 39, 41)
    nucleus = box(20, 31, 12, 68)
    with pytest.raises(NucleusError, match=r"cuts the nucleus into 2 parts.*--several largest"):
        fit_nucleus(cell, nucleus)
    _, report = fit_nucleus(cell, nucleus, several="largest")
    assert report.area_px < nucleus.sum() / 2
    assert changes(report).keys() == {"outside_px", "clipped_px", "clipped_share"}


@pytest.mark.parametrize(
    ("nucleus", "words"),
    [
        (CELL, "covers 100 % of the cell: the same mask twice"),
        (ndimage.binary_erosion(CELL, np.ones((2, 1))), "covers 98 % of the cell: the same mask twice"),
        (np.ones_like(CELL), r"lies inside the nucleus: are the two masks swapped\? Pass"),
        (box(0, 3, 0, 3), "no pixel in common: pass masks of one image"),
        (np.zeros_like(CELL), "nucleus is empty.*leave nucleus out"),
        (
            NUCLEUS[:, :-1],
            r"nucleus has shape \(60, 79\), the cell's mask \(60, 80\): pass masks",
        ),
        (NUCLEUS * 0.5, "values other than 0 and 1: pass a mask"),
        (np.where(NUCLEUS, np.nan, 0), "values other than 0 and 1"),
        (-NUCLEUS.astype(int), r"negative values \(down to -1\)"),
        (NUCLEUS.astype(str), "must be boolean or numeric, got dtype <U5"),
        (np.stack([NUCLEUS, NUCLEUS]), r"nucleus has shape \(2, 60, 80\)"),
        ([[1, 0], [1]], "must be an array of shape"),
    ],
)
def test_what_is_no_nucleus_of_this_cell(nucleus: np.ndarray, words: str) -> None:
    with pytest.raises(NucleusError, match=words):
        fit_nucleus(CELL, nucleus)


@pytest.mark.parametrize("several", ["refuse", "largest"])
def test_nuclei_of_a_whole_field_are_not_those_of_one_cell(several: str) -> None:
    field = NUCLEUS | box(57, 60, 0, 80)
    if several == "refuse":
        with pytest.raises(NucleusError, match=r"2 nuclei, 1 of them outside the cell.*nuclei == label"):
            fit_nucleus(CELL, field)
        return
    fitted, report = fit_nucleus(CELL, field | box(0, 3, 0, 80), several="largest")
    np.testing.assert_array_equal(fitted, NUCLEUS)
    assert report.n_nuclei == 3


def test_the_mask_of_the_cell_must_be_clean() -> None:
    with pytest.raises(MaskError, match="pass it through clean_mask first"):
        fit_nucleus(CELL & ~box(10, 12, 10, 12), NUCLEUS)


def test_an_unknown_policy_is_refused() -> None:
    with pytest.raises(ParameterError, match="several must be one of refuse, largest, join, got 'all'"):
        fit_nucleus(CELL, NUCLEUS, several="all")  # type: ignore[arg-type]


@settings(max_examples=150, deadline=None)
@given(seed=st.integers(0, 10**6), several=st.sampled_from(["refuse", "largest", "join"]))
def test_a_fitted_nucleus_is_one_piece_inside_and_every_pixel_is_counted(seed: int, several: str) -> None:
    rng = np.random.default_rng(seed)
    cell, _ = cd.clean_mask(ndimage.gaussian_filter(rng.normal(size=(40, 50)), 4) > -0.02)
    depth = ndimage.distance_transform_edt(np.pad(cell, 1))[1:-1, 1:-1]
    blobs = ndimage.gaussian_filter(rng.normal(size=cell.shape), 2) + 0.02 * depth * rng.random()
    nucleus = (blobs > 0.1) & (depth > rng.integers(0, 5))
    try:
        fitted, report = fit_nucleus(cell, nucleus, several=several)  # type: ignore[arg-type]
    except NucleusError:
        return
    assert has_one_outline(fitted)
    assert cell[ndimage.binary_dilation(np.pad(fitted, 1), EIGHT)[1:-1, 1:-1]].all()
    lost = report.dropped_px + report.outside_px + report.clipped_px
    assert report.area_px == fitted.sum() == nucleus.sum() - lost + report.filled_px + report.joined_px
    assert (report.filled_px > 0) == (report.holes > 0)
    again, unchanged = fit_nucleus(cell, fitted)
    np.testing.assert_array_equal(again, fitted)
    assert changes(unchanged) == {}
