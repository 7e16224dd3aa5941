"""Spots of a tracking program → the tracks of the labels that they lie in."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import CytodiskError, MaskError, ReadError
from cytodisk.geometry.even_odd import pixels_inside
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frame_pixels import FramePixels, frame_pixels
from cytodisk.images.scale_units import micrometres
from cytodisk.images.spots.spots import PIXEL, Spots, branches
from cytodisk.images.spots.track_words import branch_words, first_words, number_words
from cytodisk.scale import Scale

_LEAST_MATCHED = 0.5  # share of spots that lie in a label, below which the files do not belong together


@dataclass(frozen=True)
class LabelTracks:
    """The track of each label.

    Attributes
    ----------
    frames : tuple of dict of int to int
        For each frame, {label: track}; labels without a track are left out.
    mothers : dict of int to int
        Of tracks that begin with a division, the one that divided.
    remarks : tuple of str
        What did not fit, in words.
    """

    frames: tuple[dict[int, int], ...]
    mothers: dict[int, int]
    remarks: tuple[str, ...]


def label_tracks(
    spots: Spots, file: FrameFile, labels: Sequence[tuple[int, ...] | CytodiskError], scale: Scale
) -> LabelTracks:
    """Give each label of a label movie the track of the spot that lies in it.

    Parameters
    ----------
    spots : Spots
    file : FrameFile
        The label movie.
    labels : sequence of (tuple of int, or CytodiskError)
        Labels of each frame, or its fault.
    scale : Scale
        Of the movie.

    Returns
    -------
    LabelTracks
        A label with two spots has no track, as it holds two cells.

    Raises
    ------
    MaskError
        Most spots lie in no label, or after the last frame.
    ReadError
        The size of a pixel is needed and unknown.
    """
    found = branches(spots)
    late = int((spots.frame >= file.n_frames).sum())
    of_spot = (
        spots.labels if spots.labels is not None else _labels_at(spots, _pixels(spots, scale), file, labels)
    )
    taken: dict[int, dict[int, list[int]]] = defaultdict(lambda: defaultdict(list))
    outside = []
    there = [set() if isinstance(held, CytodiskError) else set(held) for held in labels]
    for spot, (frame, label) in enumerate(zip(spots.frame.tolist(), of_spot.tolist(), strict=True)):
        if frame >= file.n_frames or isinstance(labels[frame], CytodiskError):
            continue
        if label in there[frame]:
            taken[frame][label].append(int(found.track[spot]))
        else:
            outside.append(f"track {found.track[spot]} in frame {frame}")
    matched = sum(len(tracks) for of_frame in taken.values() for tracks in of_frame.values())
    if matched < _LEAST_MATCHED * len(spots):
        raise MaskError(
            f"tracks {spots.path}: {matched} of {len(spots)} spots lie in a label of {file.path} "
            f"({late} after its last frame): are they tracks of this movie? If so, pass the right pixel size "
            "(--pixel-size)"
        )
    frames = tuple(
        {label: tracks[0] for label, tracks in taken[number].items() if len(tracks) == 1}
        for number in range(file.n_frames)
    )
    remarks = [*spots.remarks, *branch_words(found), *_scale_words(spots, scale)]
    if late:
        remarks.append(f"{late} of {len(spots)} spots stand after the last frame: does the movie lack some?")
    remarks += _mismatches(taken, outside, labels, len(spots))
    present = {track for of_frame in frames for track in of_frame.values()}
    mothers = {one: mother for one, mother in found.mothers.items() if one in present}
    return LabelTracks(frames, mothers, tuple(remarks))


def _pixels(spots: Spots, scale: Scale) -> FloatArray:
    """Height and width of a pixel in the unit of the spots."""
    if spots.pixel_size is not None:
        return np.array(spots.pixel_size)
    if spots.unit == PIXEL:
        return np.ones(2)
    factor = micrometres(spots.unit)
    if factor is None:
        raise ReadError(f"tracks {spots.path} have positions in {spots.unit}: export them in pixels or µm")
    if scale.pixel_size_um is None:
        raise ReadError(
            f"tracks {spots.path} have positions in {spots.unit}, and the size of a pixel is unknown: pass "
            "it (--pixel-size)"
        )
    return np.full(2, scale.pixel_size_um / factor)


def _scale_words(spots: Spots, scale: Scale) -> list[str]:
    """What the file of tracks says of the size of a pixel, where the movie does not say the same."""
    told, known = spots.scale.pixel_size_um, scale.pixel_size_um
    if told is None or (known is not None and np.isclose(told, known, rtol=0.01)):
        return []
    if known is None:
        return [
            f"tracks {spots.path.name} say pixels of {told:g} µm: pass --pixel-size {told:g} if that is right"
        ]
    return [
        f"tracks {spots.path.name} say pixels of {told:g} µm, the movie {known:g} µm: which one is right?"
    ]


def _labels_at(
    spots: Spots, size: FloatArray, file: FrameFile, labels: Sequence[tuple[int, ...] | CytodiskError]
) -> IntArray:
    """The label in which each spot lies; 0 if it lies in none."""
    held = np.zeros(len(spots), dtype=np.int64)
    for frame in np.unique(spots.frame).tolist():
        if frame >= file.n_frames or isinstance(labels[frame], CytodiskError):
            continue
        pixels = frame_pixels(file, frame)
        for spot in np.flatnonzero(spots.frame == frame):
            outline = spots.outlines[spot] if spots.outlines else None
            held[spot] = (
                _label_within(pixels, outline / size)
                if outline is not None
                else _label_at(pixels, spots.yx[spot] / size, spots.radius[spot] / size.mean())
            )
    return held


def _label_within(pixels: FramePixels, outline: FloatArray) -> int:
    """The label with most pixels in an outline."""
    window = _window(outline.min(axis=0), outline.max(axis=0), pixels.image_shape)
    if window is None:
        return 0
    return _most_common(pixels.cut(*window)[0][pixels_inside([outline], *window)])


def _label_at(pixels: FramePixels, place: FloatArray, radius: float) -> int:
    """The label at a point; if there is none, the one label within the radius around it."""
    here = _window(np.round(place), np.round(place), pixels.image_shape)
    label = 0 if here is None else int(pixels.cut(*here)[0, 0, 0])
    window = _window(place - radius, place + radius, pixels.image_shape) if radius > 0 else None
    if label or window is None:
        return label
    y, x = (np.arange(side.start, side.stop) - at for side, at in zip(window, place, strict=True))
    near = pixels.cut(*window)[0][np.hypot(y[:, None], x) <= radius]
    around = np.unique(near[near != 0])
    return int(around[0]) if around.size == 1 else 0


def _window(least: FloatArray, greatest: FloatArray, shape: tuple[int, int]) -> tuple[slice, slice] | None:
    """Pixels between two corners, within the image."""
    start = np.ceil(least).clip(0, shape).astype(int)
    stop = (np.floor(greatest) + 1).clip(0, shape).astype(int)
    return (slice(start[0], stop[0]), slice(start[1], stop[1])) if (start < stop).all() else None


def _most_common(values: IntArray) -> int:
    labels, counts = np.unique(values[values != 0], return_counts=True)
    return int(labels[counts.argmax()]) if labels.size else 0


def _mismatches(
    taken: dict[int, dict[int, list[int]]],
    outside: list[str],
    labels: Sequence[tuple[int, ...] | CytodiskError],
    spots: int,
) -> list[str]:
    words = []
    if outside:
        words.append(f"{len(outside)} of {spots} spots lie in no label ({first_words(outside)})")
    several = [
        f"label {label} in frame {frame}: tracks {' and '.join(map(str, tracks))}"
        for frame, of_frame in sorted(taken.items())
        for label, tracks in sorted(of_frame.items())
        if len(tracks) > 1
    ]
    if several:
        words.append(
            f"{number_words(len(several), 'label')} with several spots left out ({first_words(several)}): "
            "correct the segmentation, or the tracks"
        )
    alone = [
        f"label {label} in frame {frame}"
        for frame, held in enumerate(labels)
        if not isinstance(held, CytodiskError)
        for label in held
        if label not in taken.get(frame, {})
    ]
    if alone:
        words.append(f"{number_words(len(alone), 'label')} without a spot left out ({first_words(alone)})")
    return words
