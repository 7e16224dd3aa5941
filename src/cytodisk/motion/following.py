"""Cells followed from frame to frame: the one loop that maps the frames of a movie."""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, TypeAlias

from cytodisk.errors import CytodiskError, MapError, MaskError, ReadError
from cytodisk.motion.disk_movie import FrameRecord
from cytodisk.motion.mapped_frame import MappedFrame, map_frame
from cytodisk.motion.nucleus.cell_and_nucleus import CellAndNucleus
from cytodisk.motion.nucleus.frame_with_nucleus import map_frame_with_nucleus
from cytodisk.motion.tracking_parameters import MovieSettings
from cytodisk.scale import UNKNOWN, Scale

Submit: TypeAlias = Callable[..., Future[Any]]


@dataclass(frozen=True, eq=False)
class FrameResult:
    """What became of one frame of a movie.

    Attributes
    ----------
    frame : int
    mapped : MappedFrame or None
    fault : CytodiskError or None
        Why there is no map.
    """

    frame: int
    mapped: MappedFrame | None
    fault: CytodiskError | None

    @property
    def record(self) -> FrameRecord:
        """The frame without its map."""
        if self.mapped is not None:
            boundary, nucleus = self.mapped.boundary, self.mapped.nucleus
            return FrameRecord("ok", "", lambda: boundary, "" if nucleus is None else nucleus.held)
        return FrameRecord(frame_status(self.fault), str(self.fault), None)


def frame_status(fault: CytodiskError | None) -> str:
    """Status of a frame in the tables: what kind of fault it had."""
    if fault is None:
        return "ok"
    return "unreadable" if isinstance(fault, ReadError) else "refused"


def map_frames(
    masks: Sequence[Any], settings: MovieSettings, scale: Scale = UNKNOWN
) -> Iterator[FrameResult]:
    """Map the frames of a movie one by one; each is ready to be used and dropped before the next is read.

    Parameters
    ----------
    masks : sequence of array_like of shape (H, W)
        Masks of one cell, or `CellAndNucleus`. An entry may be an error of this package instead: the frame
        then has that fault.
    settings : MovieSettings
    scale : Scale

    Yields
    ------
    FrameResult
        In order; a frame that cannot be mapped has its fault, and the next one goes on from the last map.
    """
    one_cell = ((frame, iter([(0, masks[frame])])) for frame in range(len(masks)))
    yield from map(attrgetter("result"), map_cells(one_cell, settings, scale))


@dataclass(frozen=True, eq=False)
class FollowedFrame:
    """One cell in one frame, and where it was before.

    Attributes
    ----------
    cell : int
    result : FrameResult
    last : MappedFrame or None
        The frame that this one goes on from.
    seconds : float
        That mapping took.
    """

    cell: int
    result: FrameResult
    last: MappedFrame | None
    seconds: float


def map_cells(
    frames: Iterable[tuple[int, Iterable[tuple[int, Any]]]],
    settings: MovieSettings,
    scale: Scale = UNKNOWN,
    *,
    last: dict[int, MappedFrame] | None = None,
    submit: Submit | None = None,
) -> Iterator[FollowedFrame]:
    """Map cells frame by frame, each from where it was last; those of one frame side by side.

    Parameters
    ----------
    frames : iterable of (int, iterable of (int, mask))
        Number of a frame, and its cells with the mask of each, or `CellAndNucleus`, or the error that stands
        for it. Masks may be cut out when they are asked for, and the next frame is asked for when this one is
        mapped.
    settings : MovieSettings
    scale : Scale
    last : dict of int to MappedFrame, optional
        Where each cell was last; kept up to date. Whoever gives the frames may add a cell that an earlier
        run followed, and take out one that has left.
    submit : callable, optional
        Starts a function with its arguments and returns a Future; by default each runs at once.

    Yields
    ------
    FollowedFrame
        By frame, then in the order of its cells.
    """
    last = {} if last is None else last
    for frame, masks in frames:
        yield from _map_side_by_side(frame, masks, settings, scale, last, submit or _at_once)


def _map_side_by_side(
    frame: int,
    masks: Iterable[tuple[int, Any]],
    settings: MovieSettings,
    scale: Scale,
    last: dict[int, MappedFrame],
    submit: Submit,
) -> Iterator[FollowedFrame]:
    started = [(cell, submit(_map_one, frame, mask, last.get(cell), settings, scale)) for cell, mask in masks]
    for cell, future in started:
        result, seconds = future.result()
        before = last.get(cell)
        if result.mapped is not None:
            last[cell] = result.mapped
        yield FollowedFrame(cell, result, before, seconds)


def _at_once(work: Callable[..., Any], *arguments: Any) -> Future[Any]:
    done: Future[Any] = Future()
    done.set_result(work(*arguments))
    return done


def _map_one(
    frame: int, mask: Any, last: MappedFrame | None, settings: MovieSettings, scale: Scale
) -> tuple[FrameResult, float]:
    """Map one frame, and take the time; a fault of its mask becomes part of the result."""
    started = clock.perf_counter()
    mapped, fault = None, mask
    if isinstance(mask, CellAndNucleus):
        fault = mask.mask
    if not isinstance(fault, CytodiskError):
        try:
            mapped, fault = _mapped(frame, mask, last, settings, scale), None
        except (MaskError, MapError, ReadError) as error:
            fault = error
    return FrameResult(frame, mapped, fault), clock.perf_counter() - started


def _mapped(
    frame: int, mask: Any, last: MappedFrame | None, settings: MovieSettings, scale: Scale
) -> MappedFrame:
    if isinstance(mask, CellAndNucleus):
        return map_frame_with_nucleus(frame, mask, last, settings, scale)
    return map_frame(frame, mask, last, settings, scale)
