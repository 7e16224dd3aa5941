"""A measured frame of a cell → rows of the tables: its own, and those of its windows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from cytodisk.analysis.activity import STATISTICS, pixel_arrays
from cytodisk.analysis.pixel_pileup import Pileup, pileup
from cytodisk.arrays import FloatArray
from cytodisk.errors import CytodiskError, EmptyMaskError, ReadError, SignalError
from cytodisk.geometry.outline_step import outline_step
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.geometry.polygon import centroid, edge_lengths, smooth_closed
from cytodisk.images.signal_files import SignalPiece
from cytodisk.runs.compartment_row import place_row, signal_row
from cytodisk.windows.depths import DEPTHS, NUCLEUS_DISTANCES
from cytodisk.windows.pixel_shares.hole_pixels import hole_pixels
from cytodisk.windows.polar_windows import CellWindows
from cytodisk.windows.sample import check_channel_names
from cytodisk.windows.window_sizes import window_sizes

_PERIMETER_SMOOTHING_PX = 1.0


@dataclass(frozen=True)
class FramePlace:
    """Where a row comes from.

    Attributes
    ----------
    cell, frame, label : int
    time_s : float or None
        Time of the frame in seconds, where it is known.
    source : str or None
        Name of the mask file, where there can be many.
    """

    cell: int
    frame: int
    label: int
    time_s: float | None = None
    source: str | None = None

    @property
    def row(self) -> dict[str, Any]:
        """Start of the row in the table of cells."""
        source = {} if self.source is None else {"source": self.source}
        return {"cell": self.cell, **source, "frame": self.frame, "time_s": self.time_s, "label": self.label}

    def columns(self, rows: int) -> dict[str, Any]:
        """Start of so many rows in another table."""
        return {
            "cell": np.full(rows, self.cell),
            "frame": np.full(rows, self.frame),
            "time_s": [self.time_s] * rows,
        }


def cell_status(fault: CytodiskError) -> str:
    """What the table of cells says of a row without results.

    Parameters
    ----------
    fault : CytodiskError

    Returns
    -------
    {"unreadable", "no cell", "no image", "refused"}
        A file is damaged, an image holds no cell, its signal cannot be used, or the mask cannot.
    """
    if isinstance(fault, ReadError):
        return "unreadable"
    if isinstance(fault, EmptyMaskError):
        return "no cell"
    return "no image" if isinstance(fault, SignalError) else "refused"


@dataclass(frozen=True, eq=False)
class _CellSignal:
    """Values in the box of a cell, shape (C, h, w), and of its pixels, (C, P); the channels' names."""

    channels: list[str]
    box: np.ndarray[Any, Any]
    pixels: np.ndarray[Any, Any]

    @classmethod
    def of(cls, signal: SignalPiece, placed: PlacedMask) -> _CellSignal:
        values, channels = signal.values, list(signal.channels)
        box = values if values.shape[1:] == placed.box.shape else placed.cut_out_of(values)
        check_channel_names("signal", channels)
        return cls(channels, box, np.stack([channel[placed.box] for channel in box]))


