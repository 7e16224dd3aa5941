"""Files of frames that an earlier version wrote hold no match of the step."""

from pathlib import Path

import numpy as np
import pytest
from curves import circle, masks_of

from cytodisk.errors import EarlierVersionWarning
from cytodisk.motion.following import map_frames
from cytodisk.motion.frame_file import load_boundary, save_frame
from cytodisk.motion.tracking_parameters import MovieSettings

QUICK = {"method": "harmonic", "edge_length": 4.0}


def saved(folder: Path, **settings: object) -> list[Path]:
    masks = masks_of([circle(20.0), circle(21.0)], (121, 181))
    paths = []
    for result in map_frames(masks, MovieSettings.of(**QUICK, **settings)):
        assert result.mapped is not None
        paths.append(folder / f"{result.frame}.npz")
        save_frame(paths[-1], result.mapped)
    return paths


def without_match(path: Path) -> None:
    with np.load(path) as file:
        kept = {name: file[name] for name in file.files if name != "track_matched_s"}
    np.savez(path, **kept)


def test_a_frame_without_its_match_is_told(tmp_path: Path) -> None:
    first, second = saved(tmp_path)
    without_match(first)
    without_match(second)
    assert load_boundary(first).matched_s is None  # nothing to match: no word
    with pytest.warns(EarlierVersionWarning, match=r"earlier version.*run cytodisk movie again"):
        assert load_boundary(second).matched_s is None


def test_demons_keep_no_match_and_are_read_without_a_word(tmp_path: Path) -> None:
    pytest.importorskip("SimpleITK")
    _, second = saved(tmp_path, tracker="demons")
    assert load_boundary(second).matched_s is None
