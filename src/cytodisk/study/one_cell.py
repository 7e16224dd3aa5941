"""One cell of a run: map it, sample it, and put the result into rows."""

import json
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np
import xarray as xr

from cytodisk.analysis.activity import STATISTICS
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.errors import CytodiskError, ReadError
from cytodisk.files import replacing
from cytodisk.geometry.polygon import centroid, edge_lengths, smooth_closed
from cytodisk.io.masks import CellMask
from cytodisk.study.parameters import MapParameters
from cytodisk.windows.cell_windows import CellWindows
from cytodisk.windows.grid import polar_windows
from cytodisk.windows.sample import sample

DrawCell: TypeAlias = Callable[[Path, str, CellWindows, xr.DataArray | None, float | None], list[Path]]

_PERIMETER_SMOOTHING_PX = 1.0


@dataclass(frozen=True)
class CellTask:
    """Everything a worker needs for one cell."""

    found: CellMask
    signal: xr.DataArray | None
    signal_fault: CytodiskError | None
    parameters: MapParameters
    pixel_size_um: float | None
    map_path: Path
    figures: Path | None
    draw: DrawCell | None
    geojson: bool = False


@dataclass(frozen=True)
class CellResult:
    """A cell's row and its rows of the tables, for `StudyFolder.add`; no tables when the cell has no map."""

    row: dict[str, Any]
    tables: dict[str, dict[str, Any]]


def measure_cell(task: CellTask) -> CellResult:
    """Map and sample one cell; a fault of its input becomes a row with the reason.

    Parameters
    ----------
    task : CellTask

    Returns
    -------
    CellResult
        The map is written to `task.map_path`, figures to `task.figures`.

    Raises
    ------
    StudyError
        A result cannot be written.
    """
    started = clock.perf_counter()
    found, parameters = task.found, task.parameters
    row: dict[str, Any] = {"cell": found.cell, "time": found.frame, "label": found.label}
    fault = found.fault or task.signal_fault
    if fault is None:
        try:
            disk = map_to_disk(
                found.mask,
                method=parameters.method,
                shape_weight=parameters.shape_weight,
                edge_length=parameters.edge_length,
                align=parameters.align,
            )
        except CytodiskError as error:
            fault = error
    if fault is not None:
        status = "unreadable" if isinstance(fault, ReadError) else "refused"
        return CellResult(row | {"status": status, "reason": str(fault), "seconds": _since(started)}, {})

    windows = polar_windows(parameters.layers, parameters.sectors, parameters.spacing).on(disk)
    columns = window_columns(
        (found.cell, found.frame, None), windows, task.signal, parameters.nan, task.pixel_size_um
    )
    row |= cell_columns(disk, windows, task.signal, task.pixel_size_um)
    disk.save(task.map_path)
    if task.geojson:
        with replacing(task.map_path.with_suffix(".geojson")) as temporary:
            temporary.write_text(json.dumps(windows.geojson()), encoding="utf-8")
    seconds = _since(started)
    if task.draw is not None and task.figures is not None:
        task.draw(task.figures, f"cell_{found.cell:05d}", windows, task.signal, task.pixel_size_um)
    return CellResult(row | {"status": "ok", "reason": "", "seconds": seconds}, {"windows": columns})


