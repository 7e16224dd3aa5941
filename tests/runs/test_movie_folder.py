"""Movies of one file a frame: the same results as one file, and what was taken is said."""

import shutil
from pathlib import Path
from typing import Any

import imageio.v3 as imageio
import numpy as np
import pytest
import tifffile
from movie_files import SMALL, assert_same_movie

import cytodisk as cd
from cytodisk.errors import CytodiskError
from cytodisk.runs.batch.batch_file import read_batch
from cytodisk.runs.batch.dry_run import understand
from cytodisk.runs.channel_names import common_signal_name
from cytodisk.runs.movie.movie_inputs import MovieInputs, open_movie
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.store.inputs.study_signal import find_signal
from cytodisk.store.tables import read_table

FRAMES = 5
TRUTH = cd.simulate.movie("growing", frames=FRAMES, radius_px=12.0)
assert TRUTH.signal is not None
MASKS = TRUTH.masks.astype(np.uint8)
SIGNAL = TRUTH.signal.to_numpy().astype(np.uint16)


def slices(folder: Path, name: str, images: Any, first: int = 1, skip: tuple[int, ...] = ()) -> Path:
    """Images as Fiji saves a sequence."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, image in enumerate(images, first):
        if number not in skip:
            tifffile.imwrite(folder / f"{name}{number:04d}.tif", image)
    return folder


def cellpose(folder: Path, skip: tuple[int, ...] = ()) -> Path:
    """Images with their masks beside them, as Cellpose writes them."""
    folder.mkdir(parents=True, exist_ok=True)
    for number in range(FRAMES):
        tifffile.imwrite(folder / f"t{number:03d}.tif", SIGNAL[number, 0])
        (folder / f"t{number:03d}_cp_outlines.txt").write_text("1,2,3\n")
        if number not in skip:
            imageio.imwrite(folder / f"t{number:03d}_cp_masks.png", MASKS[number].astype(np.uint16))
    return folder


def opened(masks: Path, signal: Path | None = None, **settings: Any) -> MovieInputs:
    return open_movie(masks, signal, SMALL.changed(**settings))


def test_slices_give_the_results_of_one_file(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "m.tif", MASKS * 255, photometric="minisblack")
    tifffile.imwrite(tmp_path / "VASP.tif", SIGNAL[:, 0], photometric="minisblack")
    whole = movie_study(opened(tmp_path / "m.tif", tmp_path / "VASP.tif"), tmp_path / "whole")
    masks, signal = slices(tmp_path / "m", "cell", MASKS * 255), slices(tmp_path / "s", "VASP", SIGNAL[:, 0])
    inputs = opened(masks, signal)
    assert "5 files in natural order, cell0001.tif to cell0005.tif" in inputs.understood["masks"]
    assert "5 files in natural order, VASP0001.tif to VASP0005.tif" in inputs.understood["signal"]
    assert inputs.signal is not None
    assert (inputs.notes, inputs.signal.channels) == ((), ("VASP",))
    study = movie_study(inputs, tmp_path / "slices")
    assert_same_movie(whole, study)
    told = study.provenance["inputs"]["masks"]
    assert list(told["files"]) == [f"cell{number:04d}.tif" for number in range(1, 6)]
    assert all(len(value) == 64 for value in told["files"].values())


def test_a_run_of_slices_is_resumed_only_with_the_same_files(tmp_path: Path) -> None:
    masks = slices(tmp_path / "m", "cell", MASKS)
    study = cd.run_movie(masks, tmp_path / "out", parameters=SMALL)
    assert len(cd.run_movie(masks, tmp_path / "out", parameters=SMALL, resume=True).cells) == len(study.cells)
    tifffile.imwrite(masks / "cell0006.tif", MASKS[-1])
    with pytest.raises(cd.errors.StudyError, match="masks"):
        cd.run_movie(masks, tmp_path / "out", parameters=SMALL, resume=True)


@pytest.mark.parametrize("signal", ["folder", "ending", "pattern"])
def test_a_cellpose_folder_needs_no_flags(tmp_path: Path, signal: str) -> None:
    folder = cellpose(tmp_path / "Rac1")
    if signal == "ending":
        for number in range(FRAMES):
            (folder / f"t{number:03d}.tif").rename(folder / f"t{number:03d}_img.tif")
    chosen = {"folder": folder, "ending": Path("_img"), "pattern": folder / "t*.tif"}[signal]
    inputs = opened(folder, chosen)
    assert "5 files in natural order, t000_cp_masks.png to t004_cp_masks.png" in inputs.understood["masks"]
    assert "beside them 5 other images, as t000" in inputs.understood["masks"]
    assert inputs.signal is not None
    assert (inputs.signal.channels, inputs.notes) == (("Rac1",), ())
    np.testing.assert_array_equal(inputs.signal.frame(3)[0], SIGNAL[3, 0])
    np.testing.assert_array_equal(inputs.masks.frame(3)[0], MASKS[3])
    assert f"sample images with --signal {folder}" in opened(folder).understood["masks"]


def test_a_gap_is_a_missing_frame_and_time_goes_on(tmp_path: Path) -> None:
    folder = cellpose(tmp_path / "in", skip=(2,))
    study = cd.run_movie(folder, tmp_path / "out", signal=folder, parameters=SMALL)
    assert study.cells["status"].tolist() == ["ok", "ok", "missing", "ok", "ok"]
    assert "t002_cp_masks.png is not there" in study.cells["reason"].iloc[2]
    assert study.provenance["warnings"][0].startswith("in: t002_cp_masks.png is not there")
    assert study.provenance["inputs"]["masks"]["files"]["t002_cp_masks.png"] == "unreadable"
    np.testing.assert_array_equal(find_signal(study).source.frame(2)[0], SIGNAL[2, 0])  # type: ignore[union-attr]


def test_images_go_with_the_masks_of_their_numbers(tmp_path: Path) -> None:
    masks = slices(tmp_path / "m", "m", MASKS[1:], first=2)
    images = slices(tmp_path / "s", "s", SIGNAL[:, 1])
    inputs = opened(masks, images)
    assert inputs.signal is not None
    np.testing.assert_array_equal(inputs.signal.frame(0)[0], SIGNAL[1, 1])
    assert "1 others have no mask" in inputs.understood["signal"]
    shifted = opened(slices(tmp_path / "m0", "m", MASKS, first=0), images)
    assert "m0000.tif goes with s0001.tif" in shifted.notes[0]
    lacking = opened(
        slices(tmp_path / "m1", "m", MASKS), slices(tmp_path / "s1", "s", SIGNAL[:, 1], skip=(3,))
    )
    assert "s0003.tif is not there" in lacking.notes[0]
    study = movie_study(lacking, tmp_path / "out")
    assert study.cells["status"].tolist() == ["ok", "ok", "missing", "ok", "ok"]
    with pytest.raises(cd.errors.SignalError, match="2 images numbered 1 to 2, and there are 4 masks"):
        opened(masks, slices(tmp_path / "s2", "s", SIGNAL[:2, 1]))


def test_masks_and_images_in_one_folder_are_told_apart_by_their_names(tmp_path: Path) -> None:
    folder = slices(slices(tmp_path / "in", "cell_mask_", MASKS), "cell_", SIGNAL)
    inputs = opened(folder, folder)
    assert inputs.signal is not None
    assert inputs.signal.axes == "TCYX"
    assert inputs.signal.channels == ("cell 1", "cell 2")
    np.testing.assert_array_equal(inputs.masks.frame(0)[0], MASKS[0])
    np.testing.assert_array_equal(inputs.signal.frame(4), SIGNAL[4])


def odd_shape(folder: Path) -> None:
    tifffile.imwrite(folder / "cell0003.tif", MASKS[2][:-1])


def stack(folder: Path) -> None:
    tifffile.imwrite(folder / "cell0003.tif", MASKS[:2], metadata={"axes": "TYX"}, photometric="minisblack")


def colour(folder: Path) -> None:
    tifffile.imwrite(folder / "cell0003.tif", np.stack([MASKS[0]] * 3, -1), photometric="rgb")


def second_movie(folder: Path) -> None:
    slices(folder, "other", MASKS)


def nothing_but_one(folder: Path) -> None:
    for number in range(2, FRAMES + 1):
        (folder / f"cell{number:04d}.tif").unlink()


def no_images(folder: Path) -> None:
    shutil.rmtree(folder)
    folder.mkdir()
    (folder / "notes.txt").write_text("x")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (odd_shape, r"cell0003\.tif has another size \(.* pixels\) than the other 4 files"),
        (stack, r"files of several frames \(cell0003\.tif\).* pass such a file alone"),
        (colour, r"cell0003\.tif has another number of channels \(3\)"),
        (second_movie, r"2 kinds of names \(5 × cell\*\.tif, 5 × other\*\.tif\).*'.*cell\*\.tif'"),
        (nothing_but_one, "one image alone: a movie has two frames at least; use cytodisk map"),
        (no_images, "holds no frames"),
    ],
)
def test_what_is_not_one_movie_is_refused_with_the_names(tmp_path: Path, change: Any, words: str) -> None:
    folder = slices(tmp_path / "m", "cell", MASKS)
    change(folder)
    with pytest.raises(CytodiskError, match=words):
        opened(folder)


def test_another_type_and_a_damaged_file_are_named(tmp_path: Path) -> None:
    folder = slices(tmp_path / "m", "cell", MASKS)
    tifffile.imwrite(folder / "cell0002.tif", MASKS[1].astype(np.uint16))
    (folder / "cell0004.tif").write_bytes(b"II*\0 no image")
    inputs = opened(folder)
    assert inputs.masks.dtype == np.uint16
    assert "cell0002.tif has another type (uint16) than the others (uint8)" in inputs.notes[0]
    assert "cell0004.tif" in inputs.notes[1]
    study = movie_study(inputs, tmp_path / "out")
    assert study.cells["status"].tolist() == ["ok", "ok", "ok", "unreadable", "ok"]


def test_scales_that_contradict_each_other_are_not_believed(tmp_path: Path) -> None:
    folder = tmp_path / "m"
    folder.mkdir()
    for number, size in enumerate((0.1, 0.1, 0.2)):
        scale = {"PhysicalSizeX": size, "PhysicalSizeY": size, "axes": "YX"}
        tifffile.imwrite(folder / f"t{number}.ome.tif", MASKS[number], metadata=scale)
    inputs = opened(folder)
    assert inputs.scale.pixel_size_um is None
    assert "pixel sizes differ (t0.ome.tif 0.1 µm, t2.ome.tif 0.2 µm)" in inputs.notes[0]
    assert opened(folder, pixel_size_um=0.1).scale.pixel_size_um == 0.1
    (folder / "t2.ome.tif").unlink()
    assert opened(folder).scale.pixel_size_um == pytest.approx(0.1)


def test_axes_of_the_movie_hold_for_its_frames(tmp_path: Path) -> None:
    masks = slices(tmp_path / "m", "cell", MASKS)
    images = slices(tmp_path / "s", "s", [np.moveaxis(image, 0, -1) for image in SIGNAL])
    inputs = opened(masks, images, signal_axes="TYXC", signal_channels=("1",))
    assert inputs.signal is not None
    assert inputs.signal.axes == "TYX"
    np.testing.assert_array_equal(inputs.signal.frame(2)[0], SIGNAL[2, 1])


def test_a_pattern_that_fits_nothing_says_so(tmp_path: Path) -> None:
    slices(tmp_path / "m", "cell", MASKS)
    assert opened(tmp_path / "m" / "cell*.tif").n_frames == FRAMES
    assert opened(tmp_path / "*" / "cell000[1-3].tif").n_frames == 3
    with pytest.raises(cd.errors.ReadError, match="no file fits the pattern"):
        opened(tmp_path / "m" / "mask*.tif")
    bracketed = slices(tmp_path / "exp [1]", "cell", MASKS)
    assert opened(bracketed / "cell*.tif").n_frames == opened(bracketed).n_frames == FRAMES
    with pytest.raises(cd.errors.ReadError, match="does not exist"):
        opened(bracketed / "mask.tif")


BATCH = """
[parameters]
layers = 2
sectors = 6
[[inputs]]
masks = "cells/*/masks/"
signal = "{folder}/VASP*.tif"
[[inputs]]
masks = "cp"
signal = "cp"
"""


@pytest.mark.slow
def test_folders_are_rows_of_a_batch_and_channels_have_one_name_in_all(tmp_path: Path) -> None:
    for cell in ("one", "two"):
        slices(tmp_path / "cells" / cell / "masks", "m", MASKS)
        slices(tmp_path / "cells" / cell, "VASP", SIGNAL[:, 0])
    cellpose(tmp_path / "cp")
    (tmp_path / "batch.toml").write_text(BATCH.replace('[[inputs]]\nmasks = "cp"\nsignal = "cp"\n', ""))
    cd.run_batch(tmp_path / "batch.toml", tmp_path / "out")
    assert read_table(tmp_path / "out" / "inputs.parquet")["status"].tolist() == ["ok", "ok"]
    study = cd.open_study(tmp_path / "out" / "inputs" / "cells-one-masks")
    assert study.windows["channel"].unique().tolist() == ["VASP"]
    assert study.provenance["parameters"]["channels"] == ["VASP"]
    tifffile.imwrite(tmp_path / "cells" / "two" / "masks" / "m0006.tif", MASKS[-1])
    slices(tmp_path / "cells" / "two", "VASP", SIGNAL[-1:, 0], first=6)
    cd.run_batch(tmp_path / "batch.toml", tmp_path / "out", resume=True)
    assert read_table(tmp_path / "out" / "inputs.parquet")["frames"].tolist() == [FRAMES, FRAMES + 1]
    (tmp_path / "batch.toml").write_text(BATCH)
    understood = [understand(item) for item in read_batch(tmp_path / "batch.toml").inputs]
    assert [one.channels for one in understood] == ["signal"] * 3


@pytest.mark.parametrize(
    ("paths", "name"),
    [
        (["a/c1_VASP.tif", "b/c2_VASP.tif"], "VASP"),
        (["day1/signal.ome.tif", "day2/signal.ome.tif"], "signal"),
        (["images/a.tif", "images/b.tif"], "images"),
        (["x/a.tif", "y/b.tif"], "signal"),
        (["x/velocity.tif", "y/velocity.tif"], "velocity signal"),
        (["x/a.tif"], ""),
        ([], ""),
    ],
)
def test_what_names_of_files_share_is_the_channels_name(paths: list[str], name: str) -> None:
    assert common_signal_name([Path(path) for path in paths]) == name


def test_what_is_said_of_a_signal_needs_one(tmp_path: Path) -> None:
    masks = slices(tmp_path / "m", "cell", MASKS)
    with pytest.raises(cd.errors.ParameterError, match="signal_channels is given, but there is no signal"):
        opened(masks, signal_channels=("1",))
    with pytest.raises(cd.errors.ParameterError, match="signal_axes is given, but there is no signal"):
        cd.run_map(masks / "cell0001.tif", tmp_path / "out", signal_axes="CYX")


def test_a_scene_or_slice_that_no_frame_has_is_refused(tmp_path: Path) -> None:
    masks = slices(tmp_path / "m", "cell", MASKS)
    for given in ({"scene": 3}, {"z": "max"}):
        with pytest.raises(CytodiskError, match=f"--{next(iter(given))} "):
            opened(masks, **given)
    stacks = slices(tmp_path / "s", "VASP", [np.stack([image[0], image[1] * 2]) for image in SIGNAL])
    inputs = opened(masks, stacks, z="max", signal_axes="TZYX")
    assert inputs.signal is not None
    np.testing.assert_array_equal(inputs.signal.frame(1)[0], np.maximum(SIGNAL[1, 0], SIGNAL[1, 1] * 2))
    assert find_signal(movie_study(inputs, tmp_path / "out")).fault == ""
