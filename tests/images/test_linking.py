import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import tifffile
from hypothesis import given
from hypothesis import strategies as st

from cytodisk.errors import CytodiskError, MaskError, MissingPartError, ParameterError
from cytodisk.images.linking import link_labels

Disk = tuple[float, float, float]  # row, column, radius


def drawn(*disks: Disk | None, shape: tuple[int, int] = (80, 120)) -> np.ndarray:
    """Label image of disks, numbered from 1 in their order; None leaves a number out."""
    row, column = np.indices(shape)
    labels = np.zeros(shape, dtype=np.uint16)
    for number, disk in enumerate(disks, start=1):
        if disk is not None:
            labels[np.hypot(row - disk[0], column - disk[1]) <= disk[2]] = number
    return labels


def renumbered(frame: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, dict[int, int]]:
    """The frame with other labels, and {new label: old label}."""
    old = np.unique(frame[frame > 0])
    new = rng.choice(np.arange(1, 60_000), size=old.size, replace=False)
    table = np.zeros(int(frame.max(initial=0)) + 1, dtype=np.uint16)
    table[old] = new
    return table[frame], dict(zip(new.tolist(), old.tolist(), strict=True))


def moving_disks(n_frames: int = 12) -> list[np.ndarray]:
    return [
        drawn((20 + t, 20 + 2 * t, 9), (60 - t, 30, 8), (40, 100 - 2 * t, 7), (70, 80, 5))
        for t in range(n_frames)
    ]


