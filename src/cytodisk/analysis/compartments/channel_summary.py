"""What one channel says of a cell with its nucleus, from its windows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cytodisk.analysis.compartments.compartment_ratios import compartment_ratios
from cytodisk.analysis.compartments.layer_sums import group_means
from cytodisk.analysis.compartments.signal_polarity import signal_polarity
from cytodisk.arrays import BoolArray, FloatArray


class ChannelSummary(NamedTuple):
    """Numbers of one channel, see `nucleus_summary`; NaN comes with a reason."""

    nucleus_mean: float
    cytoplasm_mean: float
    nucleus_to_cytoplasm: float
    ratio_of_totals: float
    perinuclear_share: float
    peripheral_share: float
    signal_polarity: float
    signal_direction: float
    reason: str


NUMBERS = tuple(name for name in ChannelSummary._fields if name != "reason")
UNITS = dict.fromkeys(NUMBERS, "1") | {
    "nucleus_mean": "a.u.",
    "cytoplasm_mean": "a.u.",
    "signal_direction": "°",
}


def channel_summary(
    mean: FloatArray,
    sd: FloatArray,
    n_pixels: FloatArray,
    areas: FloatArray,
    nuclear: BoolArray,
    towards: float,
) -> ChannelSummary:
    """Ratios, shares and polarity of one channel.

    Parameters
    ----------
    mean, sd, n_pixels : ndarray of shape (layers, sectors) and dtype float
        Of the windows, as `sample` gives them.
    areas : ndarray of shape (layers, sectors) and dtype float
    nuclear : ndarray of shape (layers,) and dtype bool
        Which layers are in the nucleus.
    towards : float
        Angle in the disk, in degrees, of the direction from the nucleus' centroid to the cell's; NaN if
        there is none.

    Returns
    -------
    ChannelSummary
    """
    ratios = compartment_ratios(group_means(mean, n_pixels).mean, areas.sum(axis=1), nuclear)
    polarity = signal_polarity(mean[~nuclear], sd[~nuclear], n_pixels[~nuclear])
    reasons, relative = [*ratios.reasons, polarity.reason], np.nan
    if not polarity.reason:
        relative = (polarity.direction - towards + 180.0) % 360.0 - 180.0
        reasons.append("the nucleus is in the middle: no direction" if np.isnan(towards) else "")
    told = "; ".join(dict.fromkeys(filter(None, reasons)))
    return ChannelSummary(*ratios[:-1], polarity.size, relative, told)


def without_summary(reason: str) -> ChannelSummary:
    """That of a frame without a map or a nucleus."""
    return ChannelSummary(**dict.fromkeys(NUMBERS, np.nan), reason=reason)
