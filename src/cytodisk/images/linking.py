"""Label images whose numbers change from frame to frame → tracks, one a cell."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy import sparse

from cytodisk.arrays import AnyArray, FloatArray, IntArray
from cytodisk.errors import MaskError, MissingPartError, ParameterError

Cell: TypeAlias = tuple[int, int]  # frame, place among the sorted labels of the frame
Links: TypeAlias = dict[Cell, Cell]  # from a cell to the one before it in its track
Overlaps: TypeAlias = dict[tuple[Cell, Cell], float]  # IoU of (earlier, later) cell
_NO_LINK = 1.0  # distance of cells that must not be linked
_PIXELS_AT_ONCE = 2**20
_CERTAIN = 0.5  # two labels of one frame cannot both have a larger IoU with the same cell


@dataclass(frozen=True)
class _Labelled:
    """The cells of one label image.

    Attributes
    ----------
    labels : ndarray of shape (K,) and dtype int
        Sorted, without 0.
    sizes : ndarray of shape (K,) and dtype int64
        Pixels.
    frame : ndarray of shape (H, W)
        Label of each pixel, 0 outside of cells.
    """

    labels: AnyArray
    sizes: IntArray
    frame: AnyArray


def link_labels(
    frames: Iterable[AnyArray], *, least_overlap: float = 0.1, largest_gap: int = 2
) -> list[dict[int, int]]:
    """Link the labels of consecutive label images to tracks by overlap.

    The cells must move by less than their size from frame to frame.

    Parameters
    ----------
    frames : iterable of ndarray of shape (H, W) and integer dtype
        Label images in the order of time, 0 where there is no cell. The labels of one frame need not have
        anything to do with those of the next. Taken one by one; `largest_gap` + 1 of them are kept.
    least_overlap : float
        In (0, 1]. Cells whose intersection over union (IoU) is below are not linked.
    largest_gap : int
        Frames in a row in which a cell may be missing and still continue its track.

    Returns
    -------
    list of dict
        For each frame {label: track}. Tracks are numbered from 1 in the order of first appearance: by frame,
        then by label. A track has at most one label a frame.

    Raises
    ------
    MaskError
        A frame is not 2D, has another shape than the first, has no integer dtype, or negative labels.
    ParameterError
        `least_overlap` is outside of (0, 1], or `largest_gap` is negative or no whole number.
    MissingPartError
        laptrack is not installed.

    Notes
    -----
    The measure is the IoU rather than the overlap over the smaller cell: that one is 1 for every fragment
    within a large cell, so that it cannot tell the cell from its crumbs.

    Tracks neither split nor merge. Where a cell divides, or two touch and become one label, the track goes on
    with the larger IoU; the other daughter starts a track, the other of the merged cells ends its own (and
    continues it if the two come apart again within `largest_gap` frames). A `least_overlap` above 0.5 makes
    both daughters of an even division start a track.

    Neighbouring frames are linked first where the IoU is above 1/2: such a partner is the only one [1]_. All
    other ends and starts of tracks are then assigned at once [2]_ such that the sum of IoU / d² is largest,
    where d is the distance in frames: a link across a missing frame should not pass over a cell in between.

    References
    ----------
    .. [1] Kirillov et al., Panoptic segmentation, CVPR 2019, section 4.1, doi:10.1109/CVPR.2019.00963
    .. [2] Jaqaman et al., Robust single-particle tracking in live-cell time-lapse sequences, Nature Methods 5
       (2008), doi:10.1038/nmeth.1237; as in laptrack, doi:10.5281/zenodo.5519537
    """
    if not 0 < least_overlap <= 1:
        raise ParameterError(f"least_overlap must be above 0 and at most 1, got {least_overlap}")
    if largest_gap < 0 or not float(largest_gap).is_integer():
        raise ParameterError(f"largest_gap must be a whole number of frames from 0 on, got {largest_gap}")
    predict = _tracker(int(largest_gap) + 1)
    labels, overlaps = _read(frames, least_overlap, int(largest_gap) + 1)
    if not any(found.size for found in labels):
        return [{} for _ in labels]
    return _numbered(labels, predict(labels, overlaps))


def _tracker(furthest: int) -> Callable[[list[AnyArray], Overlaps], Links]:
    """The assignment by laptrack, over at most `furthest` frames."""
    try:
        from laptrack import LapTrack
    except ImportError as error:
        fault = f"cannot be imported ({error})"
        raise MissingPartError.of("link_labels needs laptrack", "link", fault) from error

    def predict(labels: list[AnyArray], overlaps: Overlaps) -> Links:
        def distance(one: FloatArray, other: FloatArray) -> float:
            earlier, later = (int(one[0]), int(one[1])), (int(other[0]), int(other[1]))
            iou = overlaps.get((earlier, later), 0.0)
            return _NO_LINK - iou / (later[0] - earlier[0]) ** 2

        tracker = LapTrack(  # type: ignore[call-arg,unused-ignore]  # takes its fields' defaults for required
            metric=distance,
            cutoff=_NO_LINK - _CERTAIN,
            gap_closing_metric=distance,
            gap_closing_cutoff=_NO_LINK,
            gap_closing_max_frame_count=furthest,
            splitting_cutoff=False,
            merging_cutoff=False,
            # By default the costs are estimated, and refuse the worst tenth of the links whatever their IoU.
            track_start_cost=_NO_LINK,
            track_end_cost=_NO_LINK,
            segment_start_cost=_NO_LINK,
            segment_end_cost=_NO_LINK,
            no_splitting_cost=_NO_LINK,
            no_merging_cost=_NO_LINK,
        )
        cells = [_cells(frame, found.size) for frame, found in enumerate(labels)]
        return {later: earlier for earlier, later in tracker.predict(cells).edges}

    return predict


def _cells(frame: int, count: int) -> IntArray:
    """`Cell`s of a frame, shape (count, 2)."""
    return np.column_stack([np.full(count, frame), np.arange(count)])


def _read(frames: Iterable[AnyArray], least_overlap: float, furthest: int) -> tuple[list[AnyArray], Overlaps]:
    """Labels of each frame, and the IoU from `least_overlap` on of cells at most `furthest` frames apart."""
    window: deque[_Labelled] = deque(maxlen=furthest)
    labels: list[AnyArray] = []
    overlaps: Overlaps = {}
    shape: tuple[int, ...] | None = None
    for number, frame in enumerate(map(np.asarray, frames)):
        _check(number, frame, shape)
        shape = frame.shape
        later = _labelled(frame)
        for back, earlier in enumerate(reversed(window), start=1):
            for one, other, iou in _overlaps(earlier, later):
                if iou >= least_overlap:
                    overlaps[(number - back, one), (number, other)] = iou
        window.append(later)
        labels.append(later.labels)
    return labels, overlaps


def _check(number: int, frame: AnyArray, shape: tuple[int, ...] | None) -> None:
    if frame.ndim != 2:
        raise MaskError(
            f"frames must be 2D label images, frame {number} has shape {frame.shape}: "
            "pass a stack of shape (T, H, W), or an iterable of its frames"
        )
    if shape is not None and frame.shape != shape:
        raise MaskError(
            f"frames must have one shape, frame {number} has {frame.shape} after {shape}: crop or pad them"
        )
    if not np.issubdtype(frame.dtype, np.integer):
        raise MaskError(
            f"labels must be whole numbers, frame {number} has dtype {frame.dtype}: "
            "number the cells (skimage.measure.label) or convert them to uint16"
        )
    if frame.size and frame.min() < 0:
        raise MaskError(
            f"frame {number} has negative labels (down to {frame.min()}): set what is no cell to 0"
        )


def _labelled(frame: AnyArray) -> _Labelled:
    found = [np.unique(strip[strip != 0], return_counts=True) for strip in _strips(frame)]
    labels, places = np.unique(np.concatenate([values for values, _ in found]), return_inverse=True)
    sizes = np.zeros(labels.size, dtype=np.int64)
    np.add.at(sizes, places, np.concatenate([counts for _, counts in found]))
    return _Labelled(labels, sizes, frame.copy())  # as the next frame may be read into its place


def _strips(frame: AnyArray) -> list[AnyArray]:
    """Rows of a frame, as many together as need little memory beside it."""
    step = max(1, _PIXELS_AT_ONCE // max(1, frame.shape[1]))
    return [frame[first : first + step] for first in range(0, max(1, len(frame)), step)]


def _overlaps(earlier: _Labelled, later: _Labelled) -> Iterable[tuple[int, int, float]]:
    """(place, place, IoU) of all pairs that share a pixel."""
    shape = (earlier.labels.size, later.labels.size)
    shared = sparse.coo_array(shape, dtype=np.int64)
    for before, after in zip(_strips(earlier.frame), _strips(later.frame), strict=True):
        both = (before != 0) & (after != 0)
        pairs = (
            np.searchsorted(earlier.labels, before[both]),
            np.searchsorted(later.labels, after[both]),
        )
        here = sparse.coo_array((np.ones(pairs[0].size, dtype=np.int64), pairs), shape=shape)
        shared = sparse.coo_array(shared + here)
    one, other = shared.coords
    union = earlier.sizes[one] + later.sizes[other] - shared.data
    return zip(one.tolist(), other.tolist(), (shared.data / union).tolist(), strict=True)


def _numbered(labels: list[AnyArray], links: Links) -> list[dict[int, int]]:
    tracks: dict[Cell, int] = {}
    started = 0
    for frame, found in enumerate(labels):
        for place in range(found.size):
            before = links.get((frame, place))
            started += before is None
            tracks[frame, place] = started if before is None else tracks[before]
    return [
        {int(label): tracks[frame, place] for place, label in enumerate(found)}
        for frame, found in enumerate(labels)
    ]
