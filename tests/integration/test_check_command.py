"""`cytodisk check`: what is wrong with masks, in few lines."""

from pathlib import Path

import numpy as np
import pytest
import tifffile
from command_line import Run, assert_refused, write

from cytodisk.runs.told.mask_sizes import size_words
from cytodisk.runs.told.place_words import ranges_words
from cytodisk.scale import Scale


def test_many_good_frames_take_few_lines(run: Run, tmp_path: Path) -> None:
    masks = np.zeros((300, 30, 30), dtype=np.uint8)
    masks[:, 5:25, 5:25] = 1
    path = tmp_path / "masks.tif"
    tifffile.imwrite(path, masks, photometric="minisblack", metadata={"axes": "TYX"})
    code, said, _ = run("check", path, "--pixel-size", 0.5)
    assert code == 0
    assert len(said.splitlines()) < 8
    assert "masks: a stack of masks, TYX (300, 30, 30) uint8" in said
    assert "axes TYX by its metadata" in said
    assert "pixel size: 0.5 µm" in said
    assert "300 frames: 300 usable (0 with QC flags), 0 not usable, 0 on the image border" in said
    assert "median area 400 px², 100 µm² (from 400 to 400 px²), as a circle of 11.3 µm across" in said
    every = run("check", path, "--all")[1]
    assert len(every.splitlines()) > 300
    assert "299\t299\t1\tyes\t\n" in every


def test_faults_are_named_with_their_frames(run: Run, tmp_path: Path) -> None:
    masks = np.zeros((12, 30, 30), dtype=np.uint8)
    masks[:, 5:25, 5:25] = 1
    masks[[2, 3, 4, 9]] = 0
    masks[5:8, 28, 28] = 1
    masks[8, 27:29, 28] = masks[8, 5:7, 28] = 1
    code, said, _ = run("check", write(tmp_path / "masks.tif", masks))
    assert code == 1
    assert "without a cell: 4 frames (2–4, 9): mask of shape (30, 30) is empty" in said
    assert "note: 4 frames (5–8): 1 fragment dropped (1 px, 0.2%), and the like\n" in said
    assert "QC flag: frame 8: 2 small pieces dropped (4 px)" in said
    assert "8 frames: 8 usable (1 with QC flags), 0 not usable" in said
    assert "frames without a cell: 4 empty" in said
    assert "cytodisk movie finds them" in said


def test_a_mask_that_leaves_its_place_for_a_frame(run: Run, tmp_path: Path) -> None:
    masks = np.zeros((8, 30, 90), dtype=np.uint8)
    masks[:, 5:25, 5:25] = 1
    masks[5] = np.roll(masks[5], 50, axis=1)

    said = run("check", write(tmp_path / "masks.tif", masks))[1]

    words = "jumps to another place (frames 4 and 5: by 2.2 of its diameters)\n"
    assert f"QC flag place jumps: the mask {words}" in said


def test_cells_of_a_label_image_are_named_by_their_numbers(run: Run, tmp_path: Path) -> None:
    labels = np.zeros((30, 60), dtype=np.uint8)
    labels[5:25, 5:25], labels[0:10, 35:50], labels[20:, 35:50] = 1, 2, 3
    code, said, _ = run("check", write(tmp_path / "labels.tif", labels))
    assert code == 0
    assert "QC flag image border: 2 cells (1–2): touches the image border (30.0% of its edge)\n" in said
    assert "3 cells: 3 usable (2 with QC flags), 0 not usable, 2 on the image border" in said


def test_one_cell_is_one_place(run: Run, tmp_path: Path) -> None:
    mask = np.zeros((30, 60), dtype=np.uint8)
    mask[5:25, 5:25] = 1
    mask[10:14, 10:14] = 0
    said = run("check", write(tmp_path / "mask.tif", mask))[1]
    assert "QC flag: cell 0: perhaps several touching cells" in said
    assert "note: cell 0: 1 hole filled (16 px, 4.0%)\n" in said
    assert "1 cell: 1 usable (1 with QC flags), 0 not usable" in said
    assert "\narea 400 px², as a circle of 22.6 px across\n" in said


def test_a_file_that_cannot_be_read(run: Run, tmp_path: Path) -> None:
    mask = np.zeros((30, 60), dtype=np.uint8)
    mask[5:25, 5:25] = 1
    path = write(tmp_path / "mask.tif", mask)
    assert_refused(run("check", tmp_path / "gone.tif"), "does not exist")
    assert_refused(run("check", path, "--kind", "cells"), "kind", "got 'cells'")
    assert_refused(run("check", path, "--signal", tmp_path / "gone.tif"), "does not exist")


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ([3], "3"),
        ([0, 1, 2], "0–2"),
        ([5, 0, 7, 1], "0–1, 5, 7"),
        ([*range(0, 20, 2)], "0, 2, 4, 6, 8, 10, 12, 14, … 2 more"),
    ],
)
def test_ranges_of_frames(numbers: list[int], words: str) -> None:
    assert ranges_words(numbers) == words


