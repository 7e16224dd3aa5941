"""What is wrong with files is printed once by every command, and stands in the study's warnings."""

import json
from pathlib import Path

import numpy as np
import pytest
import tifffile
from command_line import Run

from cytodisk.simulate import disk, movie

GRID = ("--layers", "2", "--sectors", "6")
FURLONGS = {"PhysicalSizeX": 0.2, "PhysicalSizeY": 0.2} | dict.fromkeys(
    ("PhysicalSizeXUnit", "PhysicalSizeYUnit"), "furlong"
)
WORDS = "Warning: m.ome.tif: its PhysicalSizeX is '0.2' 'furlong', which is no known unit of length"


def provenance(out: Path) -> dict[str, list[str]]:
    found: dict[str, list[str]] = json.loads((out / "provenance.json").read_text(encoding="utf-8"))
    return found


@pytest.mark.parametrize(
    "command",
    [
        ("check",),
        ("map", *GRID, "--figures", "0"),
        ("shapes",),
        ("compare-windows", *GRID, "--methods", "newton,edge"),
        ("movie", *GRID, "--figures", "0"),
        ("compare-windows", "--movie", *GRID, "--methods", "newton,edge"),
    ],
    ids=lambda command: " ".join(command[:2]),
)
def test_every_command_tells_notes_once_and_keeps_them(
    run: Run, tmp_path: Path, command: tuple[str, ...]
) -> None:
    of_movie = command[0] == "movie" or "--movie" in command
    masks = movie("growing", frames=2, radius_px=12.0).masks if of_movie else disk(12)
    metadata = {"axes": "TYX" if of_movie else "YX"} | FURLONGS
    tifffile.imwrite(tmp_path / "m.ome.tif", masks.astype(np.uint8), metadata=metadata)
    out = () if command[0] == "check" else ("-o", tmp_path / "out")
    code, _, error = run(command[0], tmp_path / "m.ome.tif", *command[1:], *out)
    assert (code, error.count(WORDS)) == (0, 1)
    if out:
        warnings = provenance(tmp_path / "out")["warnings"]
        assert sum(WORDS.removeprefix("Warning: ") in one for one in warnings) == 1
        _, _, error = run(command[0], tmp_path / "m.ome.tif", *command[1:], *out, "--overwrite", "-q")
        assert "Warning" not in error


def test_many_files_with_one_fault_have_one_note(run: Run, tmp_path: Path) -> None:
    for number in range(5):
        path = tmp_path / "in" / f"t{number}.ome.tif"
        path.parent.mkdir(exist_ok=True)
        tifffile.imwrite(path, disk(12).astype(np.uint8), metadata={"axes": "YX"} | FURLONGS)
    words = ": its PhysicalSizeX is '0.2' 'furlong'"
    for command in ("map", "movie"):
        out = tmp_path / command
        code, said, error = run(command, tmp_path / "in", *GRID, "--figures", "0", "-o", out)
        assert code == 0
        assert error.count(words) == 1
        assert f"t0.ome.tif, t1.ome.tif, t2.ome.tif and 2 more{words}" in error
    assert "5 files in natural order, t0.ome.tif to t4.ome.tif" in said


def test_a_pattern_without_quotes_says_what_to_do(run: Run, tmp_path: Path) -> None:
    code, _, error = run("movie", "t1.tif", "t2.tif", "-o", tmp_path)
    assert code == 2
    assert "put the pattern in quotes" in " ".join(error.replace("│", " ").split())


def test_a_scale_that_was_passed_counts_and_one_that_differs_is_told(run: Run, tmp_path: Path) -> None:
    metadata = {"axes": "TYX", "PhysicalSizeX": 0.153, "PhysicalSizeY": 0.153, "TimeIncrement": 5.0}
    masks = movie("growing", frames=2, radius_px=12.0).masks.astype(np.uint8)
    tifffile.imwrite(tmp_path / "m.ome.tif", masks, metadata=metadata)
    files = (tmp_path / "m.ome.tif", "-o", tmp_path / "out", *GRID, "--figures", "0")
    code, out, error = run("movie", *files, "--pixel-size", "0.2", "--frame-interval", "5.01")
    assert code == 0
    assert "pixel size: 0.2 µm" in out
    assert "m.ome.tif: it says that its pixel size is 0.153 µm; 0.2 µm counts, as you passed it" in error
    assert "frame interval is" not in error
