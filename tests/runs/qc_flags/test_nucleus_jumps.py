"""Nuclei that leap within their cell, put into movies whose nuclei do not."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy import ndimage
from tifffile import imwrite

import cytodisk as cd
from cytodisk.runs.qc_flags.nucleus_jumps import position_leaps

FRAMES, AT = 6, 3


def flags_of(masks: np.ndarray, nuclei: np.ndarray, folder: Path) -> dict[str, list[tuple[int | None, str]]]:
    for name, stack in (("masks", masks), ("nuclei", nuclei)):
        imwrite(
            folder / f"{name}.tif", stack.astype(np.uint8), metadata={"axes": "TYX"}, photometric="minisblack"
        )
    nuclear = {"nuclei": folder / "nuclei.tif", "nucleus_layers": 1}
    study = cd.run_movie(folder / "masks.tif", folder / "out", layers=2, sectors=6, **nuclear)  # type: ignore[arg-type]
    assert (study.cells["status"] == "ok").all()
    return {flag.name: [(place.frame, place.note) for place in flag.places] for flag in cd.qc_flags(study)}


@pytest.mark.parametrize("kind", ["migrating", "bulging", "growing", "ruffling", "necking"])
def test_nuclei_of_moving_cells_do_not_jump(kind: str, tmp_path: Path) -> None:
    truth = cd.simulate.movie_with_nuclei(kind, frames=FRAMES, radius_px=18.0)  # type: ignore[arg-type]
    assert "nucleus jumps" not in flags_of(truth.masks, truth.nuclei, tmp_path)


def test_a_nucleus_elsewhere_and_one_of_twice_the_area_are_flagged_once(tmp_path: Path) -> None:
    cell = cd.simulate.disk(30, margin=5)
    middle = np.array(cell.shape) // 2
    from_middle = np.hypot(*(np.indices(cell.shape) - middle[:, None, None]))
    nucleus = np.roll(from_middle <= 8, -8, axis=1)
    masks, nuclei = np.stack([cell] * FRAMES), np.stack([nucleus] * FRAMES)
    nuclei[2] = np.roll(nucleus, 16, axis=1)
    nuclei[4] = ndimage.binary_dilation(nucleus, iterations=4)
    found = flags_of(masks, nuclei, tmp_path)["nucleus jumps"]
    assert [frame for frame, _ in found] == [2, 4]
    assert "2.0 of its radius" in found[0][1]
    assert "area +" in found[1][1]


def test_steps_count_in_radii_and_what_comes_back_is_no_second_leap() -> None:
    frame = np.array([0, 1, 2, 3, 5])
    away = np.array([[0.0, 0.0], [0.0, 12.0], [0.0, 1.0], [0.0, 9.0], [0.0, 90.0]])
    found = position_leaps(frame, away, np.full(5, 10.0))
    assert found == {0: 1.2}, "0.8 radii are none, and frame 4 is missing"
    assert_array_equal(list(position_leaps(frame, away, np.full(5, 5.0))), [0, 2])