def measure_windows(
    place: FramePlace,
    windows: CellWindows,
    signal: SignalPiece | None,
    nan: Literal["propagate", "omit"],
    corner: tuple[int, int] = (0, 0),
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Sample the signal in the windows of a map, and describe both.

    Parameters
    ----------
    place : FramePlace
    windows : CellWindows
    signal : SignalPiece or None
        Of the shape of the map's mask, or of its box in the image (`DiskMap.placed_mask`).
    nan : {"propagate", "omit"}
    corner : (int, int)
        (row, column) of the first pixel of the mask in the image that the rows are about.

    Returns
    -------
    row : dict
        Of the table of cells.
    columns : dict of str to array
        Of the table of windows: for each channel every window, layers first.
    """
    inside = None if signal is None else _CellSignal.of(signal, windows.disk.placed_mask)
    row = place.row | _cell_columns(windows, inside) | place_row(windows)
    columns = _window_columns(place, windows, inside, nan)
    if inside is not None:
        row |= signal_row(windows, columns, inside.channels, inside.box)
    for values in (row, columns):
        for name, first in zip(("centroid_y", "centroid_x"), corner, strict=True):
            values[name] = values[name] + float(first)
    return row, columns


def _cell_columns(windows: CellWindows, signal: _CellSignal | None) -> dict[str, Any]:
    """What the table of cells says about a map and its windows."""
    disk = windows.disk
    report, distortion, certificate = disk.report, disk.distortion, disk.certificate
    centre = centroid(disk.outline_yx)
    smooth = smooth_closed(disk.outline_yx, _PERIMETER_SMOOTHING_PX)
    missing, ends = 0, Pileup()
    if signal is not None:
        pixels, holes = signal.pixels, hole_pixels(disk.placed_mask, disk.holes)
        pixels = pixels if holes is None else pixels[:, ~holes]
        missing = pixels.size - int(np.count_nonzero(np.isfinite(pixels)))
        ends = pileup(signal.channels, pixels)
    return {
        "notes": "; ".join(_notes(windows, missing)),
        "mask_remarks": "; ".join(report.qc_flags),
        "area": disk.scale.area(float(report.area_px)),
        "perimeter": disk.scale.length(float(edge_lengths(smooth).sum())),
        "centroid_y": float(centre[0]),
        "centroid_x": float(centre[1]),
        "area_px": report.area_px,
        "components": report.components,
        "dropped_px": report.dropped_px,
        "holes": report.holes,
        "filled_px": report.filled_px,
        "excluded_px": report.excluded_px,
        "touches_border": report.touches_border,
        "border_share": report.border_share,
        "outline_step_px": outline_step(disk.outline_yx),
        "nan_px": missing,
        "clipped_share": ends.clipped,
        "clipped_channel": ends.clipped_channel,
        "clipped_note": ends.clipped_note,
        "saturated_share": ends.saturated,
        "saturated_channel": ends.saturated_channel,
        "certificate_valid": certificate.valid,
        "flipped": len(certificate.flipped_in_disk),
        "vertices": len(disk.vertices_yx),
        "triangles": len(disk.triangles),
        "area_distortion": distortion.area,
        "area_ratio_p1": distortion.area_percentiles[1],
        "area_ratio_p99": distortion.area_percentiles[99],
        "angle_distortion": distortion.angle,
        "angle_distortion_p95": distortion.angle_percentiles[95],
        "empty_windows": windows.n_empty,
        **window_sizes(windows),
        "relaxation_start": disk.start,
        "steps": disk.steps,
        "converged": disk.converged,
    }


def _notes(windows: CellWindows, missing: int) -> list[str]:
    disk = windows.disk
    notes = list(disk.report.notes)
    if not disk.converged:
        notes.append("relaxation stopped before its criterion")
    if disk.start == "uniform":
        notes.append("harmonic start with uniform weights")
    if missing:
        notes.append(f"{missing} NaN or infinite values in the signal")
    return notes


def _window_columns(
    place: FramePlace,
    windows: CellWindows,
    signal: _CellSignal | None,
    nan: Literal["propagate", "omit"],
) -> dict[str, Any]:
    pixels = None if signal is None else signal.pixels.astype(np.float64, copy=False)
    arrays = pixel_arrays(windows, pixels, nan)
    n_windows = windows.grid.n_windows
    channels = [None] if signal is None else signal.channels
    repeats = len(channels)
    missing = np.isnan(arrays["mean"]) if signal is not None else np.zeros((1, *windows.areas.shape), bool)
    status = np.where(missing, "NaN in signal", "no signal" if signal is None else "ok").astype(object)
    status[:, windows.areas == 0.0] = "in a hole"
    status[:, ~windows.grid.present] = "deeper than the cell"
    layer, sector = np.divmod(np.tile(np.arange(n_windows), repeats), windows.grid.sectors)
    nothing = np.full(n_windows * repeats, np.nan)
    return place.columns(n_windows * repeats) | {
        "channel": [name for name in channels for _ in range(n_windows)],
        "layer": layer,
        "sector": sector,
        **{name: arrays[name].ravel() if name in arrays else nothing for name in STATISTICS},
        "area": np.tile(windows.scale.area(arrays["area"]).ravel(), repeats),
        **{name: np.tile(windows.scale.length(arrays[name]).ravel(), repeats) for name in DEPTHS},
        "centroid_y": np.tile(arrays["centroid_y"].ravel(), repeats),
        "centroid_x": np.tile(arrays["centroid_x"].ravel(), repeats),
        "eccentricity": np.tile(windows.eccentricities.ravel(), repeats),
        "status": status.ravel().tolist(),
        **_nucleus_columns(windows, arrays, repeats),
    }


def _nucleus_columns(windows: CellWindows, arrays: dict[str, FloatArray], repeats: int) -> dict[str, Any]:
    """Columns of windows in a study with nuclei; other studies do not write them."""
    n_windows, scale = windows.grid.n_windows, windows.scale
    nothing = np.full(n_windows * repeats, np.nan)
    distances = {
        name: np.tile(scale.length(arrays[name]).ravel(), repeats) if name in arrays else nothing
        for name in NUCLEUS_DISTANCES
    }
    by_window = np.repeat(windows.grid.compartments, windows.grid.sectors)
    return {"compartment": np.tile(by_window, repeats), **distances}
