from pathlib import Path

import numpy as np
import pytest
import tifffile
from numpy.testing import assert_array_equal

from cytodisk.errors import MaskError, ReadError
from cytodisk.images.file_parameters import Kind, KindParameters
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frames import open_frames
from cytodisk.images.tracks import CellTrack, MissingLabel, TrackMasks, list_tracks, read_frame
from cytodisk.images.what_it_is import look_at

SHAPE = 30, 60
PLACES = {1: np.s_[4:12, 4:12], 2: np.s_[15:25, 20:30], 3: np.s_[5:20, 40:55]}  # of cells that do not move


def drawn(*frames: dict[int, int]) -> np.ndarray:
    """Label images; each frame is the label of each cell that is in it."""
    stack = np.zeros((len(frames), *SHAPE), dtype=np.uint8)
    for image, labels in zip(stack, frames, strict=True):
        for cell, label in labels.items():
            image[PLACES[cell]] = label
    return stack


def written(tmp_path: Path, values: np.ndarray, damaged: int | None = None) -> FrameFile:
    path = tmp_path / "labels.tif"
    tifffile.imwrite(path, values, photometric="minisblack", compression="zlib")
    if damaged is not None:
        with tifffile.TiffFile(path) as tiff:
            start, count = tiff.pages[damaged].dataoffsets[0], tiff.pages[damaged].databytecounts[0]
        with path.open("r+b") as file:
            file.seek(start)
            file.write(b"\xff" * count)
    return open_frames(path)


def tracks_of(file: FrameFile, kind: Kind, link: bool) -> list[CellTrack]:
    return list_tracks(look_at(file, KindParameters(kind=kind)), link)


def spans(tracks: list[CellTrack]) -> list[tuple[int, int, int, int]]:
    return [(track.cell, track.label, track.first, track.last) for track in tracks]


LATE_EARLY_AND_GAP = drawn({1: 3}, {1: 3, 2: 7}, {2: 7}, {1: 3})


def test_a_stack_is_one_track_of_all_frames(tmp_path: Path) -> None:
    file = written(tmp_path, drawn({1: 1}, {}, {1: 255}))
    (track,) = tracks_of(file, "stack", link=False)
    assert spans([track]) == [(0, 1, 0, 2)]
    assert track.frames == range(3)
    for time in track.frames:
        frame = read_frame(file, time)
        assert track.mask_in(frame, time) is frame


def test_each_label_is_a_track_from_its_first_frame_to_its_last(tmp_path: Path) -> None:
    file = written(tmp_path, LATE_EARLY_AND_GAP)
    tracks = tracks_of(file, "labels", link=False)
    assert spans(tracks) == [(0, 3, 0, 3), (1, 7, 1, 2)]
    assert list(tracks[1].frames) == [1, 2]
    mask = tracks[0].mask_in(read_frame(file, 1), 1)
    assert_array_equal(mask, read_frame(file, 1) == 3)
    assert mask.sum() == 64


def test_a_label_that_is_missing_between_has_a_reason(tmp_path: Path) -> None:
    file = written(tmp_path, LATE_EARLY_AND_GAP)
    track = tracks_of(file, "labels", link=False)[0]
    fault = track.mask_in(read_frame(file, 2), 2)
    assert isinstance(fault, MissingLabel)
    assert str(fault) == "label 3 is not in frame 2"


def test_masks_of_a_track_are_those_of_its_frames(tmp_path: Path) -> None:
    file = written(tmp_path, drawn({}, {1: 3}, {2: 7}, {1: 3}))
    track = tracks_of(file, "labels", link=False)[0]
    masks = TrackMasks(file, track)
    assert len(masks) == 3
    first, gap, last = masks
    assert_array_equal(first, read_frame(file, 1) == 3)
    assert_array_equal(last, masks[2])
    assert isinstance(gap, MissingLabel)


def test_linked_labels_follow_the_cell(tmp_path: Path) -> None:
    file = written(tmp_path, drawn({1: 3, 2: 7}, {1: 7, 2: 3, 3: 1}, {1: 2, 2: 9, 3: 4}, {1: 1, 3: 2}))
    tracks = tracks_of(file, "labels", link=True)
    assert spans(tracks) == [(0, 1, 0, 3), (1, 2, 0, 2), (2, 3, 1, 3)]
    for track, place in zip(tracks, PLACES.values(), strict=True):
        for time in track.frames:
            mask = track.mask_in(read_frame(file, time), time)
            assert mask[place].all()
            assert mask.sum() == mask[place].size


def test_without_linking_the_same_labels_are_other_tracks(tmp_path: Path) -> None:
    file = written(tmp_path, drawn({1: 3, 2: 7}, {1: 7, 2: 3}))
    first, second = tracks_of(file, "labels", link=False)
    assert first.mask_in(read_frame(file, 1), 1)[PLACES[2]].all()
    assert second.mask_in(read_frame(file, 1), 1)[PLACES[1]].all()


@pytest.mark.parametrize("link", [False, True])
def test_a_damaged_frame_is_a_gap_with_its_own_reason(tmp_path: Path, link: bool) -> None:
    file = written(tmp_path, drawn({1: 3, 2: 7}, {1: 3, 2: 7}, {1: 3, 2: 7}), damaged=1)
    tracks = tracks_of(file, "labels", link=link)
    assert [(track.first, track.last) for track in tracks] == [(0, 2), (0, 2)]
    frame = read_frame(file, 1)
    assert isinstance(frame, ReadError)
    for track in tracks:
        assert track.mask_in(frame, 1) is frame
        assert track.mask_in(read_frame(file, 2), 2).any()


@pytest.mark.parametrize("link", [False, True])
def test_negative_labels_are_refused_with_their_frame(tmp_path: Path, link: bool) -> None:
    values = LATE_EARLY_AND_GAP.astype(np.int16)
    values[2, 0, 0] = -4
    with pytest.raises(MaskError, match=r"frame 2.*negative labels.*-4"):
        tracks_of(written(tmp_path, values), "labels", link=link)


@pytest.mark.parametrize("link", [False, True])
def test_labels_that_are_no_whole_numbers_are_refused(tmp_path: Path, link: bool) -> None:
    file = written(tmp_path, LATE_EARLY_AND_GAP.astype(np.float32) / 2)
    with pytest.raises(MaskError, match=r"whole numbers.*float32"):
        tracks_of(file, "labels", link=link)


@pytest.mark.parametrize("link", [False, True])
def test_a_file_without_any_label_is_refused(tmp_path: Path, link: bool) -> None:
    with pytest.raises(MaskError, match=r"labels\.tif.*3 frames"):
        tracks_of(written(tmp_path, drawn({}, {}, {})), "labels", link=link)
