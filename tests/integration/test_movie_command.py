from pathlib import Path

import numpy as np
import pytest
import tifffile
from command_line import Run, assert_refused, content, write

import cytodisk as cd

GRID = ("--layers", 3, "--sectors", 8, "--figures", 0)
TABLES = ("windows.parquet", "edge.parquet", "consistency.parquet")
FRAMES = 5


def disks(frames: int = FRAMES) -> np.ndarray:
    """A disk that grows and moves."""
    y, x = np.indices((44, 60))
    time = np.arange(frames)[:, None, None]
    return ((y - 21.0) ** 2 + (x - 22.0 - 2.0 * time) ** 2 < (11.0 + 0.5 * time) ** 2).astype(np.uint8)


@pytest.fixture
def masks(tmp_path: Path) -> Path:
    return write(tmp_path / "masks.tif", disks(), compression="zlib")


@pytest.fixture
def signal(tmp_path: Path) -> Path:
    counts = np.random.default_rng(0).poisson(100, (FRAMES, 2, 44, 60)).astype(np.uint16)
    names = {"axes": "TCYX", "Channel": {"Name": ["Rac1", "RhoA"]}}
    return write(tmp_path / "signal.ome.tif", counts, metadata=names, ome=True, compression="zlib")


def damage(path: Path, page: int) -> None:
    with tifffile.TiffFile(path) as tiff:
        start, count = tiff.pages[page].dataoffsets[0], tiff.pages[page].databytecounts[0]
    with path.open("r+b") as file:
        file.seek(start)
        file.write(b"\xff" * count)


