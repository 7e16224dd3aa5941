"""The difference between two conditions by window, with what is significant, as arrays to draw."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.errors import ParameterError
from cytodisk.plot.number_tables import number_table
from cytodisk.population.significance import LEVEL

ALPHA = LEVEL
"""Largest p that counts as significant."""

_PERCENTILE = 99.0
_DIMS = ("layer", "sector")


@dataclass(frozen=True, eq=False)
class DifferenceMap:
    """Difference of two conditions by window.

    Attributes
    ----------
    difference : ndarray of shape (layers, sectors) and dtype float
        Treated less control; NaN where a window has none.
    tested : ndarray of shape (layers, sectors) and dtype bool
        Whether the window was tested.
    significant : ndarray of shape (layers, sectors) and dtype bool
        Where the corrected p is at most `alpha`: for all windows, and for all comparisons with the control
        where there are several.
    cluster : ndarray of shape (layers, sectors) and dtype int
        Number of the window's cluster, 0 for none. Only clusters with p of at most `alpha` have one.
    alpha : float
    correction : str
        How p was corrected, in words.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> import cytodisk as cd
    >>> difference = np.zeros((2, 6))
    >>> difference[0, :2] = 1.0
    >>> windows = xr.Dataset(
    ...     {
    ...         "difference": (("layer", "sector"), difference),
    ...         "p_fwer": (("layer", "sector"), np.where(difference > 0, 0.03, 0.8)),
    ...     }
    ... )
    >>> int(cd.plot.DifferenceMap.of(windows).significant.sum())
    2
    """

    difference: FloatArray
    tested: BoolArray
    significant: BoolArray
    cluster: IntArray
    alpha: float = ALPHA
    correction: str = "max-T"

    @classmethod
    def of(
        cls,
        windows: xr.Dataset,
        *,
        cluster_labels: Any = None,
        clusters: pd.DataFrame | None = None,
        alpha: float = ALPHA,
    ) -> DifferenceMap:
        """Take what is drawn out of a comparison of conditions, of one channel.

        Parameters
        ----------
        windows : Dataset with dims (layer, sector)
            difference, and p_fwer and cluster where it was tested. With p_holm, p_fwer corrected for several
            comparisons with one control, that is what counts.
        cluster_labels : array_like or DataArray of shape (layers, sectors), optional
            Number of each window's cluster, 0 for none; by default the variable cluster.
        clusters : DataFrame, optional
            cluster, and p or p_holm; without it all labels are drawn.
        alpha : float
            p of at most it counts as significant.

        Raises
        ------
        ParameterError
            It is no Dataset, lacks the difference, has other dims, or alpha is not in (0, 1).
        """
        if not 0.0 < alpha < 1.0:
            raise ParameterError(f"alpha must be between 0 and 1, got {alpha!r}: 0.05 is the default")
        if not isinstance(windows, xr.Dataset) or "difference" not in windows:
            raise ParameterError(
                "windows must be a Dataset with the variable difference: pass the windows of a comparison"
            )
        difference = _table(windows["difference"], "difference")
        p = np.full(difference.shape, np.nan)
        correction = "max-T"
        if "p_fwer" in windows:
            p = _table(windows["p_fwer"], "p_fwer")
        if "p_holm" in windows:
            alone, p = p, _table(windows["p_holm"], "p_holm")
            correction = "max-T" if np.array_equal(alone, p, equal_nan=True) else "max-T, Holm"
        labels = np.zeros(difference.shape, dtype=np.int64)
        if cluster_labels is None:
            cluster_labels = windows.get("cluster")
        if cluster_labels is not None:
            labels = np.nan_to_num(number_table(cluster_labels, "cluster_labels", _DIMS)).astype(np.int64)
        if labels.shape != difference.shape:
            raise ParameterError(
                f"cluster_labels has shape {labels.shape}, difference {difference.shape}: pass those of the "
                "same comparison"
            )
        if clusters is not None:
            kept = clusters.loc[clusters[corrected_column(clusters, "p")] <= alpha, "cluster"].to_numpy()
            labels = np.where(np.isin(labels, kept), labels, 0)
        return cls(difference, np.isfinite(p), p <= alpha, labels, alpha, correction)

    @property
    def is_different(self) -> bool:
        """Whether a window or a cluster is significant."""
        return bool(self.significant.any() or self.cluster.any())

    @property
    def limit(self) -> float:
        """End of symmetric colours: percentile 99 of the size of the difference."""
        size = np.abs(self.difference[np.isfinite(self.difference)])
        return (float(np.percentile(size, _PERCENTILE)) if size.size else 0.0) or 1.0

    @property
    def cut_off(self) -> str:
        """At which ends the colours of `limit` are cut off, for a colour bar."""
        low = bool(np.nanmin(self.difference, initial=0.0) < -self.limit * (1 + 1e-9))
        high = bool(np.nanmax(self.difference, initial=0.0) > self.limit * (1 + 1e-9))
        return {(True, True): "both", (True, False): "min", (False, True): "max"}.get((low, high), "neither")


def corrected_column(table: Any, otherwise: str = "p_fwer") -> str:
    """Name of the p that counts: corrected for several comparisons too, where the table has it."""
    return "p_holm" if "p_holm" in table else otherwise


def _table(values: xr.DataArray, name: str) -> FloatArray:
    if set(values.dims) != set(_DIMS):
        remedy = ": select one, as in windows.sel(channel=…)" if "channel" in values.dims else ""
        raise ParameterError(f"{name} must have the dims layer and sector, got {values.dims}{remedy}")
    return number_table(values, name, _DIMS)
