from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest
import tifffile
from numpy.testing import assert_array_equal

from cytodisk.errors import MaskError, ParameterError, ReadError
from cytodisk.images.file_parameters import Kind, KindParameters
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frames import open_frames
from cytodisk.images.mask_files import (
    MaskSource,
    SourceCell,
    list_images,
    open_mask_files,
    read_source_cells,
)
from cytodisk.images.what_it_is import look_at

ONE = np.zeros((20, 30), dtype=np.uint8)
ONE[5:15, 5:12] = 1
TWO = ONE.copy()
TWO[5:15, 15:25] = 7


def written(tmp_path: Path, values: np.ndarray) -> FrameFile:
    tifffile.imwrite(tmp_path / "a.tif", values, photometric="minisblack")
    return open_frames(tmp_path / "a.tif", unnamed="T")


def understood_as(file: FrameFile, kind: Kind = "auto") -> Kind:
    return look_at(file, KindParameters(kind=kind)).kind


def read_cells(file: FrameFile, kind: Kind) -> list[SourceCell]:
    return list(read_source_cells([MaskSource(file.path.name, file.path, file, kind)]))


@pytest.mark.parametrize(
    ("values", "kind"),
    [
        (ONE, "mask"),
        (ONE * 255, "mask"),
        (ONE.astype(bool), "mask"),
        (ONE.astype(np.float32), "mask"),
        (ONE * 0, "mask"),
        (np.stack([ONE, ONE]), "stack"),
        (np.stack([ONE, 255 * ONE]), "stack"),
        (np.stack([ONE, ONE]).astype(np.float64), "stack"),
        (TWO, "labels"),
        (TWO.astype(np.uint16) * 300, "labels"),
        (np.stack([ONE, TWO]), "labels"),
        (np.stack([TWO, TWO]), "labels"),
    ],
)
def test_what_a_file_holds_is_seen(tmp_path: Path, values: np.ndarray, kind: str) -> None:
    assert understood_as(written(tmp_path, values)) == kind


def test_the_callers_word_counts(tmp_path: Path) -> None:
    assert understood_as(written(tmp_path, ONE), "labels") == "labels"


@pytest.mark.parametrize("bits", [8, 16])
def test_a_microscope_picture_is_refused(tmp_path: Path, bits: int) -> None:
    picture = np.random.default_rng(0).integers(0, 2**bits, (40, 50)).astype(f"uint{bits}")
    with pytest.raises(MaskError, match=r"picture.*threshold"):
        understood_as(written(tmp_path, picture))


def test_a_colour_picture_is_refused(tmp_path: Path) -> None:
    imageio.imwrite(tmp_path / "a.png", np.stack([ONE, ONE, ONE], axis=-1))
    with pytest.raises(MaskError, match=r"3 channels.*one value a pixel"):
        understood_as(open_frames(tmp_path / "a.png"))


def test_a_stack_where_one_image_is_needed(tmp_path: Path) -> None:
    with pytest.raises(MaskError, match="stack of 4 frames"):
        understood_as(written(tmp_path, np.stack([ONE] * 4)), "mask")


def test_an_unknown_kind(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"kind.*auto, mask, stack, labels.*'cells'"):
        understood_as(written(tmp_path, ONE), "cells")


def test_every_label_is_a_cell(tmp_path: Path) -> None:
    cells = read_cells(written(tmp_path, np.stack([TWO, ONE])), "labels")
    assert [(found.cell, found.frame, found.label) for found in cells] == [(0, 0, 1), (1, 0, 7), (2, 1, 1)]
    assert_array_equal(cells[1].mask, (TWO == 7)[4:16, 14:26])
    assert (cells[1].corner, cells[1].image_shape) == ((4, 14), (20, 30))


def test_every_frame_of_a_stack_is_a_cell(tmp_path: Path) -> None:
    cells = read_cells(written(tmp_path, np.stack([ONE, ONE[::-1]])), "stack")
    assert [(found.cell, found.frame, found.label) for found in cells] == [(0, 0, 1), (1, 1, 1)]
    assert_array_equal(cells[1].mask, ONE[::-1][4:16, 4:13])


def test_a_frame_without_label_has_a_reason(tmp_path: Path) -> None:
    cells = read_cells(written(tmp_path, np.stack([TWO, 0 * TWO])), "labels")
    assert [str(found.fault) if found.fault else "" for found in cells] == [
        "",
        "",
        "frame 1 is empty: it holds no label",
    ]


def test_labels_that_are_no_whole_numbers_have_a_reason(tmp_path: Path) -> None:
    (found,) = read_cells(written(tmp_path, TWO.astype(np.float32)), "labels")
    assert "whole numbers" in str(found.fault)
    assert "float32" in str(found.fault)


def test_a_mask_with_smoothed_edges_is_refused(tmp_path: Path) -> None:
    away = np.hypot(*(np.indices((60, 60)) - 30.0))
    smooth = (255.0 / (1.0 + np.exp((away - 20.0) / 0.8))).astype(np.uint8)
    with pytest.raises(MaskError, match="threshold it"):
        understood_as(written(tmp_path, smooth))


def test_a_single_label_keeps_its_number(tmp_path: Path) -> None:
    file = written(tmp_path, np.stack([ONE * 7, ONE * 8, ONE, ONE * 255]))
    assert [cell.label for cell in read_cells(file, understood_as(file))] == [7, 8, 1, 1]


def test_negative_labels_are_a_fault(tmp_path: Path) -> None:
    values = TWO.astype(np.int16)
    values[0, 0] = -1
    cells = read_cells(written(tmp_path, values), "labels")
    assert len(cells) == 1
    assert "negative labels (down to -1)" in str(cells[0].fault)


def test_a_single_image_is_read_once_and_a_stack_once_more_after_the_look(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    reads: list[int] = []
    frame = FrameFile.frame
    monkeypatch.setattr(FrameFile, "frame", lambda file, number: reads.append(number) or frame(file, number))
    for values, wanted in ((ONE, [0]), (np.stack([ONE, 2 * ONE, ONE]), [0, 1, 2, 0, 0, 1, 2])):
        reads.clear()
        sources = open_mask_files(written(tmp_path, values).path)
        images = list_images(sources)
        found = [cell for image in images for cell in image.cells()]
        assert [cell.cell for cell in found] == list(range(len(found)))
        assert len(found) == sum(image.n_cells for image in images)
        assert reads == wanted


def test_an_image_that_changed_since_it_was_looked_at_is_told(tmp_path: Path) -> None:
    values = np.zeros((2, 20, 20), dtype=np.uint8)
    values[:, 2:8, 2:8], values[:, 12:18, 12:18] = 1, 2
    (source,) = open_mask_files(written(tmp_path, values).path)
    written(tmp_path, values % 2)
    with pytest.raises(ReadError, match="changed"):
        list(list_images([source])[1].cells())
