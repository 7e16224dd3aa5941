"""Ratio of nucleus to cytoplasm, and shares of the cytoplasm's signal near nucleus and membrane."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray

_COARSE = 0.4
"""Share of the cytoplasm's area above which a layer is too coarse to be cut at a third."""


class CompartmentRatios(NamedTuple):
    """What one channel says of nucleus and cytoplasm. NaN comes with a reason.

    Attributes
    ----------
    nucleus_mean, cytoplasm_mean : float
        Means of the signal.
    nucleus_to_cytoplasm : float
        Mean of the nucleus over that of the cytoplasm.
    ratio_of_totals : float
        Total of the nucleus over that of the cytoplasm.
    perinuclear_share, peripheral_share : float
        Share of the cytoplasm's total in the third of its area at the nucleus, and at the membrane. An even
        signal has 1/3.
    reasons : tuple of str
        Why numbers are missing; empty if none is.
    """

    nucleus_mean: float
    cytoplasm_mean: float
    nucleus_to_cytoplasm: float
    ratio_of_totals: float
    perinuclear_share: float
    peripheral_share: float
    reasons: tuple[str, ...]


def compartment_ratios(means: FloatArray, areas: FloatArray, nuclear: BoolArray) -> CompartmentRatios:
    """Ratios and shares from the means of layers.

    Parameters
    ----------
    means : ndarray of shape (layers,) and dtype float
        Mean of the signal in each layer.
    areas : ndarray of shape (layers,) and dtype float
        Area of each layer in the cell; one without, deeper than the cytoplasm, does not count.
    nuclear : ndarray of shape (layers,) and dtype bool
        Which layers are in the nucleus; layers of the cytoplasm run from the membrane in.

    Returns
    -------
    CompartmentRatios
    """
    totals = np.where(areas > 0.0, means * areas, 0.0)
    nucleus, cytoplasm = (totals[own].sum() / areas[own].sum() for own in (nuclear, ~nuclear))
    none = (np.nan,) * 4
    if np.isnan(nucleus) or np.isnan(cytoplasm):
        return CompartmentRatios(nucleus, cytoplasm, *none, ("a layer has no number",))
    if cytoplasm <= 0.0:
        return CompartmentRatios(nucleus, cytoplasm, *none, ("the mean of the cytoplasm is 0 or below",))
    ratio, reasons = nucleus / cytoplasm, []
    if nucleus < 0.0:
        ratio = np.nan
        reasons.append("the mean of the nucleus is below 0")
    of_totals = ratio * areas[nuclear].sum() / areas[~nuclear].sum()
    shares, reason = _shares(totals[~nuclear], areas[~nuclear])
    if reason:
        reasons.append(reason)
    return CompartmentRatios(nucleus, cytoplasm, ratio, of_totals, *shares, tuple(reasons))


def _shares(totals: FloatArray, areas: FloatArray) -> tuple[tuple[float, float], str]:
    """Shares of the cytoplasm's total near the nucleus and near the membrane; a reason if there are none.

    A layer that the border of a third cuts counts with the share of its area.
    """
    inward = np.append(0.0, np.cumsum(areas)) / areas.sum()
    borders = np.array([1.0, 2.0]) / 3.0
    cut = np.searchsorted(inward, borders) - 1
    wide = np.diff(inward)[cut].max()
    if wide > _COARSE:
        return (np.nan, np.nan), f"a layer holds {wide:.0%} of the cytoplasm: thirds need narrower ones"
    outer, both = np.interp(borders, inward, np.append(0.0, np.cumsum(totals)) / totals.sum())
    found = float(1.0 - both), float(outer)
    if min(found) < 0.0:
        return (np.nan, np.nan), "the mean of a third of the cytoplasm is below 0"
    return found, ""
