"""Memory that runs out ends a command in words, whatever asked for it."""

from pathlib import Path

import numpy as np
import pytest
from command_line import Run, assert_refused, write

import cytodisk as cd
from cytodisk.simulate import movie

SMALL = ("--layers", "2", "--sectors", "6", "--figures", "0")
WORDS = ("memory ran out", "--workers", "--resume")


@pytest.fixture
def masks(tmp_path: Path) -> Path:
    frames = movie("growing", frames=4, radius_px=10).masks.astype(np.uint8)
    return write(tmp_path / "masks.tif", frames, metadata={"axes": "TYX"})


def ran_out(words: str) -> object:
    def ask(*_: object, **__: object) -> None:
        raise MemoryError(*filter(None, [words]))

    return ask


@pytest.mark.parametrize("words", ["", "Unable to allocate 7.45 GiB for an array"])
@pytest.mark.parametrize(
    ("command", "place"),
    [
        ("map", "cytodisk.runs.map.map_study.map_study"),
        ("movie", "cytodisk.runs.movie.movie_inputs.list_tracks"),
        ("shapes", "cytodisk.runs.shapes.shape_study.shape_study"),
    ],
)
def test_a_run(
    run: Run,
    masks: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    command: str,
    place: str,
    words: str,
) -> None:
    monkeypatch.setattr(place, ran_out(words))
    grid = () if command == "shapes" else SMALL
    result = run(command, masks, "-o", tmp_path / "out", *grid)
    assert_refused(result, *WORDS, words)
    assert len(result[2].splitlines()) == 1


def test_what_reads_a_study(run: Run, masks: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = cd.run_movie(masks, tmp_path / "out", layers=2, sectors=6).path
    monkeypatch.setattr("cytodisk.pages.report.page.movie_page", ran_out(""))
    assert_refused(run("report", study), *WORDS)
    assert not list(study.glob("*.html"))
