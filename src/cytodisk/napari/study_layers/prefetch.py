"""`Prefetch`: frames are read while another one is looked at."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from threading import Lock, Thread

from cytodisk.errors import CytodiskError

_AHEAD = 6  # frames that are read at once
_PAUSE = 2.0  # times as long as reading a frame takes, before one that is not needed soon


class Prefetch:
    """Reads frames in one thread: first those that the slider moves to, then the others, with pauses.

    Parameters
    ----------
    load : callable
        Reads what is shown of a frame, and keeps it.
    is_full : callable
        Whether what is kept has no room for more: then only the next frames are read.
    """

    def __init__(self, load: Callable[[int], None], is_full: Callable[[], bool]):
        self._load, self._is_full = load, is_full
        self._lock = Lock()
        self._soon: deque[int] = deque()
        self._later: deque[int] = deque()
        self._read: set[int] = set()
        self._last = -1
        self._thread: Thread | None = None

    def around(self, frame: int, n_frames: int) -> None:
        """Read the frames after this one, or before it if the slider moves back, and then the others.

        Parameters
        ----------
        frame, n_frames : int
        """
        step = -1 if frame < self._last else 1
        ahead = [k for k in range(frame + step, frame + step * (_AHEAD + 1), step) if 0 <= k < n_frames]
        others = [k % n_frames for k in range(frame + 1, frame + n_frames)]
        with self._lock:
            self._last = frame
            self._soon = deque(ahead)
            self._later = deque(k for k in others if k not in self._read)
            if self._thread is None:
                self._thread = Thread(target=self._work, name="cytodisk frames", daemon=True)
                self._thread.start()

    def stop(self) -> None:
        """Read nothing more."""
        with self._lock:
            self._soon.clear()
            self._later.clear()

    def wait(self, most_s: float = 60.0) -> None:
        """Come back when all is read."""
        if (thread := self._thread) is not None:
            thread.join(most_s)

    def _work(self) -> None:
        pause = 0.0
        while (frame := self._next(pause)) is not None:
            start = time.perf_counter()
            try:
                self._load(frame)
            except CytodiskError:
                pass  # it is told when the frame is shown
            except BaseException:
                with self._lock:
                    self._thread = None  # the next frame begins anew
                raise
            pause = _PAUSE * (time.perf_counter() - start)
            self._read.add(frame)

    def _next(self, pause: float) -> int | None:
        with self._lock:
            if self._soon:
                return self._soon.popleft()
        time.sleep(pause)
        with self._lock:
            if self._soon:
                return self._soon.popleft()
            if self._later and not self._is_full():
                return self._later.popleft()
            self._thread = None
            return None