def test_a_movie_from_end_to_end(run: Run, masks: Path, signal: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    scale = ("--pixel-size", 0.5, "--frame-interval", 2)
    code, said, error = run("movie", masks, "--signal", signal, "-o", out, *GRID[:4], *scale)
    assert (code, error.strip()) == (0, "")
    for words in (
        "masks: masks of one cell, 5 frames of 44 × 60 pixels (TYX, uint8)",
        "signal: channels Rac1, RhoA; 5 frames (TCYX, uint16)",
        "pixel size: 0.5 µm",
        "frame interval: 2 s",
        "5 of 5 frames of 1 cell mapped, each one to one",
        "edge velocity: ",
        " µm/s, error of one sector ",
        "consecutive frames correlate by ",
        "empty windows 0",
        "Does one of both predict the other? cytodisk predict ",
        "Do waves run along the edge? cytodisk waves ",
        f"results: {out}",
    ):
        assert words in said
    names = {path.name for path in out.iterdir()}
    tables = {"cells.parquet", *TABLES}
    others = {"activity.zarr.zip", "columns.csv", "maps", "figures", "parameters.toml", "provenance.json"}
    assert names == tables | others
    beside = [path.relative_to(out).parts for path in out.rglob("*") if path.is_file()]
    assert len([parts for parts in beside if parts[0] not in ("maps", "figures")]) <= 12
    assert {path.name for path in (out / "maps").iterdir()} == {
        f"cell_00000_t{time:05d}.npz" for time in range(FRAMES)
    }
    suffixes = {path.suffix for path in (out / "figures").iterdir()}
    assert {".png", ".gif"} <= suffixes
    study = cd.open_study(out)
    assert study.cells["certificate_valid"].all()
    assert len(study.windows) == FRAMES * 2 * 3 * 8
    expected = 0.5 * 0.5 / 2  # half a pixel of 0.5 µm in 2 s
    inner = study.edge["velocity_cell_frame"].dropna()
    assert inner.mean() == pytest.approx(expected, rel=0.2)


def test_a_complete_movie_is_left_as_it_is(run: Run, masks: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert run("movie", masks, "-o", out, *GRID)[0] == 0
    assert_refused(
        run("movie", masks, "-o", out, *GRID), "holds a study: pass --resume to go on, --overwrite"
    )
    before = {path: path.stat().st_mtime_ns for path in out.rglob("*")}
    code, said, error = run("movie", masks, "-o", out, *GRID, "--resume")
    assert code == 0
    assert "5 of 5 frames of 1 cell mapped" in said
    assert "this study is complete already: nothing was run" in error
    assert {path: path.stat().st_mtime_ns for path in out.rglob("*")} == before


def test_a_fresh_run_without_figures_is_not_called_complete_already(
    run: Run, masks: Path, tmp_path: Path
) -> None:
    code, _, error = run("movie", masks, "-o", tmp_path / "out", *GRID)
    assert (code, error.strip()) == (0, "")


def test_quiet_says_nothing(run: Run, masks: Path, tmp_path: Path) -> None:
    assert run("movie", masks, "-o", tmp_path / "out", *GRID, "--quiet") == (0, "", "")


def test_flags_reach_the_parameters(run: Run, masks: Path, tmp_path: Path) -> None:
    flags = ("--tension", 0.5, "--no-registration", "--spacing", "radius", "--nan", "omit", "--align", 30)
    more = ("--inertia", 0.25, "--method", "harmonic", "--kind", "stack", "--no-link")
    assert run("movie", masks, "-o", tmp_path / "out", *GRID, *flags, *more)[0] == 0
    study = cd.open_study(tmp_path / "out")
    found = study.provenance["parameters"]
    for name, value in {
        "tension": 0.5,
        "registration": False,
        "spacing": "radius",
        "nan": "omit",
        "align": 30.0,
        "inertia": 0.25,
        "method": "harmonic",
        "kind": "stack",
        "layers": 3,
        "sectors": 8,
        "link": False,
    }.items():
        assert found[name] == value, name


def test_names_of_channels(run: Run, masks: Path, signal: Path, tmp_path: Path) -> None:
    common = ("movie", masks, "-o", tmp_path / "out", *GRID)
    for names, words in (
        ("a", "channels must be as many names as"),
        ("a,", "channels: every channel needs a name that can be printed, got ('a', '')"),
        ("a,velocity", "channels: velocity is the name of the edge's velocity"),
    ):
        assert_refused(run(*common, "--signal", signal, "--channels", names), words)
    assert_refused(run(*common, "--channels", "a,b"), "there is no signal: pass it as --signal")
    assert not (tmp_path / "out").exists()
    code, said, _ = run(*common, "--signal", signal, "--channels", "actin, myosin")
    assert code == 0
    assert "signal: channels actin, myosin; 5 frames" in said
    kept = ("--parameters", tmp_path / "out" / "parameters.toml")
    again = run("movie", masks, "--signal", signal, "-o", tmp_path / "again", "--figures", 0, *kept)
    assert again[0] == 0
    for name in ("out", "again"):
        study = cd.open_study(tmp_path / name)
        assert study.activity(0)["channel"].to_numpy().tolist() == ["actin", "myosin"]


def test_a_run_that_is_stopped_says_how_to_go_on(
    run: Run, masks: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    out = tmp_path / "out"
    with monkeypatch.context() as patch:
        patch.setattr("cytodisk.pages.movie_pages.write_movie_figures", stop)
        code, _, error = run("movie", masks, "-o", out, *GRID[:4])
    assert code == 130
    assert "what was done is kept (0 of 1 drawings): run it again with --resume." in error
    assert run("movie", masks, "-o", out, *GRID[:4], "--resume")[0] == 0
    assert any((out / "figures").glob("*.gif"))


def test_without_registration_nothing_is_taken_out(run: Run, masks: Path, tmp_path: Path) -> None:
    """The disk moves by 2 px a frame; registration finds that, and is switched off by its flag."""
    for name, flags in (("with", ()), ("without", ("--no-registration",))):
        assert run("movie", masks, "-o", tmp_path / name, *GRID, *flags)[0] == 0
    with_it, without = (cd.open_study(tmp_path / name).cells for name in ("with", "without"))
    assert with_it["registration_shift_x"].iloc[-1] == pytest.approx(-8.0, abs=0.5)
    assert (without["registration_shift_x"] == 0).all()
    assert (without["registration_angle"] == 0).all()


def test_layers_by_depth(run: Run, masks: Path, tmp_path: Path) -> None:
    flags = ("--sectors", 8, "--figures", 0, "--depth-um", 0.7)
    code, said, _ = run("movie", masks, "-o", tmp_path / "out", *flags, "--pixel-size", 0.5)
    assert code == 0
    assert "windows: layers 0–0.7 µm deep and the rest inside, sectors 8" in said
    assert cd.open_study(tmp_path / "out").provenance["layers"] == 2
    assert_refused(run("movie", masks, "-o", tmp_path / "other", *flags), "(--depth-um) needs the pixel size")
    both = run("movie", masks, "-o", tmp_path / "other", *flags, "--layers", 3, "--pixel-size", 0.5)
    assert_refused(both, "--layers and --depth-um exclude each other")
    assert not (tmp_path / "other").exists()


def test_given_layers_overrule_the_depth_of_a_parameters_file(run: Run, masks: Path, tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text("depth_um = 0.7\npixel_size_um = 0.5\nsectors = 8\n")
    common = ("movie", masks, "-o", tmp_path / "out", "--figures", 0, "--parameters", tmp_path / "p.toml")
    assert run(*common, "--layers", 3)[0] == 0
    assert set(cd.open_study(tmp_path / "out").windows["layer"]) == {0, 1, 2}


def test_parameters_of_a_study_reproduce_it(run: Run, masks: Path, signal: Path, tmp_path: Path) -> None:
    flags = ("--depth-um", "0.9,2", "--sectors", 7, "--pixel-size", 0.5, "--frame-interval", 3)
    common = ("movie", masks, "--signal", signal, "--figures", 0)
    first, second = tmp_path / "first", tmp_path / "second"
    assert run(*common, "-o", first, *flags, "--no-registration")[0] == 0
    assert run(*common, "-o", second, "--parameters", first / "parameters.toml")[0] == 0
    for name in (*TABLES, "parameters.toml"):
        assert (first / name).read_bytes() == (second / name).read_bytes()


@pytest.mark.parametrize("value", [0, -5])
@pytest.mark.parametrize("flag", ["--frame-interval", "--pixel-size"])
def test_a_scale_that_is_not_above_0(run: Run, masks: Path, tmp_path: Path, flag: str, value: int) -> None:
    result = run("movie", masks, "-o", tmp_path / "out", flag, value)
    assert_refused(result, f"{flag} must be a number from 0.000001 to 1000000, got {float(value)}")
    assert not (tmp_path / "out").exists()


def test_faults_of_the_input_end_in_a_message(run: Run, masks: Path, signal: Path, tmp_path: Path) -> None:
    short = write(tmp_path / "short.tif", disks()[:4])
    single = write(tmp_path / "single.tif", disks()[0])
    for arguments, words in (
        ((tmp_path / "gone.tif",), "gone.tif does not exist: check the path"),
        ((single,), "hold one frame: a movie has two at least; use cytodisk map"),
        ((short, "--signal", signal), "the masks have 4 frames: pass as many"),
        ((masks, "--tracker", "snake"), "--tracker must be one of matching, demons, got 'snake'"),
        ((masks, "--kind", "mask"), "--kind must be one of auto, stack, labels, got 'mask'"),
        ((masks, "--workers", 0), "workers must be a whole number from 1 to 1024, got 0"),
        ((masks, "--sectors", 0), "--sectors must be a whole number from 1 to 100000, got 0"),
        ((masks, "--resume", "--overwrite"), "--resume and --overwrite exclude each other"),
        (("gone.tif", "--resume", "--overwrite"), "--resume and --overwrite exclude each other"),
    ):
        assert_refused(run("movie", *arguments, "-o", tmp_path / "out"), words)
        assert not (tmp_path / "out").exists()


def test_an_output_folder_that_is_taken(run: Run, masks: Path, tmp_path: Path) -> None:
    before = content(tmp_path)
    assert_refused(
        run("movie", masks, "-o", tmp_path), "is not empty and holds no study: pass another folder"
    )
    assert_refused(run("movie", masks, "-o", masks), f"output {masks} is a file: pass a folder")
    assert content(tmp_path) == before


@pytest.mark.parametrize("figures", [0, 1])
def test_a_movie_of_empty_frames(run: Run, tmp_path: Path, figures: int) -> None:
    path = write(tmp_path / "masks.tif", np.zeros((3, 30, 30), dtype=np.uint8))
    result = run("movie", path, "-o", tmp_path / "out", *GRID[:4], "--figures", figures)
    assert_refused(result, "no frame could be mapped: mask of shape (30, 30) is empty", "frame 2 refused")
    assert cd.open_study(tmp_path / "out").cells["status"].tolist() == ["refused"] * 3


@pytest.mark.parametrize("which", ["masks", "signal"])
@pytest.mark.slow
def test_a_damaged_frame(run: Run, masks: Path, signal: Path, tmp_path: Path, which: str) -> None:
    damage(*((masks, 2) if which == "masks" else (signal, 4)))
    out = tmp_path / "out"
    result = run("movie", masks, "--signal", signal, "-o", out, *GRID[:4], "--figures", 1)
    assert_refused(result, "cell 0, frame 2 unreadable", "damaged frames of the input: 1; all others are in")
    assert cd.open_study(out).cells["status"].tolist() == ["ok", "ok", "unreadable", "ok", "ok"]
    assert any((out / "figures").iterdir())


def test_a_refused_frame_is_named_and_the_run_ends_well(run: Run, tmp_path: Path) -> None:
    values = disks()
    values[2] = 0
    values[4, 2:4, 2:4] = 1
    code, said, error = run("movie", write(tmp_path / "m.tif", values), "-o", tmp_path / "out", *GRID)
    assert code == 0
    assert "4 of 5 frames of 1 cell mapped, each one to one" in said
    assert "cell 0, frame 2 refused: mask of shape (44, 60) is empty" in error


def test_a_cell_on_the_border_is_said(run: Run, tmp_path: Path) -> None:
    path = write(tmp_path / "m.tif", disks()[:, 12:])
    code, said, _ = run("movie", path, "-o", tmp_path / "out", *GRID)
    assert code == 0
    assert "QC flag image border: the cell touches the image's border in 5 frames" in said
    assert "Leave the sectors at the border out" in said


def test_labels_that_change_are_linked(run: Run, tmp_path: Path) -> None:
    values = disks() * np.array([3, 9, 4, 1, 2], dtype=np.uint8)[:, None, None]
    values[:, 36:42, 2:8] = np.array([7, 1, 2, 5, 6], dtype=np.uint8)[:, None, None]
    path = write(tmp_path / "labels.tif", values)
    code, said, _ = run("movie", path, "-o", tmp_path / "out", *GRID[:4], "--figures", -1, "--link")
    assert code == 0
    drawn = {file.name for file in (tmp_path / "out" / "figures").iterdir()}
    assert {"cell_00000.gif", "cell_00001.gif"} <= drawn
    assert "labels of 2 cells, linked by overlap" in said
    assert "10 of 10 frames of 2 cells mapped" in said
