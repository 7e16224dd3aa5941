"""Masks as Cellpose, StarDist and ilastik write them."""

from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest
import tifffile
from numpy.testing import assert_array_equal

from cytodisk.errors import MaskError, ReadError
from cytodisk.images.file_parameters import KindParameters
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.frames import open_frames
from cytodisk.images.what_it_is import MaskLook, look_at

Y, X = np.mgrid[:60, :80]
PLACES = [(15, 15), (15, 45), (42, 20), (42, 60), (30, 34), (50, 40), (12, 66)]
LABELS = np.zeros((60, 80), dtype=np.int32)
for number, (at_y, at_x) in enumerate(PLACES, start=1):
    LABELS[np.hypot(Y - at_y, X - at_x) <= 7] = number
CLASSES = np.where(LABELS > 0, 2, 1).astype(np.uint8)


def looked(path: Path, **how: object) -> MaskLook:
    return look_at(open_frames(path), KindParameters(**how))


def write_cellpose(path: Path) -> Path:
    if path.suffix == ".png":
        imageio.imwrite(path, LABELS.astype(np.uint16))  # as cv2.imwrite does
    elif path.suffix == ".tif":
        tifffile.imwrite(path, LABELS.astype(np.uint16), compression="zlib")
    else:
        flows = [np.zeros((60, 80, 3), np.uint8), np.zeros((60, 80), np.float32), [], []]
        about = {"outlines": LABELS, "chan_choose": [0, 0], "ismanual": np.zeros(7, bool), "flows": flows}
        np.save(path, about | {"masks": LABELS.astype(np.uint16), "filename": path, "diameter": np.nan})
    return path


@pytest.mark.parametrize("name", ["a_cp_masks.png", "a_cp_masks.tif", "a_seg.npy"])
def test_cellpose(tmp_path: Path, name: str) -> None:
    look = looked(write_cellpose(tmp_path / name))
    assert (look.kind, look.labels) == ("labels", ((1, 2, 3, 4, 5, 6, 7),))
    assert_array_equal(look.file.frame(0)[0], LABELS)


@pytest.mark.parametrize("dtype", ["float32", "uint16"])  # whole numbers of 32 bits are saved as float32
def test_stardist(tmp_path: Path, dtype: str) -> None:
    tifffile.imwrite(tmp_path / "a.tif", LABELS.astype(dtype), imagej=True, metadata={"axes": "YX"})
    look = looked(tmp_path / "a.tif")
    assert (look.kind, len(look.labels[0])) == ("labels", 7)  # type: ignore[arg-type]
    assert_array_equal(look.file.frame(0)[0], LABELS)


def test_object_identities_of_ilastik(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "a_Object Identities.tif", LABELS.astype(np.uint32))
    look = looked(tmp_path / "a_Object Identities.tif")
    assert (look.kind, look.labels) == ("labels", ((1, 2, 3, 4, 5, 6, 7),))


@pytest.mark.parametrize("background", [1, 2])
def test_the_background_of_a_simple_segmentation_is_found_and_told(tmp_path: Path, background: int) -> None:
    classes = CLASSES if background == 1 else 3 - CLASSES
    tifffile.imwrite(tmp_path / "a_Simple Segmentation.tif", classes)
    look = looked(tmp_path / "a_Simple Segmentation.tif")
    assert look.kind == "mask"
    assert_array_equal(look.file.frame(0)[0], LABELS > 0)
    words = f"as classes of ilastik: {background} is taken for the background, as it has 100% of the image's"
    assert words in look.words
    assert any(words in note for note in look.file.notes)
    numbered = looked(tmp_path / "a_Simple Segmentation.tif", label=True)
    assert (numbered.kind, len(numbered.labels[0])) == ("labels", 7)  # type: ignore[arg-type]


def test_a_movie_of_a_simple_segmentation(tmp_path: Path) -> None:
    one = np.where(LABELS == 5, 2, 1).astype(np.uint8)
    stack = np.stack([one, np.ones_like(one), np.roll(one, 2, axis=1)])  # the cell is out of the second frame
    tifffile.imwrite(tmp_path / "a.tif", stack, metadata={"axes": "TYX"}, imagej=True)
    look = looked(tmp_path / "a.tif")
    assert look.kind == "stack"
    for number in range(3):
        assert_array_equal(look.file.frame(number)[0], stack[number] == 2)


def test_a_simple_segmentation_that_is_not_plain(tmp_path: Path) -> None:
    halves = np.ones((60, 80), dtype=np.uint8)
    halves[:, 40:] = 2
    tifffile.imwrite(tmp_path / "a.tif", halves)
    with pytest.raises(
        MaskError, match=r"which one is the background is not plain: export Object Identities.*0"
    ):
        looked(tmp_path / "a.tif")
    assert looked(tmp_path / "a.tif", kind="labels").labels == ((1, 2),)
    turned = np.stack([CLASSES, 3 - CLASSES])
    tifffile.imwrite(tmp_path / "b.tif", turned, metadata={"axes": "TYX"}, imagej=True)
    with pytest.raises(MaskError, match="which one is the background is not plain"):
        looked(tmp_path / "b.tif")


def test_a_simple_segmentation_of_three_classes(tmp_path: Path) -> None:
    three = CLASSES + (np.hypot(Y - 15, X - 15) <= 3)
    tifffile.imwrite(tmp_path / "a.tif", three.astype(np.uint8))
    with pytest.raises(
        MaskError, match=r"background to 0 \(of classes of ilastik, export Object Identities\)"
    ):
        looked(tmp_path / "a.tif")
    tifffile.imwrite(tmp_path / "b.tif", (X // 27 + 1).astype(np.uint8))
    with pytest.raises(MaskError, match=r"values 1, 2, 3 and no 0, as classes of ilastik.*make a mask of"):
        looked(tmp_path / "b.tif")
    assert looked(tmp_path / "b.tif", kind="labels").labels == ((1, 2, 3),)


def test_labels_1_and_2_with_a_background_are_labels(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "a.tif", np.where(LABELS > 2, 0, LABELS).astype(np.uint8))
    assert looked(tmp_path / "a.tif").labels == ((1, 2),)


def test_probabilities_of_ilastik_are_refused_with_the_remedy(tmp_path: Path) -> None:
    cell = np.clip(1.2 - np.hypot(Y - 30, X - 40) / 30, 0, 1)
    channels = np.stack([1 - cell, cell], axis=-1).astype(np.float32)
    path = tmp_path / "a_Probabilities.tif"
    tifffile.imwrite(path, channels, photometric="minisblack", planarconfig="contig")  # as ilastik does
    with pytest.raises(
        MaskError, match=r"has 2 channels.*of probabilities, export the Simple Segmentation instead"
    ):
        looked(path)
    with pytest.raises(
        MaskError, match=r"looks like probabilities.*threshold it.*export the Simple Segmentation"
    ):
        look_at(open_frames(path, choice=FileChoice(channels=("1",))))


@pytest.mark.parametrize("name", ["a_Simple Segmentation.h5", "a.ilp"])
def test_hdf5_is_refused_with_the_remedy(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    with pytest.raises(
        ReadError, match="is an HDF5 file: export it as TIFF; in ilastik, choose Format: tif under"
    ):
        open_frames(tmp_path / name)
