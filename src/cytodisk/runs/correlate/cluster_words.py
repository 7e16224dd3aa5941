"""A cluster of windows in words."""

from __future__ import annotations

from typing import Any

from cytodisk.runs.correlate.lag_words import lag_words


def cluster_place(row: Any) -> str:
    """Where a cluster lies, and its lag.

    Parameters
    ----------
    row : object
        A row of the table of clusters, as of `itertuples`.

    Returns
    -------
    str
        As "sectors 12–25, layers 0–2, lag −20 s".
    """
    lag = lag_words(row.lag, row.lag_s)
    return f"{_named('sector', row.sectors)}, {_named('layer', row.layers)}, {lag}"


def cluster_line(row: Any) -> str:
    """Where a cluster lies, its lag, how strong and how significant it is.

    Parameters
    ----------
    row : object
        A row of the table of clusters.

    Returns
    -------
    str
        As "cluster 1: sectors 12–25, layers 0–2, lag −20 s, r +0.31, p = 0.002".
    """
    correlation = f"{row.correlation:+.2f}".replace("-", "−")
    return f"cluster {row.cluster}: {cluster_place(row)}, r {correlation}, p = {row.p:.2g}"


def _named(name: str, numbers: str) -> str:
    return f"{name} {numbers}" if numbers.isdecimal() else f"{name}s {numbers}"
