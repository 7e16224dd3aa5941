"""QC flag of windows that are too small to have a mean of their own."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from cytodisk.runs.qc_flags.finest_grid import finest_grid
from cytodisk.runs.qc_flags.qc_flag import QCFlag, frames_of, mapped_rows, places_of
from cytodisk.store.study import Study
from cytodisk.store.window_areas import areas_px
from cytodisk.windows.window_sizes import FEW_PX

LEAST_PX = 1.0
"""A window that is smaller is flagged, however large the others are."""

_LOOKED_AT = 8  # rows with the smallest windows, by which a coarser grid is chosen


def small_windows(study: Study) -> Iterator[QCFlag]:
    """Frames whose median window is below 10 px, or that have windows below 1 px."""
    rows = mapped_rows(study)
    if "median_window_px" not in rows:
        return
    rows = rows[(rows["median_window_px"] < FEW_PX) | (rows["smallest_window_px"] < LEAST_PX)]
    if not len(rows):
        return
    yield QCFlag(
        "small windows",
        f"windows are small in {frames_of(study, len(rows))}: the median down to "
        f"{rows['median_window_px'].min():.2g} px, up to {rows['windows_below_10px'].max():.1%} below 10 px "
        f"and {rows['windows_below_1px'].max():.1%} below 1 px",
        "The mean of a few pixels is noisy. A window below 1 px is a part of a pixel: it shares its value "
        "with its neighbours.",
        _advice(study, rows),
        places_of(rows, _note),
    )


def _note(row: pd.Series[float]) -> str:
    words = f"median {row['median_window_px']:.3g} px, smallest {row['smallest_window_px']:.2g} px"
    between = int(row["windows_between_pixels"])
    return f"{words}, {between} without a pixel's centre" if between else words


def _advice(study: Study, rows: pd.DataFrame) -> str:
    """The finest grid with large enough windows in the rows with the smallest ones, as flags."""
    sizes = ("median_window_px", "smallest_window_px")
    worst = pd.concat([rows.nsmallest(_LOOKED_AT, name) for name in sizes])
    places = {(int(cell), int(frame)) for cell, frame in zip(worst["cell"], worst["frame"], strict=True)}
    by_depth = study.provenance["parameters"].get("depth_um") is not None
    areas = areas_px(study, places)
    for least in (LEAST_PX, 0.0):
        grid = finest_grid(areas, FEW_PX, least, fewer_layers=not by_depth)
        if grid is not None:
            break
    else:
        return "The cell is too small for windows: use its mean."
    layers = "" if by_depth else f"--layers {grid[0]} "
    rest = "" if least else "; a few windows in its thin parts stay below 1 px: leave them out by their area"
    command = "movie" if study.is_movie else "map"
    return f"Use fewer windows: cytodisk {command} … {layers}--sectors {grid[1]}{rest}."
