from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError, SignalError, StudyError
from cytodisk.pages import animation
from cytodisk.pages.animation import write_animation
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows, polar_windows

FIELD = (0.0, 49.0, 0.0, 89.0)


def _colours(path: Path, frame: int = 0) -> FloatArray:
    with Image.open(path) as movie:
        movie.seek(frame)
        return np.asarray(movie.convert("RGB"), dtype=np.float64)


def _count(path: Path) -> int:
    with Image.open(path) as movie:
        return int(getattr(movie, "n_frames", 1))


def test_frames_are_all_there(tmp_path: Path, windows: CellWindows, image: FloatArray) -> None:
    seen: list[int] = []
    frames = ((windows, image, k) for k in range(4))
    path = write_animation(tmp_path / "a.gif", frames, extent_yx=FIELD, fps=4, progress=seen.append)
    assert list(tmp_path.iterdir()) == [path]
    assert seen == [1, 2, 3, 4]
    assert _count(path) == 4
    with Image.open(path) as movie:
        assert movie.info["duration"] == 250
        assert movie.info["loop"] == 0
        assert movie.size == (552, 283)
    assert path.stat().st_size < 4 * 50_000


def test_colours_do_not_change_with_the_frame(
    tmp_path: Path, windows: CellWindows, image: FloatArray
) -> None:
    frames = [(windows, signal, 0) for signal in (image, image.clip(max=400.0), image)]
    path = write_animation(tmp_path / "a.gif", [*frames, (windows, image, 3)], extent_yx=FIELD)
    bar = np.s_[60:220, 470:]
    assert np.array_equal(_colours(path, 0)[bar], _colours(path, 1)[bar])
    assert not np.array_equal(_colours(path, 0), _colours(path, 1))
    assert np.array_equal(_colours(path, 0), _colours(path, 2))
    assert (_colours(path)[0, 0] == 255).all()


def test_frames_without_signal(tmp_path: Path, windows: CellWindows, image: FloatArray) -> None:
    frames = [(windows, None, 0), (windows, image, 1), (windows, None, 2)]
    path = write_animation(tmp_path / "a.gif", frames, extent_yx=FIELD, scale=Scale(frame_interval_s=5.0))
    assert _count(path) == 3
    viridis = np.array([68, 1, 84])
    near = [(np.abs(_colours(path, k) - viridis).max(axis=-1) < 6).any() for k in range(3)]
    assert near == [False, True, True]  # the colour bar stays


def test_a_long_movie_is_thinned(
    tmp_path: Path, windows: CellWindows, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(animation, "MOST_FRAMES", 4)
    stamps: list[int] = []
    monkeypatch.setattr(animation, "time_stamp", lambda index, _: stamps.append(index) or str(index))

    def frames() -> Iterator[tuple[CellWindows, Any, int]]:
        for index in range(11):
            yield windows, None, index

    path = write_animation(tmp_path / "a.gif", frames(), extent_yx=FIELD)
    assert stamps == [0, 1, 2, 3, 4, 6, 8]
    assert _count(path) == 3  # 0, 4 and 8


def test_animation_refuses(tmp_path: Path, windows: CellWindows, monkeypatch: pytest.MonkeyPatch) -> None:
    frame = (windows, None, 0)
    monkeypatch.setenv("PATH", "")
    other = polar_windows(2, 5).on(windows.disk)
    for name, frames, options, message in (
        ("a.avi", [frame], {}, "path must end in .gif or .mp4"),
        ("a.mp4", [frame], {}, "needs ffmpeg, which is not installed"),
        ("a.gif", [frame], {"fps": 0}, "fps must be a number above 0"),
        ("a.gif", [], {}, "frames is empty"),
        ("a.gif", [frame, (other, None, 1)], {}, "frames have the grids"),
    ):
        with pytest.raises(ParameterError, match=message):
            write_animation(tmp_path / name, frames, extent_yx=FIELD, **options)
    with pytest.raises(SignalError, match=r"signal has shape \(3, 3\)"):
        write_animation(tmp_path / "a.gif", [(windows, np.ones((3, 3)), 0)], extent_yx=FIELD)
    with pytest.raises(StudyError, match="cannot write"):
        write_animation(tmp_path / "missing" / "a.gif", [frame], extent_yx=FIELD)
    assert not list(tmp_path.iterdir())
