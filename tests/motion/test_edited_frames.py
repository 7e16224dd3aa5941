"""The tracked boundary of a frame whose file somebody edited."""

from pathlib import Path

import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.errors import ReadError
from cytodisk.motion.frame_file import load_boundary, save_frame
from cytodisk.motion.mapped_frame import map_frame
from cytodisk.motion.tracking_parameters import MovieSettings


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    masks = simulate.movie("growing", frames=2, radius_px=10.0).masks
    first = map_frame(0, masks[0], None, MovieSettings())
    path = tmp_path_factory.mktemp("frames") / "frame.npz"
    save_frame(path, map_frame(1, masks[1], first, MovieSettings()))
    return path


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("track_s", np.full(256, np.nan), "track_s has nan"),
        ("track_s", np.zeros((3, 3)), r"track_s has shape \(3, 3\)"),
        ("track_s", np.arange(256.0), "track_s does not go once around the outline"),
        ("track_s", np.linspace(30.0, 0.0, 256), "track_s does not go once around the outline"),
        ("track_transforms", np.full((2, 3), np.inf), "track_transforms has inf"),
        ("track_transforms", np.zeros(3), r"track_transforms has shape \(3,\), not 2 × 3"),
        ("track_times", np.array([0, -1, 0]), "track_times has -1"),
        ("track_times", np.array([2**62, 0, 0]), "track_times has 4611686018427387904"),
        ("track_residual_px", np.array(-1.0), "track_residual_px has -1"),
        ("track_matched_s", np.zeros((3, 5)), "track_matched_s has shape"),
        ("track_restarted", np.array(1), "track_restarted has dtype int64, not text"),
    ],
)
def test_each_fault_names_file_and_array(
    saved: Path, tmp_path: Path, name: str, value: np.ndarray, words: str
) -> None:
    with np.load(saved) as file:
        np.savez(tmp_path / "edited.npz", **(dict(file) | {name: value}))
    with pytest.raises(ReadError, match=rf"edited\.npz: {words}.*cytodisk movie"):
        load_boundary(tmp_path / "edited.npz")


def test_as_it_was_written_it_is_read(saved: Path) -> None:
    assert load_boundary(saved).frame == 1
