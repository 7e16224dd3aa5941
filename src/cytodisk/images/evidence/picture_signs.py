"""Signs that a frame is a picture, a map of probabilities, or a mask with grey edges, and no label image."""

from __future__ import annotations

import numpy as np

from cytodisk.images.evidence.frame_sight import FrameSight
from cytodisk.images.evidence.value_pieces import count_pieces, share_alike, thick_values, touching_values
from cytodisk.images.frame_pixels import FramePixels

_LEAST_ALIKE = 0.5  # of neighbouring pixels within cells must have one label in a label image
_MOST_PIECES = 3  # connected pieces a label, on average, in a label image
_MOST_FULL = 0.8  # of the pixels of a mask with grey edges have the greatest value
_IF_LABELS = "threshold it, or pass kind='labels' (--kind labels) if it is one"


def picture_words(frame: FramePixels, sight: FrameSight) -> str:
    """What a frame looks like that is no mask and no label image, with the remedy; empty if it may be one.

    Parameters
    ----------
    frame : FramePixels
    sight : FrameSight
        Of this frame.

    Returns
    -------
    str
        To follow the name of the file.
    """
    values = len(sight.cells)
    if values < 2:
        return ""
    alike, pieces = share_alike(frame.strips()), count_pieces(frame.strips())
    if alike < _LEAST_ALIKE or pieces > _MOST_PIECES * values:
        if _share_of(frame, sight.cells.max()) > _MOST_FULL:
            return (
                "looks like a picture, not a mask or label image: most of the cell has the value "
                f"{sight.cells.max():g} and its edge is grey ({values - 1} other values), as scaling or "
                f"smoothing a mask makes it; make it again without interpolation, or {_IF_LABELS}"
            )
        return (
            f"looks like a picture, not a mask or label image: {values} values of frame {sight.number} "
            f"lie in {pieces} pieces; {_IF_LABELS}"
        )
    rims, full = _rims(frame, sight)
    if rims:
        return (
            "looks like a picture, not a mask or label image: "
            f"{rims} of the {values} values of frame {sight.number} are thin rims or specks beside the value "
            f"{full:g}, as scaling or smoothing a mask makes them; make it again without "
            f"interpolation, or {_IF_LABELS}"
        )
    return ""


def fraction_words(sight: FrameSight) -> str:
    """What a frame with fractions looks like, with the remedy; empty where all values are whole numbers."""
    if sight.is_whole:
        return ""
    values = sight.values[np.isfinite(sight.values)]
    if len(values) < len(sight.values) and (values == np.rint(values)).all():
        return ""  # a mask or labels with NaN in it, of which the frame's own reason tells
    least, greatest = float(values.min()), float(values.max())
    between = f"values between {least:.3g} and {greatest:.3g} in frame {sight.number}"
    if least >= 0 and greatest <= 1:
        return (
            f"looks like probabilities, not a mask ({between}): threshold it, as image > 0.5, or export the "
            "Simple Segmentation (ilastik)"
        )
    return f"looks like a picture, not a mask or label image ({between}): threshold it"


def _share_of(frame: FramePixels, value: float) -> float:
    """Share of a frame's pixels beside 0 that have a value."""
    counts = np.sum([((strip == value).sum(), (strip != 0).sum()) for _, strip in frame.strips()], axis=0)
    return float(counts[0] / counts[1])


def _rims(frame: FramePixels, sight: FrameSight) -> tuple[int, float]:
    """How many values are no more than rims and specks of another one, where most are, and that one; else 0.

    That one is the greatest value; of two values the one that is thick.
    """
    thick = np.intersect1d(thick_values(frame.strips()), sight.cells)
    greatest = thick[0] if len(sight.cells) == 2 and len(thick) == 1 else sight.cells.max()
    others = sight.cells[sight.cells != greatest]
    thin = others[~np.isin(others, thick)]
    if greatest not in thick or 2 * len(thin) <= len(others):
        return 0, 0.0
    full = np.issubdtype(sight.dtype, np.integer) and greatest == np.iinfo(sight.dtype).max
    beside = np.isin(thin, touching_values(frame.strips())).sum()
    return (len(thin) if full or 2 * beside > len(thin) else 0), float(greatest)
