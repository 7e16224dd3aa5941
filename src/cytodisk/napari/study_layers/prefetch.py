"""`Prefetch`: the next frames are read while the present one is looked at."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress

from cytodisk.errors import CytodiskError

_AHEAD = 6  # frames


class Prefetch:
    """Loads frames ahead in one thread.

    Parameters
    ----------
    load : callable
        Reads what is shown of a frame, and keeps it.
    """

    def __init__(self, load: Callable[[int], None]):
        self._load = load
        self._threads: ThreadPoolExecutor | None = None
        self._waiting: list[Future[None]] = []
        self._last = -1

    def around(self, frame: int, n_frames: int) -> None:
        """Read the frames after this one, or before it if the slider moves back, and no other ones.

        Parameters
        ----------
        frame, n_frames : int
        """
        step = -1 if frame < self._last else 1
        self._last = frame
        for one in self._waiting:
            one.cancel()
        wanted = [frame + step * k for k in range(1, _AHEAD + 1)]
        if self._threads is None:
            self._threads = ThreadPoolExecutor(1, "cytodisk frames")
        self._waiting = [self._threads.submit(self._one, k) for k in wanted if 0 <= k < n_frames]

    def _one(self, frame: int) -> None:
        with suppress(CytodiskError):  # it is told when the frame is shown
            self._load(frame)

    def stop(self) -> None:
        """Read nothing more."""
        if self._threads is not None:
            self._threads.shutdown(wait=False, cancel_futures=True)
            self._threads = None
