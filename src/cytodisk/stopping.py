"""Signals that ask a process to end: it cleans up behind itself first."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

_ASKED = ("SIGINT", "SIGTERM", "SIGHUP")
_TIME_TO_TIDY_S = 5.0


class Stopped(BaseException):
    """The process was asked to end; what runs is left, on the way locks and temporary files are removed.

    Attributes
    ----------
    number : int
        Of the signal.
    """

    def __init__(self, number: int = signal.SIGINT):
        super().__init__(f"stopped by {signal.Signals(number).name}")
        self.number = number

    @property
    def exit_code(self) -> int:
        """What a shell gives a process that died of the signal: 130 after Ctrl-C, 143 after SIGTERM."""
        return 128 + self.number


@contextmanager
def stopping_tidily() -> Iterator[None]:
    """Within the block Ctrl-C, SIGTERM and SIGHUP raise `Stopped`; signals that are ignored stay so.

    Signals that follow the first within a few seconds do nothing, so that they do not stop the tidying up.
    """
    last = -_TIME_TO_TIDY_S

    def stop(number: int, _: FrameType | None) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= _TIME_TO_TIDY_S:
            last = now
            raise Stopped(number)

    if threading.current_thread() is not threading.main_thread():
        yield  # no other thread can hear signals
        return
    asked = [getattr(signal, name) for name in _ASKED if hasattr(signal, name)]
    before = {number: signal.getsignal(number) for number in asked}
    heard = [number for number, handler in before.items() if handler not in (signal.SIG_IGN, None)]
    for number in heard:
        signal.signal(number, stop)
    try:
        yield
    finally:
        for number in heard:
            signal.signal(number, before[number])


def is_stop(error: BaseException | None) -> Stopped | None:
    """What asked the process to end, if that is behind an error.

    Where compiled code is called, it comes out as a SystemError.
    """
    while error is not None:
        if isinstance(error, Stopped):
            return error
        if isinstance(error, KeyboardInterrupt):
            return Stopped()
        error = error.__cause__ or error.__context__
    return None
