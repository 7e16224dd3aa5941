"""Masks with the faults of a segmentation: pixels that flip along the edge, and coarse ones scaled up."""

import numpy as np
from scipy.ndimage import binary_dilation, binary_erosion, binary_fill_holes, label

from cytodisk.arrays import BoolArray
from cytodisk.checks import number_between, whole_number
from cytodisk.errors import MaskError

_CROSS = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], dtype=bool)


def flipped_masks(masks: BoolArray, share: float, seed: int = 0) -> BoolArray:
    """Masks in which pixels on either side of the edge flip, anew in each frame.

    Parameters
    ----------
    masks : array_like of shape (T, H, W) and dtype bool
        One cell.
    share : float
        Probability of each pixel beside the edge, inside and outside, to flip: from 0 to 0.5, where nothing
        is left of what they were.
    seed : int

    Returns
    -------
    ndarray of shape (T, H, W) and dtype bool
        The largest piece of each frame, without holes.

    Raises
    ------
    MaskError
        The masks are not 3D.
    ParameterError
        A number out of its range.

    See Also
    --------
    scaled_up_masks : Another fault.
    movie : Its `jitter_px` displaces the edge smoothly.

    Examples
    --------
    >>> import cytodisk as cd
    >>> masks = cd.simulate.movie("growing", frames=2, radius_px=12.0, signals=False).masks
    >>> spoilt = cd.simulate.flipped_masks(masks, share=0.3)
    >>> bool((spoilt != masks).any())
    True
    """
    masks = _movie_of(masks)
    share, seed = number_between("share", share, 0, 0.5), whole_number("seed", seed, 0)
    random = np.random.default_rng([seed, 8])
    return np.stack([_flipped(mask, share, random) for mask in masks])


def scaled_up_masks(masks: BoolArray, factor: int = 6) -> BoolArray:
    """Masks as if drawn at low resolution and scaled up: their outline goes in steps.

    Parameters
    ----------
    masks : array_like of shape (T, H, W) and dtype bool
    factor : int
        Side of a step, in pixels, at least 1.

    Returns
    -------
    ndarray of shape (T, H, W) and dtype bool
        Whole blocks of `factor` × `factor` pixels, each where the cell covers half of it or more.

    Raises
    ------
    MaskError
        The masks are not 3D.
    ParameterError
        A number out of its range.

    See Also
    --------
    flipped_masks : Another fault.

    Examples
    --------
    >>> import cytodisk as cd
    >>> masks = cd.simulate.movie("growing", frames=2, radius_px=12.0, signals=False).masks
    >>> coarse = cd.simulate.scaled_up_masks(masks, 4)
    >>> bool((coarse[:, ::4] == coarse[:, 1::4][:, : coarse[:, ::4].shape[1]]).all())
    True
    """
    masks, factor = _movie_of(masks), whole_number("factor", factor, 1)
    frames, height, width = masks.shape
    rows, columns = -(-height // factor), -(-width // factor)
    whole = np.zeros((frames, rows * factor, columns * factor))
    whole[:, :height, :width] = masks
    blocks = whole.reshape(frames, rows, factor, columns, factor).mean(axis=(2, 4)) >= 0.5
    return np.asarray(blocks.repeat(factor, axis=1).repeat(factor, axis=2)[:, :height, :width])


def _movie_of(masks: BoolArray) -> BoolArray:
    found = np.asarray(masks, dtype=bool)
    if found.ndim != 3:
        raise MaskError(
            f"masks must be 3D (frames, rows, columns), got shape {found.shape}: pass those of a movie"
        )
    return found


def _flipped(mask: BoolArray, share: float, random: np.random.Generator) -> BoolArray:
    beside = binary_dilation(mask, _CROSS) & ~binary_erosion(mask, _CROSS)
    spoilt = mask ^ (beside & (random.random(mask.shape) < share))
    pieces, count = label(spoilt)
    if not count:
        return mask
    largest = 1 + int(np.bincount(pieces.ravel())[1:].argmax())
    return np.asarray(binary_fill_holes(pieces == largest))
