"""Frames are read ahead in a thread."""

import threading
from typing import Any

import pytest

from cytodisk.napari.study_layers.prefetch import Prefetch


def test_frames_are_read_again_after_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[Any] = []
    monkeypatch.setattr(threading, "excepthook", told.append)
    read: list[int] = []

    def load(frame: int) -> None:
        if not told:
            raise OSError("the disk is gone")
        read.append(frame)

    frames = Prefetch(load, lambda: False)
    _all(frames, 0)
    _all(frames, 1)

    assert [one.exc_type for one in told] == [OSError]
    assert set(read) == {0, 2, 3}


def _all(frames: Prefetch, frame: int) -> None:
    frames.around(frame, 4)
    frames.wait(10.0)
