"""Which nucleus belongs to which cell, on label images that are drawn."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

import cytodisk as cd
from cytodisk.errors import MaskError, NucleusError
from cytodisk.images.frame_pixels import whole_pixels
from cytodisk.images.nuclei.label_overlaps import LabelOverlaps
from cytodisk.images.nuclei.numbered_pieces import numbered_pieces

SHAPE = (100, 150)


def drawn(*boxes: tuple[int, int, int, int, int]) -> np.ndarray:
    """A label image of boxes: label, first row, row after the last, first column, column after the last."""
    labels = np.zeros(SHAPE, dtype=np.uint16)
    for label, top, bottom, left, right in boxes:
        labels[top:bottom, left:right] = label
    return labels


CELLS = drawn((4, 10, 50, 10, 50), (9, 10, 50, 50, 90), (2, 60, 90, 10, 90))  # 4 and 9 touch


def matched(nuclei: np.ndarray, cells: np.ndarray = CELLS) -> dict[int, tuple[str, int, str]]:
    """Nuclei, their number and the status, by cell; a nucleus without a cell by its negative label."""
    table = cd.match_nuclei(cells, nuclei)
    return {
        -int(row.nuclei) if pd.isna(row.cell) else row.cell: (row.nuclei, row.n_nuclei, row.status)
        for row in table.itertuples()
    }


def reason(nuclei: np.ndarray, cell: int, cells: np.ndarray = CELLS) -> str:
    table = cd.match_nuclei(cells, nuclei)
    return str(table.set_index("cell").loc[cell, "reason"])


def test_each_cell_gets_its_nucleus_whatever_the_numbers() -> None:
    nuclei = drawn((70, 20, 30, 20, 30), (5, 20, 30, 60, 70), (6, 70, 80, 40, 60))
    assert matched(nuclei) == {4: ("70", 1, "ok"), 9: ("5", 1, "ok"), 2: ("6", 1, "ok")}


def test_a_mask_of_nuclei_is_numbered_by_its_pieces() -> None:
    nuclei = drawn((1, 20, 30, 60, 70), (1, 22, 30, 20, 30), (1, 70, 80, 40, 60))
    expected = {4: ("2", 1, "ok"), 9: ("1", 1, "ok"), 2: ("3", 1, "ok")}
    assert matched(nuclei) == matched(nuclei > 0) == matched((nuclei * 255).astype(np.uint8)) == expected


def test_one_nucleus_with_a_number_keeps_it() -> None:
    assert matched(drawn((7, 20, 30, 20, 30)))[4] == ("7", 1, "ok")


def test_several_nuclei_with_one_number_are_numbered() -> None:
    nuclei = drawn((255, 20, 30, 20, 30), (255, 70, 80, 40, 60))  # 0 and 255 as 16 bit
    assert matched(nuclei) == {4: ("1", 1, "ok"), 9: ("", 0, "none"), 2: ("2", 1, "ok")}


def test_cells_without_and_with_several() -> None:
    nuclei = drawn((1, 20, 30, 20, 30), (2, 35, 40, 20, 45), (3, 70, 71, 40, 41), (8, 70, 80, 60, 70))
    assert matched(nuclei) == {4: ("2,1", 2, "several"), 9: ("", 0, "none"), 2: ("8", 1, "ok")}
    assert reason(nuclei, 9) == "no nucleus lies in the cell"
    assert reason(nuclei, 4) == "2 nuclei lie in the cell"


def test_a_nucleus_belongs_to_the_cell_that_holds_most_of_it() -> None:
    nuclei = drawn((1, 20, 30, 30, 52))  # 20 of 22 columns in cell 4
    assert matched(nuclei) == {4: ("1", 1, "ok"), 9: ("", 0, "none"), 2: ("", 0, "none")}
    assert reason(nuclei, 9) == "no nucleus lies in the cell; nucleus 1 does with 9 % of its area"


def test_a_nucleus_that_two_cells_share_is_told_in_both() -> None:
    nuclei = drawn((1, 20, 30, 39, 59))  # 11 of 20 columns in cell 4, 9 in cell 9
    assert matched(nuclei) == {4: ("1", 1, "shared"), 9: ("", 0, "shared"), 2: ("", 0, "none")}
    assert reason(nuclei, 4) == reason(nuclei, 9) == "of nucleus 1, 55 % lie in label 4 and 45 % in label 9"
    own = nuclei + drawn((2, 35, 45, 70, 80))
    assert matched(own)[9] == ("2", 1, "ok")


def test_of_two_equal_parts_the_first_cell_counts() -> None:
    assert matched(drawn((1, 20, 30, 40, 60)))[4] == ("1", 1, "shared")


def test_a_nucleus_partly_outside() -> None:
    table = cd.match_nuclei(CELLS, drawn((1, 0, 20, 20, 30), (2, 55, 75, 40, 50), (3, 59, 79, 60, 70)))
    by_cell = table.set_index("cell")
    assert by_cell.loc[4, ["nuclei", "status", "overlap"]].tolist() == ["1", "partly outside", 0.5]
    assert by_cell.loc[4, "reason"] == "50 % of the nucleus lies outside the cell"
    assert by_cell.loc[2, "overlap"] == pytest.approx((15 + 19) / 40)


def test_a_nucleus_without_a_cell_has_a_row() -> None:
    table = cd.match_nuclei(CELLS, drawn((1, 0, 8, 100, 110), (3, 0, 14, 20, 30), (4, 70, 80, 20, 30)))
    last = table[table["cell"].isna()]
    assert last["nuclei"].tolist() == ["1", "3"]
    assert last["status"].tolist() == ["no cell", "no cell"]
    assert last["reason"].tolist() == ["it lies in no cell", "29 % lie in label 4"]
    assert last["overlap"].tolist() == [0.0, pytest.approx(4 / 14)]
    assert table["cell"].tolist()[:3] == [2, 4, 9]


def test_a_nucleus_in_holes_of_two_cells_is_the_inner_ones() -> None:
    y, x = np.mgrid[:80, :80] - 40
    distance, outer_nucleus = np.hypot(y, x), np.hypot(y, x + 28) < 5
    cells = np.where((distance < 36) & (distance >= 18), 1, 0) + np.where(
        (distance < 15) & (distance >= 6), 2, 0
    )
    cells[outer_nucleus] = 0
    found = cd.match_nuclei(cells, np.where(outer_nucleus, 5, np.where(distance < 6, 7, 0)))
    assert found["status"].tolist() == ["ok", "ok"]
    assert found["nuclei"].tolist() == ["5", "7"]


def test_a_mask_of_the_cytoplasm_that_is_open_at_the_nucleus_is_told_what_to_do() -> None:
    y, x = np.mgrid[:80, :80] - 40
    nucleus = np.hypot(y, x - 20) < 10
    cell = (np.hypot(y, x) < 30) & ~(np.hypot(y, x - 20) < 11)  # there is a gap of a pixel
    found = cd.match_nuclei(cell, nucleus)
    assert found["status"].tolist() == ["none", "no cell"]
    assert found["reason"][0] == (
        "no nucleus lies in the cell, but nucleus 1 beside it: a mask of the cytoplasm that is open there "
        "needs the nucleus added (cells | nuclei)"
    )
    with pytest.raises(NucleusError, match=r"right beside it: .* pass cells \| nuclei"):
        cd.fit_nucleus(cell, nucleus)
    assert cd.match_nuclei(cell | nucleus, nucleus)["status"].tolist() == ["ok"]


def test_a_nucleus_in_a_hole_of_its_cell_is_inside() -> None:
    cells = CELLS.copy()
    cells[20:30, 20:30] = 0
    nuclei = drawn((1, 20, 30, 20, 30), (2, 70, 80, 20, 30))
    assert matched(nuclei, cells) == {4: ("1", 1, "ok"), 9: ("", 0, "none"), 2: ("2", 1, "ok")}
    partly = drawn((1, 18, 28, 18, 28), (2, 70, 80, 20, 30))
    assert cd.match_nuclei(cells, partly).set_index("cell").loc[4, "overlap"] == 1.0


def test_a_cell_in_a_hole_of_another_keeps_its_nucleus() -> None:
    cells = CELLS.copy()
    cells[15:45, 15:45] = 0
    cells[20:40, 20:40] = 3
    assert matched(drawn((1, 25, 30, 25, 30)), cells)[3] == ("1", 1, "ok")


def test_a_notch_of_a_cell_is_no_hole() -> None:
    cells = CELLS.copy()
    cells[10:30, 20:30] = 0
    assert matched(drawn((1, 20, 30, 20, 30)), cells)[4] == ("", 0, "none")


def test_one_mask_is_one_cell() -> None:
    nuclei = drawn((3, 20, 30, 20, 30), (5, 80, 90, 80, 90))
    assert matched(nuclei, CELLS == 4) == {1: ("3", 1, "ok"), -5: ("5", 1, "no cell")}
    assert matched(nuclei, (CELLS == 4) * np.uint8(255))[1] == ("3", 1, "ok")
    assert matched(nuclei, (CELLS == 4) * 4)[4] == ("3", 1, "ok")


def test_a_mask_of_several_cells_is_refused() -> None:
    with pytest.raises(MaskError, match=r"2 pieces, .* several cells: give each a label"):
        cd.match_nuclei(np.isin(CELLS, (2, 4)), CELLS == 9)


def test_stacks_are_matched_frame_by_frame() -> None:
    nuclei = np.stack([drawn((1, 20, 30, 20, 30)), drawn((1, 20, 30, 60, 70)), drawn()])
    table = cd.match_nuclei(np.stack([CELLS] * 3), nuclei)
    assert list(table)[:2] == ["frame", "cell"]
    found = table[table["status"] == "ok"]
    assert found[["frame", "cell"]].to_numpy().tolist() == [[0, 4], [1, 9]]
    assert len(table) == 9


def test_data_arrays_go_by_their_names() -> None:
    nuclei = drawn((1, 20, 30, 20, 30))
    turned = cd.match_nuclei(xr.DataArray(CELLS.T, dims=("x", "y")), xr.DataArray(nuclei, dims=("y", "x")))
    pd.testing.assert_frame_equal(turned, cd.match_nuclei(CELLS, nuclei))


def test_an_image_without_nuclei_is_no_fault() -> None:
    table = cd.match_nuclei(CELLS, np.zeros_like(CELLS))
    assert table["status"].tolist() == ["none"] * 3


@pytest.mark.parametrize(
    ("cells", "nuclei", "words"),
    [
        (CELLS, CELLS, r"3 of 3 cells are covered by a nucleus: are these the masks of the cells twice\?"),
        (CELLS, CELLS > 0, "are covered by a nucleus|lie inside a nucleus"),
        (
            drawn((1, 20, 30, 20, 30), (2, 20, 30, 60, 70)),
            CELLS,
            "2 of 2 cells lie inside a nucleus",
        ),
        (
            CELLS,
            CELLS[:, :-1],
            r"nuclei have the shape \(100, 149\), the cells \(100, 150\): pass images of the",
        ),
        (
            np.stack([CELLS] * 2),
            np.stack([CELLS] * 3),
            "nuclei have 3 frames, the cells 2: pass nuclei of the",
        ),
        (np.stack([CELLS] * 2), CELLS, r"nuclei have the shape \(100, 150\), the cells \(2, 100, 150\)"),
        (CELLS, CELLS * 0.5, "nuclei hold numbers that are not whole: pass labels, or a mask"),
        (CELLS, -CELLS.astype(int), r"nuclei have negative labels \(down to -9\): set the background"),
        (CELLS, CELLS.astype(str), "nuclei must be labels or a mask, got dtype <U"),
        (CELLS, CELLS[0], r"nuclei must have the shape \(H, W\), or \(T, H, W\) of a stack, got \(150,\)"),
        (CELLS, [[1], [1, 2]], "nuclei must be an array of shape"),
    ],
)
def test_what_are_no_nuclei_of_these_cells(cells: np.ndarray, nuclei: np.ndarray, words: str) -> None:
    with pytest.raises(NucleusError, match=words):
        cd.match_nuclei(cells, nuclei)


@pytest.mark.parametrize(
    ("cells", "words"),
    [
        (np.zeros_like(CELLS), "cells hold no cell: all pixels are 0"),
        (CELLS * 0.5, "cells hold numbers that are not whole"),
    ],
)
def test_what_are_no_cells(cells: np.ndarray, words: str) -> None:
    with pytest.raises(MaskError, match=words):
        cd.match_nuclei(cells, CELLS)


def test_one_cell_that_its_nucleus_fills_does_not_refuse_the_others() -> None:
    nuclei = drawn((1, 10, 50, 10, 50), (2, 20, 30, 60, 70), (3, 70, 80, 40, 60))
    assert matched(nuclei)[9] == ("2", 1, "ok")


@settings(max_examples=100, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_overlaps_are_those_of_counting_pixel_by_pixel(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(1, 30, 2))
    cells, nuclei = rng.integers(0, rng.integers(1, 6), shape), rng.integers(0, rng.integers(1, 6), shape)
    cut = int(rng.integers(0, shape[0] + 1))
    found = LabelOverlaps.of([(cells[:cut], nuclei[:cut]), (cells[cut:], nuclei[cut:])])
    for labels, areas, image in (
        (found.cells, found.cell_px, cells),
        (found.nuclei, found.nucleus_px, nuclei),
    ):
        np.testing.assert_array_equal(labels, np.unique(image[image > 0]))
        np.testing.assert_array_equal(areas, [(image == label).sum() for label in labels])
    expected = {
        (c, n): ((cells == c) & (nuclei == n)).sum()
        for c in found.cells
        for n in found.nuclei
        if ((cells == c) & (nuclei == n)).any()
    }
    pairs = zip(found.cells[found.pairs[:, 0]], found.nuclei[found.pairs[:, 1]], strict=True)
    assert dict(zip(pairs, found.shared_px, strict=True)) == expected


@settings(max_examples=100, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_pieces_are_numbered_as_by_labelling_the_whole_image(seed: int) -> None:
    rng = np.random.default_rng(seed)
    height, width = rng.integers(1, 30, 2)
    mask = rng.random((height, width)) < rng.random()
    numbered = numbered_pieces(whole_pixels(mask[None]))
    expected, _ = ndimage.label(mask, np.ones((3, 3)))
    rows, columns = (slice(*np.sort(rng.integers(0, size + 1, 2))) for size in mask.shape)
    np.testing.assert_array_equal(numbered.cut(rows, columns)[0], expected[rows, columns])
    np.testing.assert_array_equal(numbered.cut(slice(0, height), slice(0, width))[0], expected)
