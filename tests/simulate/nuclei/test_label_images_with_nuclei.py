import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy import ndimage

from cytodisk.errors import ParameterError
from cytodisk.geometry.nucleus_mask import fit_nucleus
from cytodisk.simulate import CellsWithNuclei, label_image_with_nuclei


@pytest.fixture(scope="module")
def field() -> CellsWithNuclei:
    return label_image_with_nuclei(40, 3, without=3, two=4, shared=2, partly_outside=6, loose=2)


def test_each_fault_is_there_as_often_as_asked_for(field: CellsWithNuclei) -> None:
    assert field.truth["case"].value_counts().to_dict() == {
        "one": 40 - 3 - 4 - 2 * 2 - 6,
        "none": 3,
        "two": 4,
        "shared": 4,
        "partly outside": 6,
        "no cell": 2,
    }
    assert np.unique(field.cells).tolist() == list(range(41))
    assert np.unique(field.nuclei).tolist() == list(range(1 + 23 + 8 + 2 + 6 + 2))


def test_the_list_says_what_the_images_show(field: CellsWithNuclei) -> None:
    for row in field.truth.itertuples():
        own = [int(label) for label in row.nuclei.split(",") if label]
        assert len(own) == row.n_nuclei
        nuclei, cell = np.isin(field.nuclei, own), field.cells == row.cell
        inside = (nuclei & cell).sum() / max(nuclei.sum(), 1)
        if row.case in ("one", "two"):
            assert inside == row.overlap == 1.0
            assert row.n_nuclei == {"one": 1, "two": 2}[row.case]
        elif row.case == "none":
            assert row.n_nuclei == 0
            assert not field.nuclei[cell].any()
        elif row.case == "no cell":
            assert row.cell == 0
            assert not field.cells[nuclei].any()
        else:
            assert inside == pytest.approx(row.overlap)
            low, high = (0.25, 0.75) if row.case == "shared" else (0.94, 0.98)
            assert low <= row.overlap <= high
    shared = field.truth[field.truth["case"] == "shared"]
    assert shared["nuclei"].value_counts().tolist() == [2, 2]
    assert shared.groupby("nuclei")["overlap"].sum().tolist() == pytest.approx([1.0, 1.0])
    assert shared.groupby("nuclei")["overlap"].max().min() > 0.55


def test_each_nucleus_of_a_plain_cell_can_be_mapped_as_it_is(field: CellsWithNuclei) -> None:
    fitted = 0
    for row in field.truth.itertuples():
        if row.case not in ("one", "partly outside"):
            continue
        _, report = fit_nucleus(field.cells == row.cell, field.nuclei == int(row.nuclei))
        assert (report.outside_px > 0) == (row.case == "partly outside")
        assert bool(report.notes) == (row.case == "partly outside")
        fitted += 1
    assert fitted == 29


def test_cells_that_share_a_nucleus_are_neighbours_and_all_others_apart(field: CellsWithNuclei) -> None:
    highest = ndimage.maximum_filter(field.cells, footprint=np.ones((3, 3)))
    touched = {
        (int(a), int(b)) for a, b in zip(field.cells.ravel(), highest.ravel(), strict=True) if 0 < a != b
    }
    shared = field.truth[field.truth["case"] == "shared"].groupby("nuclei")["cell"]
    assert touched == {(int(cells.min()), int(cells.max())) for _, cells in shared}


def test_nuclei_have_other_labels_than_their_cells(field: CellsWithNuclei) -> None:
    ones = field.truth[field.truth["case"] == "one"]
    assert (ones["nuclei"].astype(int) == ones["cell"]).mean() < 0.3


def test_the_same_seed_gives_the_same_images() -> None:
    one, again = label_image_with_nuclei(8, 1), label_image_with_nuclei(8, 1)
    assert_array_equal(one.nuclei, again.nuclei)
    assert_array_equal(one.cells, again.cells)
    assert one.truth.equals(again.truth)
    assert not one.truth.equals(label_image_with_nuclei(8, 2).truth)


def test_cells_must_be_enough_for_the_faults() -> None:
    with pytest.raises(ParameterError, match="cells must be at least 5 for these faults, got 3"):
        label_image_with_nuclei(3)
    with pytest.raises(ParameterError, match="without must be a whole number"):
        label_image_with_nuclei(3, without=-1)
    assert len(label_image_with_nuclei(1, without=0, two=0, shared=0, partly_outside=0, loose=0).truth) == 1
