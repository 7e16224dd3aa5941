"""QC flag of windows that are too small to have a mean of their own."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.number_words import rounded
from cytodisk.runs.qc_flags.finest_grid import finest_grid, finest_grid_with_nucleus
from cytodisk.runs.qc_flags.qc_flag import QCFlag, frames_of, mapped_rows, places_of
from cytodisk.runs.qc_flags.remedy import run_again
from cytodisk.store.study import Study
from cytodisk.store.window_areas import areas_px
from cytodisk.windows.window_sizes import FEW_PX

LEAST_PX = 1.0
"""A window that is smaller is flagged, however large the others are."""

_FEWEST_SECTORS = 4  # that a layer by depth must have pixels for
_FAR_MORE = 2  # times as many sectors that the cytoplasm alone could have
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
        f"{rounded(rows['median_window_px'].min(), 2)} px, "
        f"up to {percent(rows['windows_below_10px'].max())} below 10 px"
        + _below_1px(rows["windows_below_1px"].max()),
        "The mean of a few pixels is noisy. A window below 1 px is a part of a pixel: it shares its value "
        "with its neighbours.",
        _advice(study, rows),
        places_of(rows, _note),
    )


def _below_1px(share: float) -> str:
    return f" and {percent(share)} below 1 px" if share > 0 else ""


def percent(share: float) -> str:
    """A share in percent: only all is 100%, only none is 0%."""
    if share in (0.0, 1.0):
        return f"{share:.0%}"
    if share < 0.0005:
        return "less than 0.1%"
    return "more than 99.9%" if share > 0.9995 else f"{share:.1%}"


def _note(row: pd.Series[float]) -> str:
    words = (
        f"median {rounded(row['median_window_px'])} px, smallest {rounded(row['smallest_window_px'], 2)} px"
    )
    between = int(row["windows_between_pixels"])
    return f"{words}, {between} without a pixel's centre" if between else words


def _idle_border(areas: list[FloatArray], depths: Sequence[float]) -> str:
    """The border whose layer has too few pixels for a few sectors in some frame; empty if there is none."""
    n_layers = len(depths) + 1  # and those of a nucleus
    of_layer = np.stack([area[:n_layers].sum(axis=1) for area in areas])  # deeper than the cell there is none
    smallest = np.where(of_layer > 0.0, of_layer, np.inf).min(axis=0)
    thin = int(smallest.argmin())
    if smallest[thin] >= _FEWEST_SECTORS * FEW_PX:
        return ""
    return f"{depths[max(thin - 1, 0)]:g}"


def _advice(study: Study, rows: pd.DataFrame) -> str:
    """The finest grid with large enough windows in the rows with the smallest ones, as flags."""
    sizes = ("median_window_px", "smallest_window_px")
    worst = pd.concat([rows.nsmallest(_LOOKED_AT, name) for name in sizes])
    places = {(int(cell), int(frame)) for cell, frame in zip(worst["cell"], worst["frame"], strict=True)}
    depths = study.provenance["parameters"].get("depth_um")
    by_depth = depths is not None
    areas = areas_px(study, places)
    if isinstance(depths, list | tuple) and (border := _idle_border(areas, depths)):
        return (
            f"Leave out {border} of --depth-um: windows between it and the next border hold too few pixels."
        )
    in_nucleus = study.provenance["parameters"].get("nucleus_layers") or 0
    for least in (LEAST_PX, 0.0):
        changes = _coarser(areas, in_nucleus, least, by_depth)
        if changes:
            break
    else:
        return nucleus_words(areas, in_nucleus, 0, by_depth) or (
            "The cell is too small for windows: use its mean."
        )
    rest = "" if least else " (a few windows in its thin parts stay below 1 px: leave them out by their area)"
    again = run_again(study, "x".join(str(number) for number in changes.values()), **changes)
    alone = nucleus_words(areas, in_nucleus, changes["sectors"], by_depth)
    return f"{alone}{' Or use' if alone else 'Use'} fewer windows{rest}: {again}"


def nucleus_words(areas: list[FloatArray], in_nucleus: int, sectors: int, by_depth: bool) -> str:
    """What to do where the nucleus alone is small, so that both would get few sectors; else empty.

    Parameters
    ----------
    areas : list of ndarray of shape (layers, sectors) and dtype float
        Of windows in square pixels, by frame.
    in_nucleus : int
        How many of the layers, the last ones, are in the nucleus.
    sectors : int
        Those of the grid that suits cytoplasm and nucleus; 0 if none does.
    by_depth : bool
        Whether layers are by depth.
    """
    outer = _coarser([area[:-in_nucleus] for area in areas], 0, LEAST_PX, by_depth) if in_nucleus else {}
    if not outer or outer["sectors"] < _FAR_MORE * max(sectors, 1):
        return ""
    layers, of_cytoplasm = len(areas[0]) - in_nucleus, outer.get("layers")
    grid = f"--sectors {outer['sectors']}"
    if of_cytoplasm is not None and of_cytoplasm < layers:
        grid = f"--layers {of_cytoplasm} {grid}"
    return (
        f"The nucleus is what is small: for the cytoplasm {grid} will do, if you leave windows of the "
        "nucleus out."
    )


def _coarser(areas: list[FloatArray], in_nucleus: int, least_px: float, by_depth: bool) -> dict[str, int]:
    """Layers and sectors of a grid whose windows are large enough; empty if there is none."""
    fewer_layers = not by_depth
    grid: tuple[int, ...] | None
    if in_nucleus:
        grid = finest_grid_with_nucleus(areas, in_nucleus, FEW_PX, least_px, fewer_layers=fewer_layers)
    else:
        grid = finest_grid(areas, FEW_PX, least_px, fewer_layers=fewer_layers)
    changes = dict(zip(("layers", "sectors", "nucleus_layers"), grid or (), strict=False))
    return {name: count for name, count in changes.items() if fewer_layers or name != "layers"}
