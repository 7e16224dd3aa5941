"""Blocks of `honest.py` on what geometry alone would give."""

import re
import warnings
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from scipy.signal import lfilter

from cytodisk.analysis.accuracy import share_by_sector
from cytodisk.analysis.activity import sample_movie
from cytodisk.analysis.controls.geometry_controls import geometry_controls
from cytodisk.analysis.controls.without_controls import without_controls
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.motion.map_movie import map_movie
from cytodisk.runs.correlate.run_correlate import run_correlate
from cytodisk.runs.qc_flags.study_flags import qc_flags
from cytodisk.simulate import movie, passive_signal
from cytodisk.simulate.passive_signals import PassiveKind
from cytodisk.windows.polar_windows import polar_windows
from figure import Figure
from honest_trials import Trials, percent, quiet_study

CASES: tuple[PassiveKind, ...] = ("still", "cortex", "ring")
JUDGED = ("still", "cortex")
GRID = {"layers": 5, "sectors": 24}
SMALL_CELL: dict[str, Any] = {"frames": 100, "radius_px": 22.0, "protrusion_px": 7.0, "signals": False}
MAX_LAG = 10
SURROGATES = 199
ALPHA = 0.05
COUPLED_LAGS = (-4, 3, 0)
COUPLED_LAYERS = 2
MEMORIES = (0.5, 0.7, 0.8, 0.9, 0.95)
CELLS: dict[str, dict[str, float]] = {
    "still cell": {"protrusion_px": 0.0},
    "fluctuating edge": {},
    "fluctuating edge, crawls 0.25 px a frame": {"speed_px": 0.25},
}


class Passive(NamedTuple):
    """What `correlate` said of a signal without biology."""

    raw: bool
    partial: bool
    flagged: bool
    not_tested: bool


def passive_movie(seed: int) -> dict[str, Passive]:
    """A study of a cell whose edge fluctuates by itself, each signal correlated with its velocity."""
    masks = movie("fluctuating", seed, **SMALL_CELL).masks
    channels = {kind: passive_signal(kind, masks, seed).to_numpy() for kind in CASES}
    found = {}
    with quiet_study(masks, channels, **GRID) as study:
        for kind in CASES:
            correlation = run_correlate(
                study, kind, max_lag=MAX_LAG, surrogates=SURROGATES, seed=seed, clusters=False
            )
            layers = correlation.layers
            flags = [flag for flag in qc_flags(study) if flag.name.startswith("geometry")]
            here = {
                flag.name for flag in flags for place in flag.places if re.match(rf"{kind}\b", place.note)
            }
            found[kind] = Passive(
                bool((layers["q"] < ALPHA).any()),
                bool((layers["q_partial"] < ALPHA).any()),
                "geometry" in here,
                "geometry not tested" in here,
            )
    return found


def no_biology(trials: Trials) -> Iterator[Figure]:
    """Movies whose signal has nothing to do with the edge but by geometry."""
    seeds = list(trials.seeds(100, 4))
    found = trials.run("no biology", passive_movie, seeds)
    for kind in CASES:
        rows = np.array([one[kind] for one in found])
        fooled = rows[:, 1] & ~rows[:, 2]
        yield Figure(
            f"{kind}: any layer at q_partial < .05 and no flag `geometry`",
            percent(fooled),
            "%",
            most=10.0 if kind in JUDGED else None,
            note=f"{len(seeds)} movies; any layer at q < .05 {percent(rows[:, 0]):.0f} %, at q_partial < .05 "
            f"{percent(rows[:, 1]):.0f} %; flagged {percent(rows[:, 2]):.0f} %, not tested "
            f"{percent(rows[:, 3]):.0f} %",
        )


def coupled_movie(job: tuple[int, int]) -> FloatArray:
    """Coupled windows: how many, found raw, found of these with geometry taken out; false ones alike."""
    lag, seed = job
    truth = movie("fluctuating", seed, frames=150, lag_frames=lag, coupled=0.5)
    assert truth.signal is not None
    share = share_by_sector(map_movie(truth.masks), truth.boundary_yx, truth.coupled, 60)
    with quiet_study(
        truth.masks, {"edge": truth.signal.sel(channel="edge").to_numpy()}, layers=10, sectors=60
    ) as study:
        windows = run_correlate(study, "edge", max_lag=20, surrogates=999, seed=seed, clusters=False).windows
    raw, partial = windows["q"] < ALPHA, windows["q_partial"] < ALPHA
    near = (windows["lag_partial"] + lag).abs() <= 1.0
    of_sector = windows["sector"].map(dict(enumerate(share)))
    on = (of_sector > 0.95) & (windows["layer"] < COUPLED_LAYERS)
    off = of_sector < 0.05
    counts = [on, on & raw, on & raw & partial, on & raw & partial & near, off, off & raw, off & partial]
    return np.array([int(chosen.sum()) for chosen in counts], dtype=np.float64)


