"""Time of stages: functions of the package are timed from outside, the package itself knows nothing of it.

A stage's time is what its functions take less what the stages called inside them take, so that all stages and
the rest add up to the whole.
"""

import importlib
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import wraps
from types import FunctionType
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Stage:
    """A part of the work, and the functions that do it, as "module:function" or "module:Class.method"."""

    part: str
    name: str
    targets: tuple[str, ...]

    @property
    def key(self) -> str:
        """Name that is unique over all parts."""
        return f"{self.part}: {self.name}"


@dataclass(frozen=True)
class Lap:
    """One repetition: processor seconds in all, and seconds and calls by stage."""

    seconds: float
    by_stage: dict[str, float]
    calls: dict[str, int]

    @property
    def rest(self) -> float:
        """Seconds in no stage."""
        return self.seconds - sum(self.by_stage.values())


class StageClock:
    """Processor time of stages, by laps.

    Parameters
    ----------
    stages : sequence of Stage

    Attributes
    ----------
    laps : list of Lap
    missing : list of str
        Targets that this revision of the package does not have; their time counts where they were called.
    """

    def __init__(self, stages: Sequence[Stage]):
        self.stages = tuple(stages)
        self.laps: list[Lap] = []
        self.missing: list[str] = []
        self._inner: list[float] = []
        self._restart()

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Time all targets until the end of the block."""
        undo: list[tuple[Any, str, Any]] = []
        try:
            for stage in self.stages:
                for target in stage.targets:
                    undo += self._watch(stage.key, target)
            self._restart()
            yield
        finally:
            for holder, name, original in reversed(undo):
                setattr(holder, name, original)

    def lap(self) -> None:
        """End a repetition."""
        self.laps.append(Lap(time.process_time() - self._started, self._seconds, self._calls))
        self._restart()

    def medians(self) -> tuple[float, dict[str, float], dict[str, float]]:
        """Median over laps of the whole time, of each stage's time and of its number of calls."""
        keys = [stage.key for stage in self.stages]
        seconds = {key: float(np.median([lap.by_stage[key] for lap in self.laps])) for key in keys}
        calls = {key: float(np.median([lap.calls[key] for lap in self.laps])) for key in keys}
        return float(np.median([lap.seconds for lap in self.laps])), seconds, calls

    def _restart(self) -> None:
        self._seconds = {stage.key: 0.0 for stage in self.stages}
        self._calls = {stage.key: 0 for stage in self.stages}
        self._started = time.process_time()

    def _watch(self, key: str, target: str) -> list[tuple[Any, str, Any]]:
        """Replace a target wherever the package refers to it; what to put back."""
        module, _, path = target.partition(":")
        try:
            holder: Any = importlib.import_module(module)
            *outer, name = path.split(".")
            for part in outer:
                holder = getattr(holder, part)
            original = vars(holder)[name]
        except (ImportError, AttributeError, KeyError):
            self.missing.append(target)
            return []
        of_class = isinstance(original, (classmethod, staticmethod))
        function = original.__func__ if of_class else original
        if not isinstance(function, FunctionType):
            raise TypeError(f"{target} is compiled or no function: time the function that calls it")
        watched = type(original)(self.timed(key, function)) if of_class else self.timed(key, function)
        holders = [(holder, name)] if outer else list(_references(original))
        for place, alias in holders:
            setattr(place, alias, watched)
        return [(place, alias, original) for place, alias in holders]

    def timed(self, key: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function, whose time is added to the stage of this key."""

        @wraps(function)
        def watched(*args: Any, **options: Any) -> Any:
            self._inner.append(0.0)
            start = time.process_time()
            try:
                return function(*args, **options)
            finally:
                taken = time.process_time() - start
                self._seconds[key] += taken - self._inner.pop()
                self._calls[key] += 1
                if self._inner:
                    self._inner[-1] += taken

        return watched


def _references(function: FunctionType) -> Iterator[tuple[Any, str]]:
    """Every module of the package that holds a function, with the name it has there."""
    for name, module in list(sys.modules.items()):
        if name.partition(".")[0] == "cytodisk":
            for alias, value in list(vars(module).items()):
                if value is function:
                    yield module, alias
