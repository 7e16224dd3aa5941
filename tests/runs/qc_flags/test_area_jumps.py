"""Leaps of a mask's area, put into series that waver, grow or pulse by themselves."""

from pathlib import Path

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.cli import app
from cytodisk.runs.qc_flags.area_jumps import (
    area_steps,
    flickers,
    follows_one_cell,
    leaps,
    without_returns,
)

FRAMES = 60
AT = [12, 25, 41]


def growth(name: str, random: np.random.Generator) -> np.ndarray:
    """Change of ln(area) from frame to frame of a cell without fault."""
    noise = random.normal(0.0, 0.004, FRAMES - 1)
    time = np.arange(FRAMES - 1)
    drift = {
        "still": 0.0 * time,
        "growing": np.full(FRAMES - 1, 0.025),
        "pulsing": 0.02 * np.sin(2 * np.pi * time / 20),
        "a protrusion": np.where((time > 10) & (time < 30), 0.03, 0.0),
        "a wavering edge": 0.008 * random.normal(size=FRAMES - 1),
    }
    return drift[name] + noise


KINDS = ("still", "growing", "pulsing", "a protrusion", "a wavering edge")


@pytest.mark.parametrize("kind", KINDS)
def test_no_leap_in_cells_without_fault(kind: str) -> None:
    found = [leaps(growth(kind, np.random.default_rng(seed))) for seed in range(1000, 1050)]
    assert sum(map(bool, found)) <= 1


@pytest.mark.parametrize("comes_back", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_three_leaps_of_different_size_are_all_found(kind: str, comes_back: bool) -> None:
    missed = 0
    for seed in range(1000, 1020):
        step = growth(kind, np.random.default_rng(seed))
        for at, share in zip(AT, (0.08, 0.12, 0.16), strict=True):
            step[at] += np.log1p(share)
            if comes_back:
                step[at + 1] -= np.log1p(share)
        missed += len(set(AT) - set(leaps(step)))
    assert missed <= (12 if kind == "a wavering edge" else 0)


def test_leaps_close_together() -> None:
    step = growth("growing", np.random.default_rng(1000))
    for at, share in zip(range(20, 26), (0.1, -0.09, 0.12, 0.1, -0.15, -0.08), strict=True):
        step[at] = np.log1p(share)
    assert leaps(step) == [20, 21, 22, 23, 24, 25]


def test_a_mask_that_is_right_again_is_not_named() -> None:
    step = np.zeros(30)
    step[[5, 6]] = 0.12, -0.11  # one wrong mask
    step[[10, 14]] = -0.2, 0.2  # four wrong masks
    step[[20, 21]] = 0.1, 0.1  # a mask that takes two steps
    step[[25, 26]] = 0.2, -0.08  # only a part of it goes back
    found = leaps(step)
    assert found == [5, 6, 10, 14, 20, 21, 25, 26]
    assert without_returns(found, step) == [5, 10, 14, 20, 21, 25, 26]


def test_a_gap_and_a_short_movie() -> None:
    step = growth("still", np.random.default_rng(1000))
    step[20] = np.nan
    assert leaps(step) == []
    assert leaps(np.array([])) == leaps(np.array([np.nan])) == []
    assert leaps(np.array([0.0, 0.01, 0.2, 0.0])) == [2]


def flickering(wrong: str, frames: int, seed: int) -> np.ndarray:
    random = np.random.default_rng(seed)
    bad = np.arange(frames) % 2 == 0
    if wrong == "at random":
        bad = random.permutation(bad)
    size = 0.12 if wrong == "every second frame" else 0.2
    area = np.exp(random.normal(0.0, 0.01, frames) + 0.02 * np.arange(frames))
    return np.diff(np.log(area * np.where(bad, 1.0 + size, 1.0)))


@pytest.mark.parametrize(("wrong", "frames", "missed"), [("every second frame", 12, 0), ("at random", 40, 3)])
def test_flicker_does_not_explain_itself(wrong: str, frames: int, missed: int) -> None:
    steps = [flickering(wrong, frames, seed) for seed in range(1000, 1050)]
    assert sum(not flickers(step) or len(leaps(step)) < 0.3 * frames for step in steps) <= missed


@pytest.mark.parametrize("kind", ["random walk", "breathing", "growing"])
def test_no_flicker_in_cells_that_change_their_area_fast(kind: str) -> None:
    told = 0
    for seed in range(1000, 1050):
        random = np.random.default_rng(seed)
        change = {
            "random walk": random.normal(0.0, 0.06, 30),
            "breathing": 0.1 * np.cos(2.0 * np.pi * np.arange(30) / 6) + random.normal(0.0, 0.01, 30),
            "growing": np.full(30, 0.1) + random.normal(0.0, 0.01, 30),
        }[kind]
        told += flickers(change)
    assert told <= 3


def test_a_large_step_is_a_leap_in_a_restless_cell_too() -> None:
    step = 0.05 * np.sin(np.arange(40.0))
    step[20] = np.log(1.35)
    assert leaps(step) == [20]


@pytest.mark.parametrize(
    ("areas", "found"),
    [((100, 256), [0]), ((100, 130, 100), [0, 1]), ((100, 107), []), ((1, 1.12, 1.25), [])],
)
def test_two_or_three_frames(areas: tuple[float, ...], found: list[int]) -> None:
    assert leaps(np.diff(np.log(areas))) == found


def test_masks_of_one_cell_are_told_from_a_collection_of_cells() -> None:
    one = area_steps(np.arange(6), np.array([100.0, 101, 100, 190, 100, 102]))
    assert follows_one_cell(one)
    assert without_returns(leaps(one), one) == [2]
    assert not follows_one_cell(area_steps(np.arange(6), np.array([100.0, 300, 80, 500, 120, 260])))
    assert not follows_one_cell(area_steps(np.arange(3), np.array([100.0, 101, 190])))  # too few to tell
    assert np.isnan(area_steps(np.array([0, 2]), np.ones(2))).all()


def test_a_jump_is_told_by_map_and_check_as_by_movie(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    masks = np.zeros((6, 40, 60), dtype=np.uint8)
    masks[:, 10:30, 10:30] = 1
    masks[3, 10:30, 30:50] = 1  # a neighbour, merged for one frame
    tifffile.imwrite(tmp_path / "a.tif", masks, metadata={"axes": "TYX"})
    size = {"layers": 2, "sectors": 6}
    for study in (
        cd.run_map(tmp_path / "a.tif", tmp_path / "map", **size),
        cd.run_movie(tmp_path / "a.tif", tmp_path / "movie", **size),
    ):
        (flag,) = (flag for flag in cd.qc_flags(study) if flag.name == "area jumps")
        assert [(place.frame, place.other_frame, place.note) for place in flag.places] == [(3, 2, "+100%")]
        named = study.cells["qc_flags"].str.contains("area jumps")
        assert named.tolist() == [False, False, False, True, False, False]
    app(["check", str(tmp_path / "a.tif")], standalone_mode=False)
    assert "QC flag area jumps: the mask's area jumps (frames 2 and 3: +100%)" in capsys.readouterr().out
