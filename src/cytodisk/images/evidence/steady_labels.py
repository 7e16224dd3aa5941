"""Whether a cell keeps its label from frame to frame."""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import AnyArray
from cytodisk.errors import MaskError, ReadError
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frame_pixels import FramePixels, frame_pixels

_PAIRS = 24  # of neighbouring frames that are looked at
_PIXELS = 2**17  # of a frame that are looked at, spread over it
_CHANGED = 0.25  # of cells that stay in place have another label in the next frame
_IN_PLACE = 0.5  # of the pixels of both that cells share which are the same


def changing_label_words(file: FrameFile) -> str:
    """What is to be said of cells that stay in place and have another label in the next frame.

    Parameters
    ----------
    file : FrameFile
        Label images by frame.

    Returns
    -------
    str
        Empty where there is none of them.

    Raises
    ------
    MaskError
        They are so many that labels cannot be tracks.
    """
    starts = np.unique(np.linspace(0, max(0, file.n_frames - 2), _PAIRS).astype(int)).tolist()
    same = changed = 0
    example = ""
    for start in starts if file.n_frames > 1 else []:
        try:
            before, after = (_thinned(frame_pixels(file, number)) for number in (start, start + 1))
        except ReadError:  # whoever reads the frame for good tells of it
            continue
        for label, other in _in_place(before, after):
            same += label == other
            changed += label != other
            if label != other and not example:
                example = f"label {label} of frame {start} is label {other} in frame {start + 1}"
    if changed and changed >= _CHANGED * (same + changed):
        share = changed / (same + changed)
        raise MaskError(
            f"{file.path} has labels that change from frame to frame ({example}; so it is for {share:.0%} of "
            "the cells that were looked at): pass --link to give each cell one label through time, "
            "or --tracks with a file of tracks, or --no-link if they are right"
        )
    if not changed:
        return ""
    return (
        f"a cell that stays in place gets another label, where its track ends and one begins ({example}; so "
        f"it is for {changed} of the {same + changed} that were looked at): if it is one cell, pass --link"
    )


def _thinned(frame: FramePixels) -> AnyArray:
    height, width = frame.image_shape
    step = max(1, int(np.sqrt(height * width / _PIXELS)))
    return np.concatenate([strip[-first % step :: step, ::step].copy() for first, strip in frame.strips()])


def _in_place(before: AnyArray, after: AnyArray) -> list[tuple[int, int]]:
    """Labels of cells that cover the same place in two frames."""
    both = (before != 0) & (after != 0)
    if not both.any():
        return []
    ones, one_of, sizes = np.unique(before, return_inverse=True, return_counts=True)
    others, other_of, later = np.unique(after, return_inverse=True, return_counts=True)
    pairs = one_of.reshape(both.shape)[both] * len(others) + other_of.reshape(both.shape)[both]
    found, shared = np.unique(pairs, return_counts=True)
    one, other = np.divmod(found, len(others))
    kept = shared > _IN_PLACE * (sizes[one] + later[other] - shared)
    return list(zip(ones[one[kept]].tolist(), others[other[kept]].tolist(), strict=True))
