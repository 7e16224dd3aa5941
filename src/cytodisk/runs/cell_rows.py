"""Cells of a run: map them, sample them, and put the results into rows."""

import json
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np
import xarray as xr

from cytodisk.analysis.activity import STATISTICS
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.mapping_parameters import Align, MappingParameters
from cytodisk.errors import CytodiskError, EmptyMaskError, ReadError, SignalError
from cytodisk.files import replacing
from cytodisk.geometry.polygon import centroid, edge_lengths, smooth_closed
from cytodisk.images.mask_files import SourceCell
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.scale import Scale
from cytodisk.store.study_folder import StudyFolder, figures_folder, part_key
from cytodisk.windows.polar_windows import CellWindows, polar_windows
from cytodisk.windows.sample import sample

DrawCell: TypeAlias = Callable[[Path, str, CellWindows, xr.DataArray | None, Scale], list[Path]]

_PERIMETER_SMOOTHING_PX = 1.0


@dataclass(frozen=True)
class CellTask:
    """One cell with its signal.

    Attributes
    ----------
    found : SourceCell
    signal : DataArray with dims (channel, y, x), or None
        Cut out as the cell's mask is.
    fault : CytodiskError or None
        Why the signal cannot be used.
    image : DataArray with dims (channel, y, x), or None
        The whole image, for a cell that is drawn.
    drawn : bool
    """

    found: SourceCell
    signal: xr.DataArray | None
    fault: CytodiskError | None
    image: xr.DataArray | None
    drawn: bool


@dataclass(frozen=True)
class CellSettings:
    """What is the same for all cells of a run.

    Attributes
    ----------
    parameters : MapParameters
    pixel_size_um : float or None
    folder : StudyFolder
        Where results go.
    draw : callable, optional
        As `map_study` takes it.
    maps, geojson : bool
        Whether maps, and outlines of windows, are written.
    """

    parameters: MapParameters
    pixel_size_um: float | None
    folder: StudyFolder
    draw: DrawCell | None
    maps: bool
    geojson: bool


Rows: TypeAlias = tuple[dict[str, Any], dict[str, dict[str, Any]]]


def measure_part(cells: Sequence[CellTask], settings: CellSettings) -> int:
    """Map and sample some cells, and write them as one part of the study.

    Parameters
    ----------
    cells : sequence of CellTask
        At least one.
    settings : CellSettings

    Returns
    -------
    int
        How many cells are done.

    Raises
    ------
    StudyError
        A result cannot be written.
    """
    key = part_key(cells[0].found.cell)
    settings.folder.add_cells(key, [_measure_cell(task, settings) for task in cells])
    return len(cells)


def _measure_cell(task: CellTask, settings: CellSettings) -> Rows:
    """Rows of one cell; a fault of its input becomes a row with the reason."""
    started = clock.perf_counter()
    found, parameters = task.found, settings.parameters
    row: dict[str, Any] = {"cell": found.cell, "source": found.source}
    row |= {"frame": found.frame, "label": found.label}
    fault = found.fault or task.fault
    if fault is None:
        try:
            mapping = dict(parameters.part(MappingParameters))
            mapping["align"] = _in_crop(parameters.align, found.corner)
            disk = map_to_disk(found.mask, **mapping, pixel_size_um=settings.pixel_size_um)
        except CytodiskError as error:
            fault = error
    if fault is not None:
        return row | {"status": status_of(fault), "reason": str(fault), "seconds": _since(started)}, {}

    windows = polar_windows(parameters.layers, parameters.sectors, parameters.spacing).on(disk)
    place = found.cell, found.frame, None
    columns = window_columns(place, windows, task.signal, parameters.nan, settings.pixel_size_um)
    row |= cell_columns(disk, windows, task.signal, settings.pixel_size_um)
    for values in (columns, row):
        for name, first in zip(("centroid_y", "centroid_x"), found.corner, strict=True):
            values[name] = values[name] + float(first)
    placed = windows
    if settings.maps or settings.geojson or task.drawn:  # in pixels of the whole image
        placed = windows.grid.on(disk.placed(found.corner, found.image_shape))
        _write_map(placed, settings.folder.map_path(part_key(found.cell)), settings)
    seconds = _since(started)
    if task.drawn and settings.draw is not None:
        name = f"cell_{found.cell:05d}"
        image = None if task.image is None else task.image.astype(np.float64)
        settings.draw(
            figures_folder(settings.folder.path), name, placed, image, Scale(settings.pixel_size_um)
        )
    return row | {"status": "ok", "reason": "", "seconds": seconds}, {"windows": columns}


def status_of(fault: CytodiskError) -> str:
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


def _write_map(windows: CellWindows, path: Path, settings: CellSettings) -> None:
    if settings.maps:
        windows.disk.save(path)
    if settings.geojson:
        with replacing(path.with_suffix(".geojson")) as temporary:
            temporary.write_text(json.dumps(windows.geojson()), encoding="utf-8")


def _in_crop(align: Align, corner: tuple[int, int]) -> Align:
    if isinstance(align, tuple):
        return align[0] - corner[0], align[1] - corner[1]
    return align


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
        "qc_flags": "; ".join(report.qc_flags),
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
        "frame": np.full(rows, time),
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