def coupled(trials: Trials) -> Iterator[Figure]:
    """Of coupled windows found raw, those found with geometry taken out."""
    seeds = trials.seeds(6, 1)
    found = trials.run("coupled", coupled_movie, [(lag, seed) for lag in COUPLED_LAGS for seed in seeds])
    for number, lag in enumerate(COUPLED_LAGS):
        on, raw, kept, near, off, false_raw, false_kept = np.sum(
            found[number * len(seeds) : (number + 1) * len(seeds)], axis=0
        )
        yield Figure(
            f"signal {lag:+d} frames after the edge: coupled windows found raw, found without geometry, too",
            100.0 * kept / max(raw, 1.0),
            "%",
            least=90.0,
            note=f"{len(seeds)} movies; {100 * raw / on:.0f} % of coupled windows found raw; right lag in "
            f"{100 * near / max(kept, 1.0):.0f} % of those kept",
        )
        yield Figure(
            f"signal {lag:+d} frames after the edge: windows that are not coupled, found without geometry",
            100.0 * false_kept / off,
            "%",
            most=100.0 * ALPHA,
            note=f"{100 * false_raw / off:.1f} % raw",
        )


def survived(job: tuple[str, int]) -> FloatArray:
    """For each memory: share of the variance left by the controls, and correlation with the truth."""
    name, seed = job
    settings = {key: value for key, value in SMALL_CELL.items() if key != "signals"}
    masks = movie("fluctuating", seed, signals=False, **(settings | CELLS[name])).masks
    mapped = map_movie(masks)
    sector = [_sectors(mapped, frame) for frame in range(len(mapped))]
    found = []
    for memory in MEMORIES:
        truth = _series(memory, len(masks), seed)
        image = 100.0 * np.ones(masks.shape)
        for frame, held in enumerate(sector):
            image[frame] += np.where(held >= 0, 20.0 * truth[frame, held], 0.0)
        image += np.random.default_rng([seed, 11]).normal(scale=3.0, size=image.shape)
        found.append(_left_of(mapped, image, truth))
    return np.array(found)


def _sectors(mapped: DiskMovie, frame: int) -> IntArray:
    return polar_windows(1, GRID["sectors"]).on(mapped[frame]).labels


def _series(memory: float, frames: int, seed: int) -> FloatArray:
    """Autoregressive series of variance 1 by sector, shape (T, sectors)."""
    noise = np.random.default_rng([seed, 10]).normal(size=(frames + 200, GRID["sectors"]))
    return np.asarray(lfilter([np.sqrt(1.0 - memory**2)], [1.0, -memory], noise, axis=0)[200:])


def _left_of(mapped: DiskMovie, image: FloatArray, truth: FloatArray) -> tuple[float, float]:
    grid = polar_windows(**GRID)
    raw: xr.DataArray = sample_movie(mapped, grid, image)["mean"]
    if "channel" in raw.dims:
        raw = raw.isel(channel=0)
    left = without_controls(raw, geometry_controls(mapped, grid, image, MAX_LAG))
    known = left.notnull()
    share = float((left.where(known).var("time") / raw.where(known).var("time")).median())
    with_truth = xr.corr(left, xr.DataArray(truth, dims=("time", "sector")), dim="time")
    return share, float(with_truth.median())


def survival(trials: Trials) -> Iterator[Figure]:
    """How much of a true signal the controls by geometry leave, by its autocorrelation."""
    seeds = trials.seeds(6, 1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        found = trials.run("survival", survived, [(name, seed) for name in CELLS for seed in seeds])
    for number, name in enumerate(CELLS):
        means = np.nanmean(found[number * len(seeds) : (number + 1) * len(seeds)], axis=0)
        for memory, (share, together) in zip(MEMORIES, means, strict=True):
            yield Figure(
                f"{name}, AR {memory:g}: variance of a true signal that is left",
                100.0 * float(share),
                "%",
                note=f"{len(seeds)} movies; correlation with the truth {together:.3f}",
            )
