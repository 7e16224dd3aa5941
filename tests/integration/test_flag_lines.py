"""What commands print of QC flags, from files that have the faults."""

from pathlib import Path

import numpy as np
import tifffile
from command_line import Run

import cytodisk as cd
from cytodisk.runs.batch import compute_input
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag
from cytodisk.runs.told.flag_words import MOST_FLAGS, flag_lines, places_words

GRID = ("--layers", 2, "--sectors", 6, "--figures", 0)


def faulty_movie(folder: Path) -> tuple[Path, Path]:
    """A cell drawn at a quarter of its size, with a signal that is clipped in one channel and one frame."""
    truth = cd.simulate.movie("growing", seed=1000, frames=5, radius_px=14.0, speed_px=0.5)
    assert truth.signal is not None
    large = np.kron(truth.masks, np.ones((1, 4, 4), dtype=np.uint8)).astype(np.uint8)
    signal = np.kron(truth.signal.to_numpy(), np.ones((1, 1, 4, 4), dtype=np.uint16)).astype(np.float64)
    signal = np.random.default_rng(1000).poisson(signal).astype(np.float64)
    inside = signal[2, 1][large[2] > 0]
    signal[2, 1] = np.maximum(signal[2, 1] - np.quantile(inside, 0.75), 0.0)
    paths = folder / "masks.tif", folder / "signal.ome.tif"
    tifffile.imwrite(paths[0], large, metadata={"axes": "TYX"})
    names = {"axes": "TCYX", "Channel": {"Name": ["actin", "VASP"]}}
    tifffile.imwrite(paths[1], signal.astype(np.uint16), metadata=names, ome=True, photometric="minisblack")
    return paths


def test_a_movie_with_faults_says_them_with_their_remedies(run: Run, tmp_path: Path) -> None:
    masks, signal = faulty_movie(tmp_path)
    code, said, _ = run("movie", masks, "--signal", signal, "-o", tmp_path / "out", *GRID)
    assert code == 0
    lines = [line for line in said.splitlines() if line.startswith("QC flag ")]
    clipped, coarse = (
        next(line for line in lines if line.startswith(f"QC flag {name}:"))
        for name in ("clipped signal", "coarse outline")
    )
    assert "in 1 frame (cell 0, frame 2: VASP: 75% of the cell). Go back to the raw image" in clipped
    assert "in 5 frames (cell 0, frame 0: steps of 4 px;" in coarse
    assert "frame 4: steps of 4 px). Run with the masks as they were drawn" in coarse
    cells = cd.open_study(tmp_path / "out").cells
    assert cells["outline_step_px"].tolist() == [4] * 5
    assert cells["clipped_channel"].tolist() == ["", "", "VASP", "", ""]
    few = ("--max-lag", 1, "--min-pairs", 3, "--surrogates", 0, "--figures", 0)
    code, said, error = run("correlate", tmp_path / "out", "--signal", "VASP", *few)
    assert code == 0, error
    assert clipped in said


def test_a_map_says_them_and_gives_them_to_the_row_of_a_batch(run: Run, tmp_path: Path) -> None:
    masks, _ = faulty_movie(tmp_path)
    code, said, _ = run("map", masks, "-o", tmp_path / "map", *GRID)
    assert code == 0
    assert "QC flag coarse outline: the outline goes in large steps in 5 cells" in said
    assert compute_input._facts(cd.open_study(tmp_path / "map"))["flags"] == "coarse outline"


def test_a_long_note_that_comes_again_is_said_once() -> None:
    note = "the nucleus covers 100 % of the cell, or another long reason"
    places = [Place(0, 0, note), Place(1, 0, "odd"), Place(4, 0, note), Place(5, 0, "odd")]
    assert places_words(places, {}) == (
        f"cell 0, frame 0 and cell 4, frame 0: {note}; cell 1, frame 0: odd; cell 5, frame 0: odd"
    )


def test_many_flags_are_cut_short() -> None:
    places = tuple(Place(0, frame, "odd") for frame in range(10))
    names = [f"flag {number}" for number in range(MOST_FLAGS + 3)]
    flags = [QCFlag(name, "what", "meaning", "Do it.", places) for name in names]
    lines = list(flag_lines(flags, "see the page", {0: "a.tif"}))
    assert lines[0] == (
        "QC flag flag 0: what (cell 0 of a.tif, frame 0: odd; cell 0 of a.tif, frame 1: odd; "
        + "; ".join(f"cell 0 of a.tif, frame {frame}: odd" for frame in range(2, 8))
        + "; … 2 more). Do it."
    )
    assert lines[-1] == "… and 3 more QC flags: see the page"
    assert len(lines) == MOST_FLAGS + 1
    assert list(flag_lines([], "", {})) == ["no QC flags"]


def test_a_long_note_ends_between_words() -> None:
    words = places_words([Place(0, None, " ".join(["layer"] * 40))], {})
    assert words == f"cell 0: {' '.join(['layer'] * 26)} …"


def test_a_scale_that_makes_no_cell_is_told_by_every_command(run: Run, tmp_path: Path) -> None:
    masks = cd.simulate.movie("still", frames=2, radius_px=14.0).masks.astype(np.uint8)
    scale = {"axes": "TYX", "unit": "um", "finterval": 2.0}
    tifffile.imwrite(tmp_path / "m.tif", masks, imagej=True, resolution=(1 / 160, 1 / 160), metadata=scale)
    told = " mm wide, with pixels of 160 µm."
    commands = [("check",), ("shapes", "-o", tmp_path / "shapes"), ("map", "-o", tmp_path / "map", *GRID)]
    for command, *more in [*commands, ("movie", "-o", tmp_path / "movie", *GRID)]:
        code, said, error = run(command, tmp_path / "m.tif", *more)
        assert code == 0, error
        assert "implausible scale: cells are " in said
        assert told in said
        assert "--pixel-size" in said
