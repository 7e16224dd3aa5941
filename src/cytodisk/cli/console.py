"""What all commands share: console, progress, errors that end a command."""

import sys
import time as clock
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import typer

from cytodisk.errors import DamagedPartWarning, EarlierVersionWarning, words_of
from cytodisk.runs.told.speed_words import PERCENT, speed_words
from cytodisk.stopping import Stopped, is_stop

if TYPE_CHECKING:
    from rich.console import Console

SECONDS_A_LINE = 30.0
_RATE_OVER_S = 600.0  # what is counted may take minutes each
RESUME = "run it again with --resume"
COMPLETE = "this study is complete already: nothing was run again"


def fail(message: str) -> None:
    print(f"Error: {message}", file=sys.stderr)
    raise SystemExit(2)


def out_of_memory_words(error: MemoryError) -> str:
    """What to do where memory ran out."""
    said = f" ({words_of(error)})" if str(error) else ""
    return (
        f"memory ran out{said}: pass fewer --workers or smaller --layers and --sectors, crop the images, or "
        "use a computer with more memory; what was done is kept (--resume)"
    )


def count(number: int, of: str = "cell") -> str:
    return f"1 {of}" if number == 1 else f"{number} {of}s"


def say_lines(console: "Console", lines: Iterable[str]) -> None:
    for line in lines:
        console.print(line)


def say_losses(lines: Iterable[str]) -> None:
    """Say on stderr what was lost, even where nothing else is printed."""
    for line in lines:
        print(line, file=sys.stderr)


def say_notes(console: "Console", notes: Iterable[str]) -> None:
    """Say on stderr what is wrong with the files, each once."""
    if not console.quiet:
        for note in notes:
            print(f"Warning: {note}", file=sys.stderr)


def console_for(quiet: bool) -> "Console":
    from rich.console import Console

    return Console(quiet=quiet, highlight=False, soft_wrap=True, markup=False)


@contextmanager
def earlier_version_lines(say: Callable[[str], None]) -> Iterator[None]:
    """Say what is of an earlier version in plain lines, each once; other warnings go on as they are."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", EarlierVersionWarning)
        yield
    told: dict[str, None] = {}
    for one in caught:
        if issubclass(one.category, EarlierVersionWarning):
            told[str(one.message)] = None
        else:
            warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)
    for words in told:
        say(words)


@contextmanager
def damaged_part_lines() -> Iterator[None]:
    """Say at once, in plain lines, what of an earlier run is damaged and made anew."""
    with warnings.catch_warnings():
        show = warnings.showwarning

        def say(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
            if issubclass(category, DamagedPartWarning):
                print(f"Warning: {message}", file=sys.stderr)
            else:
                show(message, category, *place, **more)

        warnings.showwarning = say
        yield


@contextmanager
def progress_bar(
    quiet: bool, unit: str, *, total: int | None = None, stopped: str | None = None, again: str = RESUME
) -> Iterator[Callable[[int, int], None]]:
    """A bar on stderr with rate and time left; what asks to stop within ends the command in a line.

    Where stderr is no terminal, as in a log file, a line at most every 30 s.

    Parameters
    ----------
    quiet : bool
        Show no bar.
    unit : str
        What is counted, in the plural.
    total : int, optional
        How many there are, where that is known before the first is done.
    stopped : str, optional
        What to print at Ctrl-C. By default the bar is that of a run whose parts are kept: it says how many
        are done, and a run that reports nothing was complete before.
    again : str
        How such a run goes on.

    Yields
    ------
    callable
        To call with (done, in all).
    """
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    percent = unit == PERCENT
    done_of_all = TextColumn("{task.percentage:.0f} %") if percent else MofNCompleteColumn()
    columns = (TextColumn("{task.description}"), BarColumn(), done_of_all, TextColumn("{task.fields[left]}"))
    console = Console(stderr=True)
    hidden = quiet or not console.is_terminal
    log = None if quiet or console.is_terminal else ProgressLines(unit)
    with Progress(
        *columns, console=console, disable=hidden, transient=True, speed_estimate_period=_RATE_OVER_S
    ) as bar:
        task = bar.add_task("" if percent else unit, total=total, left="")
        first: int | None = None

        def report(done: int, total: int) -> None:
            nonlocal first
            if log is not None:
                log.report(done, total)
            first = done if first is None else first
            speed = bar.tasks[task].speed or 0.0
            words = ", ".join(speed_words(speed, unit, done - first, total - done))
            bar.update(task, completed=done, total=total, left=words)

        try:
            yield report
        except (Stopped, KeyboardInterrupt, SystemError) as error:
            stop = is_stop(error)
            if stop is None:
                raise
            done, known = bar.tasks[task].completed, bar.tasks[task].total
            of_all = f" ({done:.0f} of {known:.0f} {unit})" if known else ""
            kept = f"Stopped; what was done is kept{of_all}: {again}."
            print(kept if stopped is None else stopped, file=sys.stderr)
            raise typer.Exit(stop.exit_code) from None
        if stopped is None and not bar.tasks[task].total and not quiet:
            print(COMPLETE, file=sys.stderr)


class ProgressLines:
    """Progress in plain lines, the first after 30 s, as "cells 24/36, 1.2 cells/s, 10 s left"."""

    def __init__(self, unit: str) -> None:
        self.unit = unit
        self.first: int | None = None  # done before this run
        self.started = self.said = clock.monotonic()

    def report(self, done: int, total: int) -> None:
        if self.first is None:
            self.first = done
        now = clock.monotonic()
        if now - self.said < SECONDS_A_LINE:
            return
        self.said = now
        new = done - self.first
        words = speed_words(new / (now - self.started), self.unit, new, total - done)
        percent = f"{100 * done / total:.0f} %" if total else "0 %"
        whole = percent if self.unit == PERCENT else f"{self.unit} {done}/{total}"
        print(", ".join([whole, *words]), file=sys.stderr, flush=True)
