import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import imageio.v3 as imageio
import numpy as np
import pandas as pd
import pytest
import tifffile
import typer
from command_line import Run, assert_refused, content, write
from rich.progress import Progress

import cytodisk as cd
from cytodisk.cli.console import progress_bar
from cytodisk.runs import versions as versions_of

GRID = ("--layers", "3", "--sectors", "8", "--figures", "0")


@pytest.fixture
def mask(tmp_path: Path) -> Path:
    values = np.zeros((40, 50), dtype=np.uint8)
    values[8:30, 6:40] = 1
    tifffile.imwrite(tmp_path / "mask.tif", values)
    return tmp_path / "mask.tif"


def test_map_writes_a_study(run: Run, mask: Path, tmp_path: Path) -> None:
    code, said, error = run("map", mask, "-o", tmp_path / "out", *GRID)
    assert (code, error.strip()) == (0, "")
    assert "masks: one mask, YX (40, 50) uint8" in said
    assert "pixel size: unknown, lengths are in px" in said
    assert "1 of 1 cell mapped, one to one" in said
    study = cd.open_study(tmp_path / "out")
    assert study.map(0).certificate.valid
    assert len(study.windows) == 24


def test_flags_reach_the_parameters(run: Run, mask: Path, tmp_path: Path) -> None:
    flags = ("--spacing", "radius", "--method", "harmonic", "--edge-length", "2", "--align", "30")
    more = ("--nan", "omit", "--pixel-size", "0.2", "--shape-weight", "0.01", "--kind", "mask", "--geojson")
    assert run("map", mask, "-o", tmp_path / "out", *GRID, *flags, *more, "-q")[:2] == (0, "")
    found = cd.open_study(tmp_path / "out").provenance["parameters"]
    wanted = {
        "kind": "mask",
        "axes": None,
        "label": False,
        "fragments": "refuse",
        "mask_channel": None,
        "scene": None,
        "z": None,
        "signal_axes": None,
        "signal_channels": None,
        "channels": None,
        "method": "harmonic",
        "shape_weight": 0.01,
        "edge_length": 2.0,
        "align": 30.0,
        "layers": 3,
        "sectors": 8,
        "spacing": "radius",
        "depth_um": None,
        "nan": "omit",
        "pixel_size_um": 0.2,
    }
    assert {name: found[name] for name in wanted} == wanted
    outlines = json.loads((tmp_path / "out" / "maps" / "cell_00000.geojson").read_text())
    kinds = [feature["properties"]["objectType"] for feature in outlines["features"]]
    assert kinds == ["annotation"] + ["detection"] * 24


def test_a_point_to_align_to(run: Run, mask: Path, tmp_path: Path) -> None:
    assert run("map", mask, "-o", tmp_path / "out", *GRID, "--align", "20,39")[0] == 0
    disk = cd.open_study(tmp_path / "out").map(0)
    assert disk.to_disk([[20.0, 39.0]])[0, 1] == pytest.approx(0.0, abs=0.05)
    refused = run("map", mask, "-o", tmp_path / "other", "--align", "left")
    assert_refused(refused, "--align must be 'upright', 'nucleus', a point", "got 'left'")


def test_figures_are_drawn(run: Run, mask: Path, tmp_path: Path) -> None:
    masks = write(tmp_path / "two.tif", np.stack([tifffile.imread(mask)] * 2))
    assert run("map", masks, "-o", tmp_path / "out", "--layers", 3, "--sectors", 8)[0] == 0
    names = {path.name for path in (tmp_path / "out" / "figures").iterdir()}
    assert "overview.png" in names
    assert any(name.startswith("cell_00000") for name in names)


def test_a_missing_file(run: Run, tmp_path: Path) -> None:
    result = run("map", tmp_path / "gone.tif", "-o", tmp_path / "out")
    assert_refused(result, "gone.tif does not exist: check the path")
    assert not (tmp_path / "out").exists()


def test_a_missing_signal(run: Run, mask: Path, tmp_path: Path) -> None:
    result = run("map", mask, "--signal", tmp_path / "gone.tif", "-o", tmp_path / "out")
    assert_refused(result, "gone.tif does not exist: check the path")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", ["a.tif", "a.png", "a.txt"])
