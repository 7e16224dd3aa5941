"""The file of nuclei that goes with each mask file of a folder."""

from pathlib import Path

import pytest

from cytodisk.errors import NucleusError, ReadError
from cytodisk.images.mask_files import MaskSource
from cytodisk.images.paired_files import NUCLEI, pair_files


def sources(folder: Path, *names: str) -> list[MaskSource]:
    return [MaskSource(name, folder / name, None, None) for name in names]


def fill(folder: Path, *names: str) -> Path:
    folder.mkdir(exist_ok=True)
    for name in names:
        (folder / name).touch()
    return folder


@pytest.mark.parametrize(
    ("mask", "nuclei"),
    [
        ("img_1_masks.tif", "img_1.tif"),
        ("img_1_masks.tif", "img_1_masks.tif"),
        ("img_1_cp_masks.png", "img_1_masks.tif"),
        ("img_1.tif", "img_1_seg.npy"),
        ("img_1.tif", "img_1_nuclei.png"),
        ("img_1_masks.tif", "img_1_nuclei_cp_masks.tif"),
    ],
)
def test_nuclei_pair_by_name(tmp_path: Path, mask: str, nuclei: str) -> None:
    folder = fill(tmp_path / "nuclei", nuclei, "img_11.tif", "img_2_masks.tif")
    assert pair_files(sources(tmp_path, mask), folder, NUCLEI) == (folder / nuclei,)


def test_masks_count_before_the_images_they_were_made_of(tmp_path: Path) -> None:
    folder = fill(tmp_path / "nuclei", "a.tif", "a_cp_masks.png", "a_seg.npy")
    assert pair_files(sources(tmp_path, "a_masks.tif"), folder, NUCLEI) == (folder / "a_cp_masks.png",)


@pytest.mark.parametrize("given", ["_dapi", "_dapi.tif", "*_dapi.tif"])
def test_how_names_go_on_beside_the_masks(tmp_path: Path, given: str) -> None:
    fill(tmp_path, "a_masks.tif", "a_dapi.tif", "b_masks.tif", "b_dapi.tif", "a.tif")
    found = pair_files(sources(tmp_path, "a_masks.tif", "b_masks.tif"), given, NUCLEI)
    assert found == (tmp_path / "a_dapi.tif", tmp_path / "b_dapi.tif")


def test_masks_of_cells_are_never_their_own_nuclei(tmp_path: Path) -> None:
    fill(tmp_path, "a_masks.tif", "b_masks.tif", "b_nuclei.tif")
    found = pair_files(sources(tmp_path, "a_masks.tif", "b_masks.tif"), tmp_path, NUCLEI)
    assert str(found[0]) == (
        f"a_masks.tif has no file of nuclei in {tmp_path}: a.tif or a_nuclei.tif (or .png) is not there"
    )
    assert found[1] == tmp_path / "b_nuclei.tif"


def test_what_cannot_be_paired_says_what_to_type(tmp_path: Path) -> None:
    masks = sources(tmp_path, "a_masks.tif")
    with pytest.raises(NucleusError, match=r"but a_dapi\.tif is: pass --nuclei \S+/_dapi\.tif"):
        pair_files(masks, fill(tmp_path / "nuclei", "a_dapi.tif"), NUCLEI)
    with pytest.raises(NucleusError, match=r"one file for a folder of masks.*as --nuclei _nuclei"):
        pair_files(masks, fill(tmp_path / "one", "a.tif") / "a.tif", NUCLEI)
    with pytest.raises(ReadError, match=r"nuclei gone does not exist: pass a folder of files of nuclei"):
        pair_files(masks, "gone", NUCLEI)