@given(seed=st.integers(0, 2**32 - 1))
def test_moving_disks_are_recovered_from_any_numbering(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shuffled, old = zip(*(renumbered(frame, rng) for frame in moving_disks()), strict=True)
    found = link_labels(shuffled)
    track_of: dict[int, set[int]] = {}
    for tracks, names in zip(found, old, strict=True):
        assert tracks.keys() == names.keys()
        for label, track in tracks.items():
            track_of.setdefault(names[label], set()).add(track)
    assert sorted(track for tracks in track_of.values() for track in tracks) == [1, 2, 3, 4]


def test_tracks_are_numbered_by_first_frame_then_label() -> None:
    first, late = (20, 20, 8), (60, 100, 8)
    frames = [drawn(first), drawn(late, first), drawn(late, first, (20, 100, 8))]
    assert link_labels(frames) == [{1: 1}, {1: 2, 2: 1}, {1: 2, 2: 1, 3: 3}]


@pytest.mark.parametrize(
    ("missing", "largest_gap", "track"), [(0, 0, 1), (1, 0, 2), (1, 1, 1), (1, 2, 1), (2, 2, 1), (3, 2, 2)]
)
@pytest.mark.parametrize("other", [None, (60, 100, 8)])
def test_a_gap_is_bridged_up_to_its_largest_length(
    missing: int, largest_gap: int, track: int, other: Disk | None
) -> None:
    cell = (20, 20, 8)
    frames = [drawn(other, cell), *[drawn(other)] * missing, drawn(other, cell)]
    found = link_labels(frames, largest_gap=largest_gap)
    others = 0 if other is None else 1
    assert (found[0][2], found[-1][2]) == (1 + others, track + others)


def test_a_cell_in_between_is_not_passed_over() -> None:
    there, aside = drawn((40, 40, 10)), drawn((40, 48, 10))  # IoU 0.34, but 1 with the frame after the next
    assert link_labels([there, aside] * 4) == [{1: 1}] * 8


def test_a_division_goes_on_in_the_larger_overlap_and_starts_one_track() -> None:
    mother = drawn((40, 40, 12))
    daughters = drawn((40, 32, 6), (40, 47, 8))
    assert link_labels([mother, mother, daughters, daughters]) == [{1: 1}] * 2 + [{1: 2, 2: 1}] * 2


def test_a_strict_overlap_starts_two_tracks_at_a_division() -> None:
    mother = drawn((40, 40, 12))
    daughters = np.where(np.arange(120) < 40, mother, 2 * mother)
    found = link_labels([mother, daughters, daughters], least_overlap=0.55)
    assert found == [{1: 1}, {1: 2, 2: 3}, {1: 2, 2: 3}]


def test_touching_cells_end_one_track_and_take_it_up_when_they_part() -> None:
    apart = drawn((40, 30, 10), (40, 49, 8))
    together = (apart > 0).astype(np.uint16)
    assert link_labels([apart, together, together, apart]) == [{1: 1, 2: 2}, {1: 1}, {1: 1}, {1: 1, 2: 2}]


def test_a_fragment_does_not_take_the_track() -> None:
    whole = drawn((40, 40, 12))
    broken = drawn((40, 51, 1), (40, 40, 9))  # the fragment, with the lower label, lies all within the cell
    assert link_labels([whole, broken, whole]) == [{1: 1}, {1: 2, 2: 1}, {1: 1}]


def test_one_large_overlap_wins_over_two_small_ones() -> None:
    """The right cell is lost and one on the left is new: the one between does not give way to them."""
    earlier, later = np.zeros((2, 5, 60), dtype=np.uint8)
    earlier[:, 10:30], earlier[:, 35:55] = 1, 2
    later[:, 0:13], later[:, 18:38] = 2, 1  # IoU 0.43 of 1 and 1, 0.1 of 1 and 2, 0.08 of 2 and 1
    assert link_labels([earlier, later], least_overlap=0.05) == [{1: 1, 2: 2}, {1: 1, 2: 3}]


def test_a_fast_cell_among_slow_ones_is_linked() -> None:
    """What is linked depends on the cells' own overlap, not on the distribution of all."""
    earlier, later = np.zeros((2, 12, 40), dtype=np.uint8)
    for cell in range(1, 13):
        step = 15 if cell == 12 else 8  # IoU 0.14 and 0.43
        earlier[cell - 1, :20] = cell
        later[cell - 1, step : step + 20] = cell
    same = {cell: cell for cell in range(1, 13)}
    assert link_labels([earlier, later]) == [same, same]


def test_cells_that_cross_without_overlap_stay_apart() -> None:
    frames = [drawn((20, 20 + 5 * t, 8), (45, 100 - 5 * t, 8)) for t in range(16)]
    swapped = [frame if t % 2 else np.choose(frame, [0, 2, 1]) for t, frame in enumerate(frames)]
    assert link_labels(swapped) == [{1: 2, 2: 1} if t % 2 else {1: 1, 2: 2} for t in range(16)]


def test_least_overlap_is_inclusive() -> None:
    one, other = np.zeros((2, 4, 12), dtype=np.int64)
    one[:, 0:6], other[:, 4:10] = 1, 1  # 2 columns of 10
    assert link_labels([one, other], least_overlap=0.2) == [{1: 1}, {1: 1}]
    assert link_labels([one, other], least_overlap=0.21) == [{1: 1}, {1: 2}]


@pytest.mark.parametrize("dtype", [np.uint8, np.int16, np.uint32, np.int64, np.uint64])
def test_any_integer_labels_are_kept_exactly(dtype: type) -> None:
    high = int(np.iinfo(dtype).max)
    frame = drawn((20, 20, 8), (60, 100, 8)).astype(dtype)
    frame[frame == 1] = high - 1
    frame[frame == 2] = high
    assert link_labels([frame, frame]) == [{high - 1: 1, high: 2}] * 2


def test_frames_without_background() -> None:
    full = np.full((5, 6), 3)
    assert link_labels([full, full + 4]) == [{3: 1}, {7: 1}]


@pytest.mark.parametrize("filled", [(), (0,), (3,), (1, 2)])
def test_empty_frames_have_no_tracks(filled: tuple[int, ...]) -> None:
    frames = [drawn((40, 40, 8)) if t in filled else drawn() for t in range(4)]
    assert link_labels(frames) == [{1: 1} if t in filled else {} for t in range(4)]


def test_no_frames() -> None:
    assert link_labels([]) == []


def test_frames_are_taken_one_by_one() -> None:
    """Each frame is overwritten by the next, as a reader with one buffer would."""
    buffer = drawn()

    def frames() -> Iterator[np.ndarray]:
        for frame in moving_disks():
            buffer[:] = frame
            yield buffer

    assert link_labels(frames()) == [{1: 1, 2: 2, 3: 3, 4: 4}] * 12


@pytest.mark.parametrize(
    ("frames", "message"),
    [
        ([drawn(), drawn().astype(float)], "frame 1 has dtype float64: number the cells"),
        ([drawn() > 0], "frame 0 has dtype bool"),
        (drawn(), r"2D label images, frame 0 has shape \(120,\): pass a stack"),
        ([drawn(), drawn()[:40]], r"frame 1 has \(40, 120\) after \(80, 120\): crop or pad"),
        ([drawn() - np.int32(2)], r"frame 0 has negative labels \(down to -2\): set what is no cell to 0"),
    ],
)
def test_frames_that_are_no_label_images(frames: list[np.ndarray], message: str) -> None:
    with pytest.raises(MaskError, match=message):
        link_labels(frames)


@pytest.mark.parametrize("least_overlap", [0, -0.1, 1.01, float("nan")])
def test_least_overlap_out_of_range(least_overlap: float) -> None:
    with pytest.raises(ParameterError, match="least_overlap must"):
        link_labels([], least_overlap=least_overlap)


@pytest.mark.parametrize("largest_gap", [-1, 1.5, float("nan")])
def test_largest_gap_out_of_range(largest_gap: int) -> None:
    with pytest.raises(ParameterError, match="largest_gap must be a whole number of frames"):
        link_labels([], largest_gap=largest_gap)


def test_without_laptrack(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "laptrack", None)
    with pytest.raises(MissingPartError, match=r"type pip install 'cytodisk\[link\]'") as caught:
        link_labels([])
    assert isinstance(caught.value, ImportError)
    assert isinstance(caught.value, CytodiskError)


def test_a_real_movie_with_shuffled_labels(data_dir: Path) -> None:
    file = data_dir / "label_movies" / "PhC-C2DH-U373_01_ST_SEG_labels.tif"
    if not file.is_file():
        pytest.skip(f"real data is absent: {file} is not in the folder")
    rng = np.random.default_rng(0)
    shuffled, old = zip(*(renumbered(frame, rng) for frame in tifffile.imread(file)), strict=True)
    true_tracks = [
        {names[label]: track for label, track in tracks.items()}
        for tracks, names in zip(link_labels(iter(shuffled)), old, strict=True)
    ]
    kept = [
        earlier[cell] == later[cell]
        for earlier, later in pairwise(true_tracks)
        for cell in earlier.keys() & later.keys()
    ]
    assert len(kept) > 700
    assert np.mean(kept) >= 0.95
