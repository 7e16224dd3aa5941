"""Masks of cells and of nuclei with holes, and masks that leave the nucleus out."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.errors import MaskError

CELL = cd.simulate.disk(30)
ROW, COLUMN = np.indices(CELL.shape) - (CELL.shape[0] // 2)


def ball(row: float, column: float, radius: float) -> np.ndarray:
    return np.asarray(np.hypot(ROW - row, COLUMN - column) < radius)


NUCLEUS, VACUOLE = ball(4, -3, 10.5), ball(-18, 4, 4.2)
CYTOPLASM = {
    "the whole cell": CELL,
    "the cytoplasm": CELL & ~NUCLEUS,
    "the cytoplasm, a gap around the nucleus": CELL & ~ball(4, -3, 12.0),
}
NUCLEI = {"a nucleus": NUCLEUS, "a nucleus with a hole": NUCLEUS & ~ball(5, -3, 3.1)}


@pytest.mark.parametrize("holes", ["fill", "exclude"])
@pytest.mark.parametrize("vacuole", [False, True])
@pytest.mark.parametrize("nucleus", NUCLEI.values(), ids=NUCLEI.keys())
@pytest.mark.parametrize("mask", CYTOPLASM.values(), ids=CYTOPLASM.keys())
def test_the_nucleus_counts_as_cell_whatever_the_mask_says(
    mask: np.ndarray, nucleus: np.ndarray, vacuole: bool, holes: str
) -> None:
    mask = mask & ~VACUOLE if vacuole else mask
    disk = cd.map_to_disk(mask, nucleus, holes=holes)
    assert disk.certificate.valid
    windows = cd.polar_windows(4, 24, nucleus_layers=2).on(disk)
    by_layer = windows.areas.sum(axis=1)
    inside = windows.grid.compartments == "nucleus"
    counted = CELL if holes == "fill" else mask | NUCLEUS
    assert_allclose(by_layer[inside].sum(), NUCLEUS.sum(), rtol=1e-9)
    assert_allclose(by_layer[~inside].sum(), (counted & ~NUCLEUS).sum(), rtol=1e-9)
    assert_array_equal(disk.mask_without_holes, counted)
    assert_array_equal(windows.labels >= 0, counted)
    signal = np.random.default_rng(0).normal(100.0, 10.0, CELL.shape)
    signal[~counted] = np.nan
    data = cd.sample(windows, signal)
    total = (data["mean"] * data["n_pixels"]).sum("sector").to_numpy()
    assert_allclose(total[inside].sum(), signal[NUCLEUS].sum(), rtol=1e-9)
    assert_allclose(total[~inside].sum(), signal[counted & ~NUCLEUS].sum(), rtol=1e-9)
    assert not any("nucleus" in flag for flag in disk.report.qc_flags)
    assert any("touching cells" in flag for flag in disk.report.qc_flags) == (holes == "fill" and vacuole)


def test_the_places_are_those_of_the_whole_cell() -> None:
    whole = cd.map_to_disk(CELL, NUCLEUS)
    for mask in CYTOPLASM.values():
        disk = cd.map_to_disk(mask & ~VACUOLE, NUCLEUS, holes="exclude")
        assert_array_equal(disk.vertices_uv, whole.vertices_uv)


def test_with_error_a_hole_that_is_all_nucleus_is_none() -> None:
    assert cd.map_to_disk(CYTOPLASM["the cytoplasm"], NUCLEUS, holes="error").holes is None
    with pytest.raises(MaskError, match="1 hole"):
        cd.map_to_disk(CYTOPLASM["the cytoplasm"], holes="error")
    with pytest.raises(MaskError, match=f"holes beside the nucleus \\({VACUOLE.sum()} px\\)"):
        cd.map_to_disk(CYTOPLASM["the cytoplasm"] & ~VACUOLE, NUCLEUS, holes="error")


def test_holes_go_with_a_nucleus_to_a_file_and_to_a_larger_image(tmp_path) -> None:
    disk = cd.map_to_disk(CYTOPLASM["the cytoplasm"] & ~VACUOLE, NUCLEUS, holes="exclude")
    disk.save(tmp_path / "map.npz")
    read = cd.load_map(tmp_path / "map.npz")
    assert read.report == disk.report
    assert_array_equal(read.holes.whole, disk.holes.whole)
    height, width = CELL.shape
    larger = disk.placed((5, 7), (height + 20, width + 30))
    assert_array_equal(larger.holes.whole[5 : 5 + height, 7 : 7 + width], VACUOLE)
    grid = cd.polar_windows(3, 10, nucleus_layers=1)
    assert_allclose(grid.on(larger).areas, grid.on(read).areas)


@settings(max_examples=10)
@given(st.lists(st.tuples(st.floats(-26, 26), st.floats(-26, 26), st.floats(0.6, 7)), min_size=1, max_size=5))
def test_sums_by_compartment_are_exact_whatever_the_holes(balls: list[tuple[float, float, float]]) -> None:
    """Holes in cytoplasm, in the nucleus, and across its outline."""
    inner = np.hypot(ROW, COLUMN) < 27  # so that none opens to the outside
    drawn = np.any([ball(*one) for one in balls], axis=0) & inner
    mask, nucleus = CELL & ~drawn, NUCLEUS & ~(drawn & ball(4, -3, 8.0))
    mask = cd.clean_mask(mask, holes="exclude")[0]  # without pieces in holes
    disk = cd.map_to_disk(mask, nucleus, holes="exclude", several="largest")
    fitted = disk.nucleus.placed_mask.whole
    windows = cd.polar_windows(5, 30, nucleus_layers=3).on(disk)
    inside = windows.grid.compartments == "nucleus"
    by_layer = windows.areas.sum(axis=1)
    assert_allclose(by_layer[inside].sum(), fitted.sum(), rtol=1e-9)
    assert_allclose(by_layer[~inside].sum(), (mask & ~fitted).sum(), rtol=1e-9)
    assert disk.certificate.valid


@pytest.mark.parametrize("lay", [cd.nucleus_ring_windows, cd.interpolated_ring_windows])
@pytest.mark.parametrize("mask", CYTOPLASM.values(), ids=CYTOPLASM.keys())
def test_rings_around_the_nucleus_leave_the_same_pixels_out(lay, mask: np.ndarray) -> None:
    counted = (mask & ~VACUOLE) | NUCLEUS
    disk = cd.map_to_disk(mask & ~VACUOLE, NUCLEUS, holes="exclude")
    whole = lay(CELL, NUCLEUS, layers=4, sectors=12)
    for windows in (
        lay(mask & ~VACUOLE, NUCLEUS, layers=4, sectors=12, holes="exclude"),
        lay(disk, NUCLEUS, layers=4, sectors=12),
        lay(cd.map_to_disk(mask & ~VACUOLE, holes="exclude"), NUCLEUS, layers=4, sectors=12),
    ):
        assert_array_equal(windows.mask_without_holes, counted)
        assert_array_equal(windows.labels, np.where(counted, whole.labels, -1))
    with pytest.raises(MaskError, match="hole"):
        lay(mask & ~VACUOLE, NUCLEUS, holes="error")


def test_a_movie_of_cytoplasm_masks_holds_nuclei_and_leaves_vacuoles_out() -> None:
    """The vacuole closes in the third of four frames."""

    def moved(mask: np.ndarray) -> np.ndarray:
        return np.stack([np.roll(mask, frame, axis=1) for frame in range(4)])

    cells, nuclei = moved(CELL & ~NUCLEUS & ~VACUOLE), moved(NUCLEUS)
    cells[2] = moved(CELL & ~NUCLEUS)[2]
    counted = cells | nuclei
    movie = cd.map_movie(cells, nuclei=nuclei, holes="exclude")
    assert [disk.holes is None for disk in movie] == [False, False, True, False]
    activity = cd.sample_movie(movie, cd.polar_windows(4, 12, nucleus_layers=2), np.where(counted, 5.0, 1e6))
    areas = activity["area"].sum("sector").to_numpy()
    assert_allclose(areas.sum(axis=1), counted.sum(axis=(1, 2)), rtol=1e-9)
    assert_allclose(areas[:, 4:].sum(axis=1), NUCLEUS.sum(), rtol=1e-9)
    assert_allclose(activity["max"].max(), 5.0)