def test_a_file_that_is_not_an_image(run: Run, tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("layers,sectors\n1,2\n")
    assert_refused(run("map", tmp_path / name, "-o", tmp_path / "out"), name, "image")


def test_an_empty_mask(run: Run, tmp_path: Path) -> None:
    path = write(tmp_path / "mask.tif", np.zeros((30, 30), dtype=np.uint8))
    result = run("map", path, "-o", tmp_path / "out", *GRID)
    assert_refused(result, "no cell could be mapped: mask of shape (30, 30) is empty: no pixel belongs to")
    assert cd.open_study(tmp_path / "out").cells["status"].tolist() == ["no cell"]


def test_a_stack_where_one_image_is_needed(run: Run, tmp_path: Path) -> None:
    path = write(tmp_path / "masks.tif", np.ones((4, 30, 30), dtype=np.uint8))
    result = run("map", path, "-o", tmp_path / "out", "--kind", "mask")
    assert_refused(result, "masks.tif is a stack of 4 frames where one image is needed: save the frame alone")


def test_a_picture_of_floats(run: Run, tmp_path: Path) -> None:
    values = np.random.default_rng(0).random((30, 30)).astype(np.float32)
    result = run("map", write(tmp_path / "a.tif", values), "-o", tmp_path / "out", *GRID)
    assert_refused(result, "looks like probabilities, not a mask", "threshold it, as image > 0.5")


def test_a_microscope_picture(run: Run, tmp_path: Path) -> None:
    values = np.random.default_rng(0).integers(0, 4000, (30, 30)).astype(np.uint16)
    result = run("map", write(tmp_path / "a.tif", values), "-o", tmp_path / "out")
    assert_refused(result, "looks like a picture, not a mask", "threshold it")


def test_a_colour_picture(run: Run, tmp_path: Path) -> None:
    imageio.imwrite(tmp_path / "a.png", np.full((30, 30, 3), 255, dtype=np.uint8))
    result = run("map", tmp_path / "a.png", "-o", tmp_path / "out")
    assert_refused(result, "a.png has 3 channels (red, green, blue)", "save the mask alone")


def test_a_z_stack(run: Run, mask: Path, tmp_path: Path) -> None:
    signal = tmp_path / "z.ome.tif"
    tifffile.imwrite(signal, np.zeros((5, 40, 50), dtype=np.uint8), metadata={"axes": "ZYX"})
    result = run("map", mask, "--signal", signal, "-o", tmp_path / "out")
    assert_refused(result, "z.ome.tif is a z-stack", "project it")


def test_a_signal_of_another_shape(run: Run, mask: Path, tmp_path: Path) -> None:
    signal = write(tmp_path / "signal.tif", np.zeros((40, 51), dtype=np.uint16))
    result = run("map", mask, "--signal", signal, "-o", tmp_path / "out")
    words = "has images of (40, 51), the masks of (40, 50): they must have the same height and width"
    assert_refused(result, words)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("value", ["0", "-3"])
@pytest.mark.parametrize("name", ["layers", "sectors"])
def test_counts_below_1(run: Run, mask: Path, tmp_path: Path, name: str, value: str) -> None:
    result = run("map", mask, "-o", tmp_path / "out", f"--{name}", value)
    assert_refused(result, f"--{name} must be a whole number from 1 to 100000, got {value}")
    assert not (tmp_path / "out").exists()


def test_counts_that_are_no_numbers(run: Run, mask: Path, tmp_path: Path) -> None:
    assert_refused(run("map", mask, "-o", tmp_path / "out", "--layers", "many"), "--layers", "whole number")


def test_no_workers(run: Run, mask: Path, tmp_path: Path) -> None:
    result = run("map", mask, "-o", tmp_path / "out", "--workers", "0")
    assert_refused(result, "workers must be a whole number from 1 to 1024, got 0")


def test_an_output_folder_below_a_file(run: Run, mask: Path) -> None:
    before = mask.read_bytes()
    result = run("map", mask, "-o", mask / "out", *GRID)
    assert_refused(result, f"output folder {mask / 'out'} cannot be written: Not a directory")
    assert_refused(run("map", mask, "-o", mask, *GRID), f"output {mask} is a file: pass a folder")
    assert_refused(run("demo", "-o", mask), "cannot be written")
    assert mask.read_bytes() == before


def test_an_output_folder_with_something_else(run: Run, mask: Path, tmp_path: Path) -> None:
    before = content(tmp_path)
    result = run("map", mask, "-o", tmp_path, "--overwrite", *GRID)
    assert_refused(result, "is not empty and holds no study: pass another folder")
    assert content(tmp_path) == before


def test_an_output_folder_of_another_run(run: Run, mask: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert run("map", mask, "-o", out, *GRID)[0] == 0
    before = content(out)
    assert_refused(run("map", mask, "-o", out, *GRID), "pass --resume to go on, --overwrite to replace it")
    other = ("--layers", "4", "--sectors", "8", "--figures", "0")
    assert_refused(run("map", mask, "-o", out, *other), "holds a study: pass --resume")
    assert_refused(run("map", mask, "-o", out, *other, "--resume"), "layers: 3 then, 4 now", "--overwrite")
    assert content(out) == before
    assert run("map", mask, "-o", out, *other, "--overwrite")[0] == 0
    assert len(cd.open_study(out).windows) == 32


def test_resume_of_a_complete_study(run: Run, mask: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert run("map", mask, "-o", out, *GRID)[0] == 0
    before = (out / "windows.parquet").stat().st_mtime_ns
    code, said, _ = run("map", mask, "-o", out, *GRID, "--resume")
    assert code == 0
    assert "1 of 1 cell mapped" in said
    assert (out / "windows.parquet").stat().st_mtime_ns == before


def test_a_damaged_frame_in_a_stack(run: Run, tmp_path: Path) -> None:
    masks = np.zeros((4, 30, 30), dtype=np.uint8)
    masks[:, 5:25, 5:25] = 1
    path = write(tmp_path / "masks.tif", masks, compression="zlib")
    with tifffile.TiffFile(path) as tiff:
        start, count = tiff.pages[2].dataoffsets[0], tiff.pages[2].databytecounts[0]
    with path.open("r+b") as file:
        file.seek(start)
        file.write(b"\xff" * count)
    result = run("map", path, "-o", tmp_path / "out", *GRID)
    assert_refused(result, "cell 2 (frame 2) unreadable", "damaged frames of the input: 1; all others are in")
    assert cd.open_study(tmp_path / "out").cells["status"].tolist() == ["ok", "ok", "unreadable", "ok"]


def test_a_file_that_is_cut_short(run: Run, tmp_path: Path) -> None:
    path = write(tmp_path / "masks.tif", np.ones((4, 30, 30), dtype=np.uint8), compression="zlib")
    path.write_bytes(path.read_bytes()[:-60])
    assert_refused(
        run("map", path, "-o", tmp_path / "out"), "masks.tif: the file is cut short", "copy it again"
    )


def test_nan_in_the_signal(run: Run, mask: Path, tmp_path: Path) -> None:
    signal = np.ones((40, 50), dtype=np.float32)
    signal[10, 10:14] = np.nan
    path = write(tmp_path / "signal.tif", signal)
    code, said, _ = run("map", mask, "--signal", path, "-o", tmp_path / "out", *GRID)
    assert code == 0
    assert "1 cell with remarks" in said
    study = cd.open_study(tmp_path / "out")
    assert study.cells["nan_px"].tolist() == [4]
    assert study.windows["n_nan"].sum() == pytest.approx(4.0)
    assert (study.windows["mean"].isna() == (study.windows["n_nan"] > 0)).all()


def test_parameters_of_a_study_reproduce_it(run: Run, mask: Path, tmp_path: Path) -> None:
    signal = write(tmp_path / "signal.tif", np.random.default_rng(0).random((2, 40, 50)))
    flags = (
        "--layers",
        "4",
        "--sectors",
        "7",
        "--spacing",
        "radius",
        "--align",
        "33.3",
        "--pixel-size",
        "0.1",
    )
    first, second = tmp_path / "first", tmp_path / "second"
    common = ("map", mask, "--signal", signal, "--figures", "0")
    assert run(*common, "-o", first, *flags)[0] == 0
    assert run(*common, "-o", second, "--parameters", first / "parameters.toml")[0] == 0
    assert (first / "windows.parquet").read_bytes() == (second / "windows.parquet").read_bytes()
    assert (first / "parameters.toml").read_bytes() == (second / "parameters.toml").read_bytes()


def test_a_parameters_file_that_cannot_be_used(run: Run, mask: Path, tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text("layer = 3\n")
    common = ("map", mask, "-o", tmp_path / "out", "--parameters")
    assert_refused(run(*common, tmp_path / "p.toml"), "no parameters of this command (layer)")
    assert_refused(run(*common, tmp_path / "gone.toml"), "gone.toml cannot be read")


def test_names_of_channels(run: Run, mask: Path, tmp_path: Path) -> None:
    counts = np.ones((2, 40, 50), dtype=np.uint16)
    signal = tmp_path / "signal.ome.tif"
    names = {"axes": "CYX", "Channel": {"Name": ["488", "velocity"]}}
    tifffile.imwrite(signal, counts, photometric="minisblack", metadata=names)
    given = ("--signal", signal, "--channels", "Rac1, RhoA")
    for command in (("map", mask, "-o", tmp_path / "out"), ("check", mask)):
        refused = run(*command, *given[:2])
        assert_refused(
            refused, "has a channel 'velocity'", "pass other names for its 2 channels, as --channels"
        )
        refused = run(*command, *given[:3], "Rac1,Rac1")
        assert_refused(refused, "channels: two channels have one name, got ('Rac1', 'Rac1')")
        assert not (tmp_path / "out").exists()
    assert run("check", mask, *given)[0] == 0
    code, said, _ = run("map", mask, "-o", tmp_path / "out", *GRID, *given)
    assert code == 0
    assert "signal: channels Rac1, RhoA; " in said
    assert set(cd.open_study(tmp_path / "out").windows["channel"]) == {"Rac1", "RhoA"}


@pytest.fixture
def bar(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """Totals with which bars begin."""
    totals: list[object] = []
    begin = Progress.add_task

    def spy(self: Progress, *words: Any, **options: Any) -> Any:
        totals.append(options["total"])
        return begin(self, *words, **options)

    monkeypatch.setattr(Progress, "add_task", spy)
    return totals


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({}, "Stopped; what was done is kept (3 of 7 cells): run it again with --resume."),
        ({"again": "run it again"}, "Stopped; what was done is kept (3 of 7 cells): run it again."),
        ({"stopped": "Stopped; nothing was changed."}, "Stopped; nothing was changed."),
    ],
)
def test_what_is_said_when_stopped(
    capsys: pytest.CaptureFixture[str], options: dict[str, str], words: str
) -> None:
    def run_until_stopped() -> None:
        with progress_bar(True, "cells", **options) as progress:
            progress(3, 7)
            raise KeyboardInterrupt

    with pytest.raises(typer.Exit) as stop:
        run_until_stopped()
    assert stop.value.exit_code == 130
    assert capsys.readouterr().err == words + "\n"


def test_an_interrupt_of_compiled_code_is_an_interrupt() -> None:
    """Numba, while it takes its arguments, turns one into a SystemError."""

    def run_until(cause: BaseException | None) -> None:
        with progress_bar(True, "frames"):
            raise SystemError("returned a result with an exception set") from cause

    with pytest.raises(typer.Exit) as stop:
        run_until(KeyboardInterrupt())
    assert stop.value.exit_code == 130
    for other in (None, ValueError()):
        with pytest.raises(SystemError):
            run_until(other)


def test_only_a_run_can_be_complete_already(capsys: pytest.CaptureFixture[str], bar: list[object]) -> None:
    with progress_bar(False, "cells"):
        pass
    assert "this study is complete already" in capsys.readouterr().err
    for options in ({"stopped": "Stopped."}, {"total": 4}):
        with progress_bar(False, "cells", **options):
            pass
        assert "complete" not in capsys.readouterr().err
    assert bar == [None, None, 4]


def test_info_lists_versions(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(versions_of.PARTS, "umap", ("umap-learn", "no-such-package"))
    code, said, _ = run("info")
    assert code == 0
    versions = dict(line.split("\t") for line in said.splitlines())
    assert versions["numpy"] == np.__version__
    assert versions["cytodisk"]
    formats = "TIFF, OME-TIFF, ImageJ TIFF, PNG, OME-Zarr, GeoJSON, with extras ND2, CZI, LIF, ROI"
    assert versions["image formats"] == formats
    assert {"report", "link", "cluster"} <= set(versions)
    assert "no-such-package not installed: type pip install 'cytodisk[umap]'" in versions["umap"]


@pytest.mark.parametrize("name", ["masks.tif", "signal.ome.tif"])
@pytest.mark.slow
def test_demo_leaves_files_of_the_user_alone(run: Run, mask: Path, tmp_path: Path, name: str) -> None:
    theirs = tmp_path / "demo" / "input" / name
    theirs.parent.mkdir(parents=True)
    for mine in (mask.read_bytes(), b"mine"):
        theirs.write_bytes(mine)
        assert_refused(
            run("demo", "-o", tmp_path / "demo", "--overwrite"), name, "was not written by", "folder"
        )
        assert theirs.read_bytes() == mine


@pytest.mark.slow
def test_demo_once_and_again(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One run of the demo, shortened, then the same again, then another seed in the same folder."""
    monkeypatch.setattr("cytodisk.runs.demo_input.FRAMES", 40)
    demo = tmp_path / "demo"
    assert_refused(run("demo", "-o", demo, "--format", "jpg"), "--format must be png, pdf, svg", "got 'jpg'")
    code, said, _ = run("demo", "-o", demo, "--format", "pdf")
    assert code == 0
    assert said.count("no QC flags") == 1
    assert "40 of 40 frames of 1 cell mapped, each one to one" in said
    for line in (
        "boundary: after 39 frames",
        "edge velocity: error ",
        "signal: the sum over windows",
        "lag: ",
    ):
        assert line in said
    assert "follows the edge after 20 s, the measured one after 20 s" in said
    assert f"report: {demo / 'study' / 'report.html'}" in said
    study = cd.open_study(demo / "study")
    assert (study.provenance["length_unit"], study.provenance["velocity_unit"]) == ("µm", "µm/s")
    assert {path.suffix for path in (demo / "study").rglob("figures/*")} == {".pdf", ".gif"}
    before = content(demo)
    code, again, _ = run("demo", "-o", demo, "--quiet", "--format", "pdf")
    assert (code, again) == (0, "")
    after = content(demo)
    assert after == before
    assert_refused(run("demo", "-o", demo, "--seed", 1), "is of another demo", "--overwrite")
    assert content(demo) == after


def test_an_unknown_command(run: Run) -> None:
    assert_refused(run("unwrap"), "unwrap")


def test_the_program_runs_as_a_module(mask: Path, tmp_path: Path) -> None:
    program = [sys.executable, "-m", "cytodisk"]
    done = subprocess.run(
        [*program, "map", mask, "-o", tmp_path / "out", *GRID], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr.strip()) == (0, "")
    assert isinstance(cd.open_study(tmp_path / "out").cells, pd.DataFrame)
    refused = subprocess.run(
        [*program, "map", tmp_path / "gone.tif", "-o", tmp_path / "other"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: ")
    assert refused.stderr.count("\n") == 1


def test_a_mask_of_several_cells_is_refused_with_both_remedies(run: Run, tmp_path: Path) -> None:
    mask = np.zeros((30, 60), dtype=np.uint8)
    mask[5:25, 5:25] = mask[5:25, 35:50] = 1
    path = write(tmp_path / "mask.tif", mask)
    for command in (
        ("check", path),
        ("map", path, "-o", tmp_path / "no"),
        ("shapes", path, "-o", tmp_path / "no"),
    ):
        assert_refused(
            run(*command), "2 pieces, the second 75 % of the largest", "--label", "--fragments largest"
        )
    assert not (tmp_path / "no").exists()
    said = run("map", path, "-o", tmp_path / "largest", "--fragments", "largest", *GRID)[1]
    assert "perhaps more than one cell: a large fragment was dropped; if they are cells, number" in said
    assert run("map", path, "-o", tmp_path / "two", "--label", *GRID)[0] == 0
    assert cd.open_study(tmp_path / "two").cells["area_px"].tolist() == [400, 300]


def test_cells_with_qc_flags_are_named(run: Run, tmp_path: Path) -> None:
    mask = np.zeros((30, 60), dtype=np.uint8)
    mask[5:25, 5:25] = mask[5:10, 35:40] = 1
    path = write(tmp_path / "mask.tif", mask)
    assert (
        "1 small piece dropped (25 px): if they are cells, number the pieces (--label)"
        in run("check", path)[1]
    )
    said = run("map", path, "-o", tmp_path / "out", "--figures", 0)[1]
    assert "QC flag flagged masks: 1 cell may not be one whole cell (cell 0, frame 0: 1 small piece" in said
    assert "QC flag warnings" not in said
    assert "Look at the mask; correct the segmentation" in said


def test_a_signal_without_its_flag_and_no_folder_for_results(run: Run, mask: Path, tmp_path: Path) -> None:
    result = run("map", mask, "y.tif", "-o", tmp_path / "out")
    assert_refused(result, "y.tif")
    assert "--signal y.tif" in " ".join(result[2].replace("│", " ").split())
    assert "--signal" not in run("map", mask, "y.tif", "z.tif", "-o", tmp_path / "out")[2]
    assert_refused(run("map", mask), "as -o results/")