def cell_columns(
    disk: DiskMap, windows: CellWindows, signal: xr.DataArray | None, pixel_size_um: float | None
) -> dict[str, Any]:
    """What the table of cells says about a map and its windows.

    Parameters
    ----------
    disk : DiskMap
    windows : CellWindows
    signal : DataArray with dims (channel, y, x), optional
    pixel_size_um : float or None

    Returns
    -------
    dict
        Values by column.
    """
    report, distortion, certificate = disk.report, disk.distortion, disk.certificate
    pixel = pixel_size_um or 1.0
    centre = centroid(disk.outline_yx)
    smooth = smooth_closed(disk.outline_yx, _PERIMETER_SMOOTHING_PX)
    missing = int((~np.isfinite(signal.to_numpy()[:, disk.mask])).sum()) if signal is not None else 0
    return {
        "notes": "; ".join(_notes(disk, missing)),
        "doubts": "; ".join(report.doubts),
        "area": report.area_px * pixel**2,
        "perimeter": float(edge_lengths(smooth).sum()) * pixel,
        "centroid_y": float(centre[0]),
        "centroid_x": float(centre[1]),
        "area_px": report.area_px,
        "components": report.components,
        "dropped_px": report.dropped_px,
        "holes": report.holes,
        "filled_px": report.filled_px,
        "touches_border": report.touches_border,
        "border_share": report.border_share,
        "nan_px": missing,
        "certificate_valid": certificate.valid,
        "flipped": len(certificate.flipped_in_disk),
        "vertices": len(disk.vertices_yx),
        "triangles": len(disk.triangles),
        "area_distortion": distortion.area,
        "area_ratio_p1": distortion.area_percentiles[1],
        "area_ratio_p99": distortion.area_percentiles[99],
        "angle_distortion": distortion.angle,
        "angle_distortion_p95": distortion.angle_percentiles[95],
        "empty_windows": int((windows.areas <= 0).sum()),
        "relaxation_start": disk.start,
        "steps": disk.steps,
        "converged": disk.converged,
    }


def _notes(disk: DiskMap, missing: int) -> list[str]:
    report = disk.report
    notes = list(report.notes)
    if not disk.converged:
        notes.append("relaxation stopped before its criterion")
    if disk.start == "uniform":
        notes.append("harmonic start with uniform weights")
    if missing:
        notes.append(f"{missing} NaN or infinite values in the signal")
    return notes


def window_columns(
    place: tuple[int, int, float | None],
    windows: CellWindows,
    signal: xr.DataArray | None,
    nan: Literal["propagate", "omit"],
    pixel_size_um: float | None,
) -> dict[str, Any]:
    """Columns of the windows table: for each channel every window, layers first.

    Parameters
    ----------
    place : (int, int, float or None)
        Cell, frame, and the frame's time in seconds.
    windows : CellWindows
    signal : DataArray with dims (channel, y, x), optional
    nan : {"propagate", "omit"}
    pixel_size_um : float or None

    Returns
    -------
    dict of str to array
    """
    pixel = pixel_size_um or 1.0
    n_windows = windows.grid.n_windows
    channels: list[str | None] = [None]
    statistics: dict[str, Any] = {}
    status = ["no signal"] * n_windows
    if signal is not None:
        data = sample(windows, signal, nan=nan)
        channels = [str(name) for name in data["channel"].to_numpy()]
        statistics = {name: data[name].to_numpy().ravel() for name in STATISTICS}
        status = np.where(np.isnan(statistics["mean"]), "NaN in signal", "ok").tolist()
    repeats = len(channels)
    rows = n_windows * repeats
    layer, sector = np.divmod(np.tile(np.arange(n_windows), repeats), windows.grid.sectors)
    nothing = np.full(rows, np.nan)
    cell, time, time_s = place
    return {
        "cell": np.full(rows, cell),
        "time": np.full(rows, time),
        "time_s": [time_s] * rows,
        "channel": [name for name in channels for _ in range(n_windows)],
        "layer": layer,
        "sector": sector,
        **{name: statistics.get(name, nothing) for name in STATISTICS},
        "area": np.tile(windows.areas.ravel() * pixel**2, repeats),
        "centroid_y": np.tile(windows.centroids_yx[..., 0].ravel(), repeats),
        "centroid_x": np.tile(windows.centroids_yx[..., 1].ravel(), repeats),
        "eccentricity": np.tile(windows.eccentricities.ravel(), repeats),
        "status": status,
    }


def _since(started: float) -> float:
    return clock.perf_counter() - started
