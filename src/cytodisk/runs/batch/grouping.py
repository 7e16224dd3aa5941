"""Inputs → tasks that take seconds, however small the inputs are."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from importlib.metadata import version

from cytodisk.errors import CytodiskError
from cytodisk.images.frames import open_frames
from cytodisk.runs.batch.inputs import BatchInput
from cytodisk.runs.batch.task import BatchTask

_MOST_INPUTS = 100
# Time of a frame, with its cells: that of one cell, and what reading and more cells take in larger images.
_SECONDS_A_FRAME, _SECONDS_A_MEGAPIXEL = 0.1, 1.0


def make_tasks(
    inputs: Iterable[BatchInput], target: str, *, seconds: float, time_limit: float | None
) -> Iterator[BatchTask]:
    """Put inputs together, in their order, until a task takes about as long as wanted.

    Parameters
    ----------
    inputs : iterable of BatchInput
        Gone through as tasks are taken.
    target : str
    seconds : float
        How long a task should take at least; with 0 every input is a task.
    time_limit : float or None
        Of one input, in seconds.

    Yields
    ------
    BatchTask
    """
    here = version("cytodisk")
    some: list[BatchInput] = []
    expected = 0.0
    for item in inputs:
        some.append(item)
        expected += expected_seconds(item) if seconds > 0 else 0.0
        if expected >= seconds or len(some) == _MOST_INPUTS:
            yield BatchTask(here, tuple(some), target, time_limit)
            some, expected = [], 0.0
    if some:
        yield BatchTask(here, tuple(some), target, time_limit)


def expected_seconds(item: BatchInput) -> float:
    """A rough estimate of an input's time, from the number and size of its frames as the file's head says.

    Parameters
    ----------
    item : BatchInput

    Returns
    -------
    float
        0 for a file that cannot be read, which is soon found out. A folder counts as a task of its own.
    """
    if item.masks.is_dir():
        return math.inf
    if not item.masks.is_file():
        return 0.0
    try:
        file = open_frames(item.masks)
    except CytodiskError:
        return 0.0
    height, width = file.image_shape
    return file.n_frames * (_SECONDS_A_FRAME + _SECONDS_A_MEGAPIXEL * height * width / 1e6)
