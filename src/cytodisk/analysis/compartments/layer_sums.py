"""Means of a signal by layer and by sector, from those of its windows."""

from typing import NamedTuple

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray


class GroupMeans(NamedTuple):
    """Windows taken together, by layer or by sector.

    Attributes
    ----------
    mean, sd : ndarray
        Of the windows' means, each weighted by its pixels. NaN for a group without a number; sd also where
        less than two windows have one.
    pixels : ndarray
        Sum of the pixels that were sampled.
    number : ndarray of dtype int
        Windows that have a number.
    """

    mean: FloatArray
    sd: FloatArray
    pixels: FloatArray
    number: FloatArray


def group_means(mean: FloatArray, n_pixels: FloatArray) -> GroupMeans:
    """Take windows together along the last axis; those without a number are left out.

    Parameters
    ----------
    mean, n_pixels : ndarray of shape (..., N) and dtype float
        As `sample` gives them.

    Returns
    -------
    GroupMeans
        Of shape (...).
    """
    known = np.isfinite(mean)
    weight = np.where(known, n_pixels, 0.0)
    values = np.where(known, mean, 0.0)
    pixels, number = weight.sum(axis=-1), (known & (weight > 0.0)).sum(axis=-1)
    found = _over((weight * values).sum(axis=-1), pixels)
    squares = (weight * np.square(values - np.nan_to_num(found)[..., None])).sum(axis=-1)
    sd = np.where(number > 1, np.sqrt(_over(squares, pixels)), np.nan)
    return GroupMeans(found, sd, pixels, number)


def area_mean(values: FloatArray, areas: FloatArray) -> FloatArray:
    """Mean over the last axis, weighted by area; what has no value is left out."""
    known = np.isfinite(values)
    weight = np.where(known, areas, 0.0)
    return _over((weight * np.where(known, values, 0.0)).sum(axis=-1), weight.sum(axis=-1))


def layer_shares(areas: FloatArray, nuclear: BoolArray) -> FloatArray:
    """Share of its compartment's area outside the middle of each layer; NaN for a layer without area.

    Parameters
    ----------
    areas, nuclear : ndarray of shape (..., layers)
        Layers from the membrane in, and whether each is in the nucleus.
    """
    found = np.full(areas.shape, np.nan)
    for of_nucleus in (False, True):
        own = np.where((nuclear == of_nucleus) & (areas > 0.0), areas, 0.0)
        inward = np.cumsum(own, axis=-1)
        share = _over(inward - 0.5 * own, np.broadcast_to(inward[..., -1:], own.shape))
        found = np.where(own > 0.0, share, found)
    return found


def _over(part: FloatArray, whole: FloatArray) -> FloatArray:
    """A quotient, NaN where the divisor is 0."""
    found = np.full(np.shape(whole), np.nan)
    return np.asarray(np.divide(part, whole, out=found, where=np.asarray(whole) > 0.0))
