"""The demo's input files, and how far its results are from the known answer."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import tifffile

from cytodisk.analysis.accuracy import (
    first_boundary_of,
    share_by_sector,
    tracking_error,
    true_edge_velocity,
)
from cytodisk.analysis.top_speed import top_speed
from cytodisk.arrays import FloatArray
from cytodisk.errors import ReadError, StudyError
from cytodisk.files import replacing
from cytodisk.images.frames import open_frames
from cytodisk.simulate.moving_cells import SimulatedMovie, movie
from cytodisk.store.study import Study

FRAMES = 40
LAYERS = 8  # of windows of 10 px at least
_COUPLED = 0.5  # share of the edge along which the signal follows its velocity
_SOFTWARE = "cytodisk demo"  # by which its files are known
_MOSTLY = 0.95  # share of a sector that must be coupled, or not, for it to count


def write_demo_input(
    folder: Path, seed: int, *, overwrite: bool = False
) -> tuple[SimulatedMovie, Path, Path]:
    """Write a simulated movie as a mask file and an OME-TIFF; files that hold it already are left alone.

    Parameters
    ----------
    folder : Path
        Is made if need be.
    seed : int
    overwrite : bool
        Replace files that hold something else.

    Returns
    -------
    truth : SimulatedMovie
    masks, signal : Path

    Raises
    ------
    StudyError
        The folder cannot be written, or holds something else.
    """
    truth = demo_movie(seed)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StudyError(f"output folder {folder} cannot be written: {error.strerror}") from error
    masks, signal = folder / "masks.tif", folder / "signal.ome.tif"
    _write(masks, truth.masks.astype(np.uint8), {"axes": "TYX"}, overwrite)
    counts = demo_signal(truth)
    metadata = {
        "axes": "TCYX",
        "Channel": {"Name": [str(name) for name in counts["channel"].to_numpy()]},
        "PhysicalSizeX": truth.pixel_size_um,
        "PhysicalSizeXUnit": "µm",
        "PhysicalSizeY": truth.pixel_size_um,
        "PhysicalSizeYUnit": "µm",
        "TimeIncrement": truth.frame_interval_s,
        "TimeIncrementUnit": "s",
    }
    _write(signal, counts.to_numpy(), metadata, overwrite)
    return truth, masks, signal


def compare_with_truth(study: Study, truth: SimulatedMovie) -> dict[str, str]:
    """How far the results of a demo are from the known answer, in words.

    Parameters
    ----------
    study : Study
        Study of the files that `write_demo_input` wrote, with its edge signal correlated with velocity.
    truth : SimulatedMovie

    Returns
    -------
    dict of str to str
        By what is compared.
    """
    activity = study.activity(0)
    return {
        "boundary": _boundary_words(study, truth),
        "edge velocity": _velocity_words(study, truth, activity["velocity"].to_numpy()),
        "signal": _signal_words(study, truth),
        "lag": _lag_words(study, truth),
    }


def _boundary_words(study: Study, truth: SimulatedMovie) -> str:
    movie = study.movie(0)
    first, last = first_boundary_of(movie), movie.records[-1].boundary
    if last is None:
        return f"the last frame has no map: {movie.records[-1].reason}"
    error = tracking_error(first, last, truth.boundary_yx[0], truth.boundary_yx[-1]) * truth.pixel_size_um
    share = error.mean() / (last.contour.length * truth.pixel_size_um)
    return (
        f"after {len(movie) - 1} frames the tracked points are {error.mean():.2f} µm off along the edge on "
        f"average, {share:.1%} of the perimeter (95 % within {np.percentile(error, 95):.2f} µm)"
    )


def _velocity_words(study: Study, truth: SimulatedMovie, found: FloatArray) -> str:
    first = first_boundary_of(study.movie(0))
    known = true_edge_velocity(first, truth.boundary_yx, truth.normal_displacement_px, found.shape[1])
    known = known * truth.pixel_size_um / truth.frame_interval_s
    both = np.isfinite(found) & np.isfinite(known)
    error = float(np.sqrt(np.mean((found - known)[both] ** 2)))
    spread = float(known[both].std())
    correlation = float(np.corrcoef(found[both], known[both])[0, 1])
    unit = study.scale.shown_velocity(top_speed(found), len(found))
    return (
        f"error {unit.words(error, 2)} (rms), correlation with the true velocity {correlation:.3f}; the true "
        f"velocity has a standard deviation of {unit.words(spread, 2)}"
    )


def _signal_words(study: Study, truth: SimulatedMovie) -> str:
    """Sums over windows against counts in the mask, which must agree but for rounding."""
    windows = study.windows
    products = windows["mean"] * windows["n_pixels"]
    found = products.groupby([windows["channel"], windows["frame"]]).sum()
    off = []
    counts = demo_signal(truth)
    for number, channel in enumerate(counts["channel"].to_numpy()):
        for frame, mask in enumerate(truth.masks):
            counted = float(counts.to_numpy()[frame, number][mask].sum(dtype=np.float64))
            off.append(abs(found[str(channel), frame] - counted) / counted)
    worst = float(np.max(off))
    return f"the sum over windows is that of the cell, at most {worst:.0e} off in any frame and channel"


def _lag_words(study: Study, truth: SimulatedMovie) -> str:
    """The lag of the edge signal where it follows the edge, and what was found where it does not."""
    found = study.correlation("edge", "velocity").windows
    outer = found[found["layer"] == 0].sort_values("sector")
    share = share_by_sector(study.movie(0), truth.boundary_yx, truth.coupled, len(outer))
    coupled, others = outer[share > _MOSTLY], outer[share < 1.0 - _MOSTLY]
    interval, lag = truth.frame_interval_s, -float(coupled["lag"].median())
    right = (coupled["lag"] + truth.lag_frames).abs() <= 1
    return (
        f"the simulated signal follows the edge after {truth.lag_frames * interval:g} s, the measured one "
        f"after {lag * interval:g} s, within a frame in {right.sum()} of {len(coupled)} sectors, with "
        f"q < 0.05 in {(coupled['q'] < 0.05).sum()}. Where it does not follow the edge, q < 0.05 in "
        f"{(others['q'] < 0.05).sum()} of {len(others)} sectors"
    )


def demo_movie(seed: int = 0) -> SimulatedMovie:
    """The movie of the demo: a cell whose "edge" signal follows its edge along one half of it."""
    return movie("fluctuating", seed, frames=FRAMES, speed_px=0.5, coupled=_COUPLED)


def demo_signal(truth: SimulatedMovie) -> Any:
    """Its channels, with dims (time, channel, y, x)."""
    if truth.signal is None:
        raise StudyError("the demo's movie has no signal: simulate it with signals=True")
    return truth.signal


def _write(path: Path, values: Any, metadata: dict[str, Any], overwrite: bool) -> None:
    if path.exists() and _holds(path, values):
        return
    if os.path.lexists(path) and not _is_of_demo(path):
        raise StudyError(f"{path} was not written by cytodisk demo: pass another folder")
    if path.exists() and not overwrite:
        raise StudyError(f"{path} is of another demo: pass --overwrite to replace it, or another folder")
    with replacing(path) as temporary:
        ome = path.name.endswith(".ome.tif")
        tifffile.imwrite(temporary, values, metadata=metadata, ome=ome, software=_SOFTWARE)


def _is_of_demo(path: Path) -> bool:
    try:
        with tifffile.TiffFile(path) as file:
            return bool(file.pages.first.tags.valueof("Software") == _SOFTWARE)
    except (OSError, ValueError):  # no file, or no TIFF
        return False


def _holds(path: Path, values: Any) -> bool:
    try:
        found = open_frames(path)
        if found.n_frames != len(values) or found.image_shape != values.shape[-2:]:
            return False
        return all(
            np.array_equal(found.frame(number), frame.reshape(-1, *values.shape[-2:]))
            for number, frame in enumerate(values)
        )
    except ReadError:
        return False
