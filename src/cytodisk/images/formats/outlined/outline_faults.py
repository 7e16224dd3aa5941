"""What is doubtful about outlines: those that overlap, cross themselves or hold no pixel."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import Any

import numpy as np
import shapely

from cytodisk.geometry.even_odd import pixels_inside
from cytodisk.images.formats.outlined.outline_set import Outline, PlacedOutlines, names_of

_LEAST_OVERLAP_PX2 = 1.0  # below, sides of neighbours that were smoothed
_WITHIN = 0.99  # share of an outline that lies in others, from which on nothing is left of it
_THIN_PX2 = 2.0  # outlines with less area are looked at


def doubts_about(placed: PlacedOutlines) -> tuple[str, ...]:
    """What is doubtful about the outlines of a file, in words, each with the remedy.

    Parameters
    ----------
    placed : PlacedOutlines

    Returns
    -------
    tuple of str
    """
    outlines = [placed.frames[number].outlines for number in sorted(placed.frames)]
    every = [one for in_frame in outlines for one in in_frame]
    regions = [_region(one) for one in every]
    words = [_crossing_words(every), _empty_words(every, regions)]
    start = 0
    pairs: list[tuple[Outline, Outline, float]] = []
    for in_frame in outlines:
        pairs += _overlaps(in_frame, regions[start : start + len(in_frame)])
        start += len(in_frame)
    return tuple(filter(None, [*words, *_overlap_words(pairs)]))


def _region(outline: Outline) -> Any:
    """What lies inside, by the even-odd rule."""
    rings = [shapely.make_valid(shapely.Polygon(ring)) for ring in outline.rings]
    return reduce(shapely.symmetric_difference, rings)


def _crossing_words(outlines: Sequence[Outline]) -> str:
    crossing = [one for one in outlines if any(_crosses_itself(ring) for ring in one.rings)]
    if not crossing:
        return ""
    return (
        f"{len(crossing)} of {len(outlines)} outlines cross themselves ({names_of(crossing)}): what lies "
        "inside an odd number of times is taken as the cell; draw them anew where that is wrong"
    )


def _crosses_itself(ring: Any) -> bool:
    polygon = shapely.Polygon(ring)
    # A ring that touches itself in a point, as around pixels that share a corner, has another reason.
    return not polygon.is_valid and shapely.is_valid_reason(polygon).startswith("Self-intersection")


def _empty_words(outlines: Sequence[Outline], regions: Sequence[Any]) -> str:
    thin = [one for one, region in zip(outlines, regions, strict=True) if region.area < _THIN_PX2]
    empty = [one for one in thin if not _pixels(one)]
    if not empty:
        return ""
    return (
        f"{len(empty)} of {len(outlines)} outlines hold no pixel's centre and give no cell "
        f"({names_of(empty)}): are they in pixels? If they are in µm, export them in pixels"
    )


def _pixels(outline: Outline) -> int:
    least, greatest = outline.box
    rows, columns = (
        slice(int(np.floor(low)), int(np.ceil(high)) + 1) for low, high in zip(least, greatest, strict=True)
    )
    return int(pixels_inside(outline.rings, rows, columns).sum())


def _overlaps(outlines: Sequence[Outline], regions: Sequence[Any]) -> list[tuple[Outline, Outline, float]]:
    """Pairs of one frame that share an area, the one that stands first before; share of the second's area."""
    if len(outlines) < 2:
        return []
    held = np.array(regions, dtype=object)
    first, second = shapely.STRtree(held).query(held, predicate="intersects")
    ordered = first < second
    first, second = first[ordered], second[ordered]
    shared = shapely.area(shapely.intersection(held[first], held[second]))
    area = shapely.area(held[second])
    return [
        (outlines[one], outlines[other], float(part / whole))
        for one, other, part, whole in zip(first, second, shared, area, strict=True)
        if part >= _LEAST_OVERLAP_PX2
    ]


def _overlap_words(pairs: Sequence[tuple[Outline, Outline, float]]) -> list[str]:
    if not pairs:
        return []
    lost = [other for _, other, share in pairs if share >= _WITHIN]
    one, other, share = max(pairs, key=lambda pair: pair[2])
    words = [
        f"{_pairs(len(pairs))} of outlines overlap (most: {one.name} and {other.name}, {share:.0%} of the "
        "latter): shared pixels belong to the outline that stands first in the file; correct the outlines "
        "where that is wrong"
    ]
    if lost:
        words.append(
            f"outlines that lie in others give no cell ({names_of(lost)}): take the outer ones out of the "
            "file, or put the inner ones first"
        )
    return words


def _pairs(number: int) -> str:
    return "1 pair" if number == 1 else f"{number} pairs"