def test_sizes_show_a_wrong_scale() -> None:
    assert size_words([7854], Scale(0.1)).endswith("as a circle of 10 µm across")
    assert size_words([7854], Scale(100.0)).endswith("as a circle of 10000 µm across")


def test_a_comma_in_a_number_is_named(run: Run, tmp_path: Path) -> None:
    mask = np.zeros((30, 60), dtype=np.uint8)
    mask[5:25, 5:25] = 1
    path = write(tmp_path / "mask.tif", mask)
    assert_refused(run("check", path, "--pixel-size", "0,2"), "--pixel-size must be", "got '0,2': write 0.2:")
    common = ("map", path, "-o", tmp_path / "out")
    assert_refused(run(*common, "--layers", "1,000"), "--layers must be", "write 1000:")
    assert_refused(run(*common, "--depth-um", "0,5,1,2"), "--depth-um must be", "write 0.5,1.2")
    (tmp_path / "p.toml").write_text("layers = 3\nedge_length = 0,7\n")
    refused = run(*common, "--parameters", tmp_path / "p.toml")
    assert_refused(refused, "p.toml: line 2 has a number with a comma", "write edge_length = 0.7")
    assert not (tmp_path / "out").exists()


def test_a_cell_at_the_border_has_the_flag_that_its_map_has(run: Run, tmp_path: Path) -> None:
    mask = np.zeros((40, 40), dtype=np.uint8)
    mask[10:30, :20] = 255
    path = write(tmp_path / "mask.tif", mask)
    code, said, _ = run("check", path)
    assert code == 0
    assert "QC flag image border: cell 0: touches the image border" in said
    assert "1 usable (1 with QC flags)" in said
    assert "\tQC flag\ttouches the image border" in run("check", path, "--all")[1]


def test_two_classes_are_noted_once(run: Run, tmp_path: Path) -> None:
    for name in "ab":
        classes = np.ones((40, 40), dtype=np.uint8)
        classes[10:30, 10:30] = 2
        write(tmp_path / f"{name}_Simple Segmentation.tif", classes)
    for masks in (tmp_path, tmp_path / "a_Simple Segmentation.tif"):
        code, said, warned = run("check", masks)
        assert code == 0
        assert (said + warned).count("values 1 and 2 and no 0") == 1


def test_an_empty_channel_names_those_that_hold_something(run: Run, tmp_path: Path) -> None:
    image = np.zeros((40, 40, 3), dtype=np.uint8)
    image[10:30, 10:30, 1] = 255
    path = tmp_path / "shot.tif"
    tifffile.imwrite(path, image, photometric="rgb")
    assert_refused(run("check", path), "as --mask-channel 1")
    _, said, warned = run("check", path, "--mask-channel", 0)
    assert "channel 1 of the file (from 0) holds something: pass --mask-channel 1" in said + warned
    code, said, warned = run("check", path, "--mask-channel", 1)
    assert code == 0
    assert "is empty" not in said + warned


def test_several_values_in_a_mask_name_the_flag(run: Run, tmp_path: Path) -> None:
    labels = np.zeros((40, 40), dtype=np.uint8)
    labels[5:15, 5:25], labels[15:35, 5:25] = 1, 2
    said = run("check", write(tmp_path / "mask.tif", labels), "--kind", "mask")[1]
    assert "(--kind labels)" in said


def test_the_start_of_names_is_no_file_but_files_that_begin_so_are_named(run: Run, tmp_path: Path) -> None:
    mask = np.zeros((40, 40), dtype=np.uint8)
    mask[10:30, 10:30] = 255
    for name in ("one", "x_1", "x_2"):
        write(tmp_path / f"{name}.tif", mask)
    assert_refused(run("check", tmp_path / "one"), f"check the path, or pass {tmp_path / 'one.tif'}")
    pattern = f"'{tmp_path / 'x_'}*.tif'"
    for command in (("check",), ("movie", "-o", tmp_path / "out")):
        assert_refused(run(*command, tmp_path / "x_"), "the 2 that begin with it", pattern)
    assert_refused(run("check", tmp_path / "gone"), "gone does not exist: check the path\n")
