"""Clusters of windows: how many coupled windows they find, and how often one is false."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
import xarray as xr
from scipy.signal import lfilter

from cytodisk.analysis.correlation.clusters import correlation_clusters
from cytodisk.analysis.correlation.cross_correlation import cross_correlate
from cytodisk.analysis.correlation.peaks import peak_correlation
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import StationarityWarning
from cytodisk.simulate import coupled_series, independent_series

ALPHA, STRENGTH, LAG = 0.05, 0.3, 3
FIRST_SEED = 1000  # the threshold and the reach were chosen with seeds below
FRAMES = (60, 120, 300)
_COUPLED, _MEMORY, _GAP = 2, 40, 3  # layers; frames

ClusterKind: TypeAlias = Literal["white", "ar .5", "ar1", "smooth", "waves", "trend", "gaps"]
COUPLED_KINDS: tuple[tuple[ClusterKind, float], ...] = (
    ("white", 1.0),
    ("ar .5", 1.0),
    ("ar .5", 0.0),
    ("ar1", 1.0),
    ("smooth", 1.0),
)
"""Kinds of series with the correlation length of neighbours: 0 is independent noise."""

NULL_KINDS: tuple[tuple[ClusterKind, float], ...] = (
    ("white", 1.0),
    ("white", 0.0),
    ("ar1", 1.0),
    ("smooth", 1.0),
    ("waves", 1.0),
    ("trend", 1.0),
    ("gaps", 1.0),
)


@dataclass(frozen=True)
class ClusterTrial:
    """One movie of series."""

    kind: ClusterKind
    length: float
    frames: int
    seed: int
    coupled: bool
    windows: tuple[int, int]
    surrogates: int


def series(trial: ClusterTrial) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Activity (T, layer, sector), velocity (T, sector), and which windows are coupled."""
    layers, sectors = trial.windows
    random = np.random.default_rng([trial.seed, 7])
    where = np.zeros(trial.windows, dtype=bool)
    if trial.coupled:
        where[:_COUPLED, (random.integers(sectors) + np.arange(sectors // 2)) % sectors] = True
    if trial.kind == "waves":
        return *_waves(trial), where
    base: dict[str, Literal["white", "ar1"]] = {"ar .5": "white", "trend": "white", "gaps": "ar1"}
    kind = base.get(trial.kind, trial.kind)
    more = _MEMORY if trial.kind == "ar .5" else 0
    found = coupled_series(
        kind,  # type: ignore[arg-type]
        trial.seed,
        trial.frames + more,
        layers,
        sectors,
        lag_frames=LAG,
        windows=where,
        strength=STRENGTH,
        correlation_length=trial.length,
    )
    a, b = (values.to_numpy() for values in found)
    if trial.kind == "ar .5":
        a, b = (lfilter([1.0], [1.0, -0.5], values, axis=0)[more:] for values in (a, b))
    if trial.kind == "trend":
        a, b = _drifting(a, random), _drifting(b, random)
    if trial.kind == "gaps":
        a, b = _with_gaps(a, b, random)
    return a, b, where


def _waves(trial: ClusterTrial) -> tuple[FloatArray, FloatArray]:
    """One pattern each that runs around the edge, a sector a frame."""
    layers, sectors = trial.windows
    long = independent_series("ar1", trial.seed, trial.frames + sectors, layers, 1)
    noise = independent_series("white", trial.seed, trial.frames, layers, sectors)
    lines = (values.isel(sector=0).to_numpy() for values in long)
    a, b = (
        np.stack([line[k : k + trial.frames] for k in range(sectors)], axis=-1) + 0.3 * rest.to_numpy()
        for line, rest in zip(lines, noise, strict=True)
    )
    return a, b


def _drifting(values: FloatArray, random: np.random.Generator) -> FloatArray:
    """With a straight line through time that all windows share, and a smaller one of each."""
    time = np.linspace(-1.0, 1.0, len(values)).reshape(-1, *[1] * (values.ndim - 1))
    return values + 2.0 * random.normal() * time + 0.5 * random.normal(size=values.shape[1:]) * time


def _with_gaps(a: FloatArray, b: FloatArray, random: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Without some frames, and without 3 % of the windows."""
    a, b = a.copy(), b.copy()
    for _ in range(max(1, len(a) // 40)):
        start = int(random.integers(len(a) - _GAP))
        a[start : start + _GAP] = b[start : start + _GAP] = np.nan
    a[random.random(a.shape) < 0.03] = np.nan
    return a, b


def measured(trial: ClusterTrial) -> list[float]:
    """Of one movie: shares of coupled windows found alone and in clusters, and what is false."""
    warnings.simplefilter("ignore", StationarityWarning)
    a, b, where = series(trial)
    max_lag = min(20, trial.frames // 4)
    correlations = cross_correlate(a, b, max_lag, surrogates=trial.surrogates, seed=trial.seed, clusters=True)
    clusters = correlation_clusters(correlations)
    if not trial.coupled:
        return [float(clusters.sizes["cluster"] > 0)]
    peaks = peak_correlation(correlations)
    alone = float((peaks["p"].to_numpy()[where] < ALPHA).mean())
    return [alone, *_of_clusters(clusters, where)]


def _of_clusters(clusters: xr.Dataset, where: BoolArray) -> list[float]:
    member = clusters["member"].to_numpy()
    right = (np.abs(clusters["lag"].to_numpy() + LAG) <= 1) & (clusters["sign"].to_numpy() > 0)
    found = member[right].any(axis=0)
    true = (member & where).any(axis=(1, 2))
    inside = member[true].any(axis=0)
    share = float((inside & ~where).sum() / inside.sum()) if inside.any() else np.nan
    return [float(found[where].mean()), float(found[where].any()), share, float((~true).any())]


def cluster_rows(
    processes: Executor, coupled: bool, movies: int, windows: tuple[int, int], surrogates: int
) -> Iterator[tuple[ClusterKind, float, int, FloatArray]]:
    """Kind, correlation length, frames and figures of movies, row by row."""
    kinds = COUPLED_KINDS if coupled else NULL_KINDS
    rows = [
        (kind, length, frames) for kind, length in kinds for frames in (FRAMES if coupled else FRAMES[:2])
    ]
    trials = [
        ClusterTrial(kind, length, frames, FIRST_SEED + row * movies + k, coupled, windows, surrogates)
        for row, (kind, length, frames) in enumerate(rows)
        for k in range(movies)
    ]
    results = processes.map(measured, trials, chunksize=4)
    for kind, length, frames in rows:
        yield kind, length, frames, np.array([next(results) for _ in range(movies)])
