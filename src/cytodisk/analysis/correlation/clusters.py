"""Clusters: neighbouring windows whose correlations agree at a lag, more than chance gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from cytodisk.analysis.correlation.cluster_fields import SIGNS, WindowRing
from cytodisk.analysis.correlation.lag_tables import ALPHA, SECTOR
from cytodisk.analysis.correlation.peaks import p_value
from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.errors import ParameterError

_SAME = 0.5  # share of its windows above which a cluster is a larger one's at another lag


class _Cluster(NamedTuple):
    """Windows that agree at a lag."""

    mass: float
    place: int  # of the lag
    sign: int
    member: BoolArray  # (layer, sector)


def correlation_clusters(correlations: xr.Dataset) -> xr.Dataset:
    """Clusters of neighbouring windows that correlate at the same lag, more than chance gives.

    A window alone has little power: neighbours that agree are tested together. A significant cluster says
    that the signals correlate **in this region**. It does not say so of each of its windows: its borders are
    not exact.

    Parameters
    ----------
    correlations : Dataset
        Of `cross_correlate` with surrogates and `clusters=True`, of one channel.

    Returns
    -------
    Dataset with the dims cluster and those of the windows
        The clusters with p <= 0.05, the one of the largest mass first, numbered from 1: lag (frames), lag_s
        when the interval is known; sign of the correlation; correlation, its mean over the windows at that
        lag; size, number of windows; mass; p; member, whether a window belongs to it.

    Raises
    ------
    ParameterError
        `correlations` was made without clusters, or has several channels.

    See Also
    --------
    cross_correlate : Makes the correlations.
    peak_correlation : Each window by itself.

    Notes
    -----
    Correlations become standard scores by Fisher's transformation and the effective number of pairs. Each
    window's score is averaged with those of its neighbours along the edge, in the same layer, with weights
    that fall to 0 over about a fifteenth of the edge, and divided by the spread that surrogates give. Windows
    above 2.25 that share a side and a sign are a cluster; sector 0 is the neighbour of the last. The mass is
    the sum over its windows of what is above 2.25.

    p is the share of surrogates whose largest mass, at any lag, anywhere and of either sign, is at least as
    large, so that the chance of any false cluster is 5 %. All windows of a surrogate share their noise
    (`filtered_noise`) or shift, so that it keeps how sectors and layers hang together.

    Of clusters that share more than half of their windows and the sign, the one of the largest mass is told:
    the same region at other lags. `benchmarks/correlation.py` prints how many windows are found, how many
    clusters are false, and how many windows of true clusters are not coupled.

    References
    ----------
    Maris & Oostenveld (2007), doi:10.1016/j.jneumeth.2007.03.024; Bullmore et al. (1999),
    doi:10.1109/42.750253.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = [[sector < 8 for sector in range(24)]] * 2
    >>> signal, velocity = cd.simulate.coupled_series("white", 0, 120, 2, 24, lag_frames=3, windows=windows)
    >>> correlations = cd.cross_correlate(signal, velocity, max_lag=5, surrogates=99, clusters=True)
    >>> clusters = cd.correlation_clusters(correlations)
    >>> clusters["lag"].to_numpy(), clusters["p"].to_numpy()
    (array([-3]), array([0.01]))
    """
    field = _Field.of(correlations)
    found = _told(_clusters(field))
    p = p_value(np.array([cluster.mass for cluster in found]), field.null)
    kept = [cluster for cluster, chance in zip(found, p, strict=True) if chance <= ALPHA]
    return _table(kept, p[: len(kept)], field, correlations)


def p_of_regions(clusters: xr.Dataset, correlations: xr.Dataset) -> FloatArray:
    """How significant other correlations are where clusters are, such as those with controls regressed out.

    Parameters
    ----------
    clusters : Dataset
        Of `correlation_clusters`.
    correlations : Dataset
        Of `cross_correlate` with clusters, of the same windows and lags.

    Returns
    -------
    ndarray of shape (clusters,) and dtype float
        p of the heaviest cluster of these correlations that has the same sign and lag as the cluster and
        shares a window with it; 1 where there is none.
    """
    field = _Field.of(correlations)
    others = _clusters(field)
    masses = []
    for number in range(clusters.sizes["cluster"]):
        one = clusters.isel(cluster=number)
        member = _layered(one["member"].transpose(*field.dims).to_numpy(), field.dims)
        place = int(np.flatnonzero(field.lags == int(one["lag"]))[0])
        alike = [other for other in others if (other.place, other.sign) == (place, int(one["sign"]))]
        masses.append(max((other.mass for other in alike if (other.member & member).any()), default=0.0))
    return p_value(np.array(masses), field.null)


@dataclass(frozen=True, eq=False)
class _Field:
    """Averaged scores of correlations, by lag, layer and sector, and what clusters chance gives."""

    scores: FloatArray
    curves: FloatArray
    lags: IntArray
    null: FloatArray
    ring: WindowRing
    dims: tuple[str, ...]

    @classmethod
    def of(cls, correlations: xr.Dataset) -> _Field:
        _check(correlations)
        dims = tuple(dim for dim in ("layer", SECTOR) if dim in correlations["cluster_spread"].dims)
        curves, worth = (
            _layered(correlations[name].transpose("lag", *dims).to_numpy(), dims)
            for name in ("correlation", "n_effective")
        )
        spread = _layered(correlations["cluster_spread"].transpose(*dims).to_numpy(), dims)
        numbers = np.asarray(correlations[SECTOR])
        ring = WindowRing.of(numbers, correlations.attrs["edge_sectors"])
        scores = ring.averaged_scores(curves, worth) / spread
        null = correlations["cluster_null"].to_numpy()[:, None]
        return cls(scores, curves, correlations["lag"].to_numpy(), null, ring, dims)


def _check(correlations: xr.Dataset) -> None:
    if not isinstance(correlations, xr.Dataset) or "cluster_null" not in correlations:
        raise ParameterError(
            "correlations must be the Dataset that cross_correlate returns with surrogates and clusters=True"
        )
    several = [str(dim) for dim in correlations["cluster_null"].dims if dim != "cluster_surrogate"]
    if several:
        raise ParameterError(
            f"correlations have the dim {several[0]}: pass one at a time, such as "
            f"correlations.isel({several[0]}=0)"
        )


def _layered(table: Any, dims: tuple[str, ...]) -> Any:
    """A table by layer, of which there may be one alone, and sector."""
    return table if "layer" in dims else table[..., None, :]


def _clusters(field: _Field) -> list[_Cluster]:
    """All clusters, the one of the largest mass first."""
    found = []
    for sign in SIGNS:
        labels, masses = field.ring.masses(field.scores, sign)
        for number in np.flatnonzero(masses):
            chosen = labels == number
            place = int(np.flatnonzero(chosen.any(axis=(1, 2)))[0])
            found.append(_Cluster(float(masses[number]), place, sign, chosen[place]))
    return sorted(found, key=lambda cluster: -cluster.mass)


def _told(clusters: list[_Cluster]) -> list[_Cluster]:
    """Clusters without those that are mostly windows of larger ones of the same sign."""
    kept: list[_Cluster] = []
    taken = {sign: np.zeros_like(clusters[0].member) for sign in SIGNS} if clusters else {}
    for cluster in clusters:
        if taken[cluster.sign][cluster.member].mean() <= _SAME:
            kept.append(cluster)
            taken[cluster.sign] |= cluster.member
    return kept


def _table(clusters: list[_Cluster], p: FloatArray, field: _Field, correlations: xr.Dataset) -> xr.Dataset:
    places = np.array([cluster.place for cluster in clusters], dtype=np.int64)
    members = np.array([cluster.member for cluster in clusters], dtype=bool).reshape(
        -1, *field.curves.shape[1:]
    )
    means = [field.curves[cluster.place][cluster.member].mean() for cluster in clusters]
    data: dict[str, Any] = {
        "lag": ("cluster", field.lags[places], {"units": "frame"}),
        "sign": ("cluster", np.array([cluster.sign for cluster in clusters], dtype=np.int64)),
        "correlation": ("cluster", np.array(means, dtype=np.float64), {"units": "1"}),
        "size": ("cluster", members.sum(axis=(1, 2)), {"units": "windows"}),
        "mass": ("cluster", np.array([cluster.mass for cluster in clusters]), {"units": "1"}),
        "p": ("cluster", p, {"units": "1"}),
        "member": (("cluster", *field.dims), members if "layer" in field.dims else members[:, 0]),
    }
    if "lag_s" in correlations.coords:
        data["lag_s"] = ("cluster", correlations["lag_s"].to_numpy()[places], {"units": "s"})
    coords: dict[str, Any] = {name: correlations[name] for name in field.dims if name in correlations.coords}
    coords["cluster"] = np.arange(1, len(clusters) + 1)
    return xr.Dataset(data, coords, attrs=correlations.attrs)
