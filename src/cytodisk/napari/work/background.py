"""Run a function of the library in a thread, so that the viewer can be used meanwhile."""

from __future__ import annotations

import threading
import time as clock
from collections.abc import Callable
from typing import Any, TypeVar

from qtpy.QtCore import QCoreApplication, QObject, Signal

from cytodisk.errors import CytodiskError
from cytodisk.napari.viewer_parts import show_error
from cytodisk.napari.work.work_bar import WorkBar
from cytodisk.runs.told.speed_words import speed_words

CANCELLED = "Cancelled: nothing was kept."
_SECONDS_BETWEEN = 0.1  # of what is told to the bar

Result = TypeVar("Result")


class _Cancelled(BaseException):
    """Raised within the work by what reports its progress."""


class Reporter:
    """What work reports its progress to: called with (done, in all), as the runs of the library do.

    Where work was cancelled each call ends it.

    Parameters
    ----------
    told : Signal
        Takes (done, in all, unit, how fast); -1 for a number that is not known.
    unit : str
        What is counted, in the plural.
    """

    def __init__(self, told: Any, unit: str):
        self._told, self._cancelled = told, threading.Event()
        self._unit = unit
        self._first: int | None = None
        self._began = self._last = 0.0

    def __call__(self, done: int, total: int) -> None:
        self.check()
        now = clock.monotonic()
        if self._first is None:
            self._first, self._began = done, now
        new = done - self._first
        if done < total and now - self._last < _SECONDS_BETWEEN:
            return
        self._last = now
        passed = max(now - self._began, 1e-9)
        left = list(speed_words(new / passed, self._unit, new, total - done))[-1:] if total > done else []
        self._told.emit(done, total, self._unit, "".join(words for words in left if words.endswith("left")))

    def stage(self, words: str, unit: str = "") -> None:
        """Say that another kind of work begins, which is counted by itself."""
        self.check()
        self._unit = unit or self._unit
        self._first, self._last = None, 0.0
        self._told.emit(-1, -1, "", words)

    def cancel(self) -> None:
        """End the work at its next report."""
        self._cancelled.set()

    def check(self) -> None:
        """End the work here if it was cancelled."""
        if self._cancelled.is_set():
            raise _Cancelled


class Work(QObject):
    """Work that is being done.

    Attributes
    ----------
    done : bool
        Whether it ended, in whatever way.
    """

    _told = Signal(int, int, str, str)
    _ended = Signal()  # without the result: what Signal(object) carries into another thread loses a reference

    def __init__(self, bar: WorkBar, unit: str, finish: Callable[[Any], None], leave: Callable[[], None]):
        super().__init__()
        self._bar: WorkBar | None = bar
        self._finish, self._leave = finish, leave
        self.reporter = Reporter(self._told, unit)
        self.done = False
        self._result: Any = None
        self._fault: BaseException | None = None
        self._told.connect(self._show)
        self._ended.connect(self._end)
        bar.cancel_wanted.connect(self.cancel)
        bar.destroyed.connect(self._lose_bar)
        QCoreApplication.instance().aboutToQuit.connect(self.cancel)

    def start(self, function: Callable[[Reporter], Any]) -> None:
        """Begin in a thread."""
        self.thread = threading.Thread(target=self._run, args=(function,), name="cytodisk")
        self.thread.start()

    def cancel(self) -> None:
        """End it at its next report."""
        self.reporter.cancel()

    def _run(self, function: Callable[[Reporter], Any]) -> None:
        try:
            self._result = function(self.reporter)
        except BaseException as error:  # noqa: BLE001  told or raised again in the thread of the viewer
            self._fault = error
        self._ended.emit()

    def _show(self, done: int, total: int, unit: str, words: str) -> None:
        if self._bar is None:
            return
        if done < 0:
            self._bar.begin(words)
        else:
            self._bar.show_done(done, total, unit, words)

    def _lose_bar(self) -> None:
        self._bar = None
        self.cancel()

    def _end(self) -> None:
        self.done = True
        result, fault = self._result, self._fault
        self._result = self._fault = None
        _RUNNING.discard(self)
        QCoreApplication.instance().aboutToQuit.disconnect(self.cancel)
        if self._bar is None:  # its widgets are gone, nobody waits for the result
            if fault is not None and not isinstance(fault, CytodiskError | _Cancelled):
                raise fault
            return
        self._bar.cancel_wanted.disconnect(self.cancel)
        self._bar.destroyed.disconnect(self._lose_bar)
        self._bar.end(CANCELLED if isinstance(fault, _Cancelled) else "")
        if fault is None:
            try:
                self._finish(result)
            except CytodiskError as error:
                show_error(str(error))
            return
        self._leave()
        if isinstance(fault, CytodiskError):
            show_error(str(fault))
        elif not isinstance(fault, _Cancelled):
            raise fault  # napari shows where it comes from


_RUNNING: set[Work] = set()
"""Work that nobody else holds must not vanish while it is done."""


def run_in_background(
    bar: WorkBar,
    function: Callable[[Reporter], Result],
    *,
    done: Callable[[Result], None],
    failed: Callable[[], None] = lambda: None,
    unit: str = "cells",
    words: str = "",
) -> Work:
    """Run a function in a thread; errors of the library become notifications with its words.

    Parameters
    ----------
    bar : WorkBar
        Shows how far it is; its button cancels. When it is destroyed, with its viewer, the work ends too.
    function : callable
        Is given a `Reporter`, which is called with (done, in all). It touches neither viewer nor widgets.
    done : callable
        Called with the result, in the thread of the viewer.
    failed : callable
        Called there without one, when it failed or was cancelled.
    unit : str
        What is counted, in the plural.
    words : str
        Shown until something is counted.

    Returns
    -------
    Work
    """
    work = Work(bar, unit, done, failed)
    _RUNNING.add(work)
    bar.begin(words)
    work.start(function)
    return work
