"""Draw the windows of conditions, and of their difference, on the disk or carried onto a cell."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import Colormap
from matplotlib.patches import Patch, PathPatch
from matplotlib.patheffects import withStroke

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.cell.disk_axes import disk_polygons, frame_disk
from cytodisk.plot.cell.sector_numbers import number_sectors
from cytodisk.plot.cell.window_polygons import (
    add_filled_windows,
    draw_window_means,
    window_polygons,
    window_values,
)
from cytodisk.plot.cell.window_regions import region
from cytodisk.plot.population.difference_map import DifferenceMap
from cytodisk.plot.style import (
    DIVERGING_COLOURS,
    LINE_COLOUR,
    MISSING_COLOUR,
    SIGNAL_COLOURS,
    signal_limits,
)
from cytodisk.windows.polar_windows import CellWindows, PolarGrid

SIGNIFICANT_NAME, CLUSTER_NAME, UNTESTED_NAME, SECTOR_NAME = "significant", "cluster", "not tested", "sector"

_MOST_VECTOR = 3000  # windows; more become pixels inside vector files
_MARGIN = 0.13  # of a cell's longer side
_HATCH, _HATCH_COLOUR = "xxxxx", "0.45"
_FRAME: Any = {"edgecolor": LINE_COLOUR, "linewidth": 0.9}
_AROUND: Any = {"edgecolor": "black", "linewidth": 1.8, "linestyle": (0, (1.6, 1.1))}


def draw_atlas(
    axes: Sequence[Axes],
    atlas: xr.Dataset,
    on: PolarGrid | CellWindows,
    *,
    cmap: str | Colormap = SIGNAL_COLOURS,
    limits: tuple[float, float] | None = None,
    first: int = 0,
) -> list[PolyCollection]:
    """Draw the mean of each condition by window, all in the same colours.

    Parameters
    ----------
    axes : sequence of Axes
        One a condition.
    atlas : Dataset with dims (condition, layer, sector)
        mean; n_cells and n_experiments are written below where they are there.
    on : PolarGrid or CellWindows
        The disk, or a cell onto which the atlas is carried.
    cmap : str or Colormap
    limits : (float, float), optional
        Limits of the colours; by default percentiles 1 and 99.5 of all values.
    first : int
        Sector of the cell that is sector 0 of the atlas, of a cell that was turned.

    Returns
    -------
    list of PolyCollection
        One a condition, one polygon a window.

    Raises
    ------
    ParameterError
        The atlas has other dims, or the axes are not as many as the conditions.
    WindowError
        The atlas is of another grid.

    See Also
    --------
    draw_difference : Beside it, what differs.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import xarray as xr
    >>> import cytodisk as cd
    >>> mean = np.random.default_rng(0).normal(10.0, 1.0, (2, 3, 8))
    >>> dims, names = ("condition", "layer", "sector"), {"condition": ["control", "drug"]}
    >>> atlas = xr.Dataset({"mean": (dims, mean)}, coords=names)
    >>> figure, axes = plt.subplots(1, 2)
    >>> drawn = cd.plot.draw_atlas(axes, atlas, cd.polar_windows(layers=3, sectors=8))
    >>> [ax.get_title() for ax in axes]
    ['control', 'drug']
    """
    mean = atlas["mean"]
    if set(mean.dims) != {"condition", "layer", "sector"}:
        remedy = ": select one, as in atlas.sel(channel=…)" if "channel" in mean.dims else ""
        raise ParameterError(f"atlas must have the dims condition, layer and sector, got {mean.dims}{remedy}")
    if len(axes) != mean.sizes["condition"]:
        raise ParameterError(
            f"axes must be {mean.sizes['condition']}, got {len(axes)}: pass one for each condition"
        )
    tables = mean.transpose("condition", "layer", "sector").to_numpy()
    shown = limits or signal_limits(tables)
    drawn = []
    for ax, table, name in zip(axes, tables, mean["condition"].to_numpy(), strict=True):
        drawn.append(_filled(ax, table, on, cmap, shown, first))
        ax.set_title(str(name), parse_math=False)
        if words := count_words(atlas.sel(condition=name)):
            ax.annotate(
                words,
                (0.5, 0.0),
                xycoords="axes fraction",
                xytext=(
                    0,
                    -12 if isinstance(on, CellWindows) else -4,
                ),  # below the scale bar, or the number of a sector
                textcoords="offset points",
                ha="center",
                va="top",
                annotation_clip=False,
            )
    return drawn


def count_words(of_condition: xr.Dataset) -> str:
    """How many cells and experiments a condition has, line by line; empty if unknown."""
    words = []
    for name, noun in (("n_cells", "cell"), ("n_experiments", "experiment")):
        if name in of_condition:
            count = int(np.nan_to_num(of_condition[name].to_numpy()).max(initial=0))
            words.append(f"{count} {noun}{'' if count == 1 else 's'}")
            if name == "n_experiments" and not count:
                words[-1] = "experiments\nunknown"
    return "\n".join(words)


def draw_difference(
    ax: Axes,
    found: DifferenceMap,
    on: PolarGrid | CellWindows,
    *,
    limit: float | None = None,
    cmap: str | Colormap = DIVERGING_COLOURS,
    first: int = 0,
) -> PolyCollection:
    """Draw the difference of two conditions by window, and what is significant.

    Parameters
    ----------
    ax : Axes
    found : DifferenceMap
    on : PolarGrid or CellWindows
        The disk, or a cell onto which it is carried.
    limit : float, optional
        Colours go from -limit to limit; by default `found.limit`.
    cmap : str or Colormap
    first : int
        Sector of the cell that is sector 0 of the difference, of a cell that was turned.

    Returns
    -------
    PolyCollection
        One polygon a window. The solid line around significant windows has the gid "significant", the thick
        broken one around each cluster "cluster", the hatch over windows that were not tested "not tested".

    Raises
    ------
    WindowError
        The difference is of another grid.

    See Also
    --------
    difference_key : Says what lines and hatch are.
    draw_atlas : The conditions.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import xarray as xr
    >>> import cytodisk as cd
    >>> dims, difference = ("layer", "sector"), np.zeros((3, 8))
    >>> difference[0, :2] = 1.0
    >>> p = np.where(difference > 0, 0.03, 0.8)
    >>> windows = xr.Dataset({"difference": (dims, difference), "p_fwer": (dims, p)})
    >>> found = cd.plot.DifferenceMap.of(windows)
    >>> figure, ax = plt.subplots()
    >>> drawn = cd.plot.draw_difference(ax, found, cd.polar_windows(layers=3, sectors=8))
    """
    top = found.limit if limit is None else limit
    drawn = _filled(ax, found.difference, on, cmap, (-top, top), first)
    polygons = window_polygons(on) if isinstance(on, CellWindows) else disk_polygons(on)

    def covered(windows: Any) -> list[FloatArray]:
        numbers = np.flatnonzero(_turned(windows, on, first).ravel()).tolist()
        return [polygons[number] for number in numbers if len(polygons[number])]

    if untested := covered(~found.tested & np.isfinite(found.difference)):
        style: Any = {"facecolor": "none", "edgecolor": _HATCH_COLOUR, "linewidth": 0.0}
        ax.add_artist(PathPatch(region(untested), hatch=_HATCH, gid=UNTESTED_NAME, **style))
    rim = withStroke(linewidth=3.0, foreground="white")
    for number in np.unique(found.cluster[found.cluster > 0]).tolist():
        around = region(covered(found.cluster == number))
        ax.add_artist(
            PathPatch(around, fill=False, zorder=2.6, gid=CLUSTER_NAME, path_effects=[rim], **_AROUND)
        )
    if significant := covered(found.significant):
        ax.add_artist(PathPatch(region(significant), fill=False, zorder=2.8, gid=SIGNIFICANT_NAME, **_FRAME))
    return drawn


def difference_key(found: DifferenceMap) -> list[Any]:
    """Handles of a legend: what lines, hatch and grey mean, of what is there.

    Parameters
    ----------
    found : DifferenceMap

    Returns
    -------
    list of Artist

    See Also
    --------
    draw_difference : Draws them.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import xarray as xr
    >>> import cytodisk as cd
    >>> windows = xr.Dataset({"difference": (("layer", "sector"), np.zeros((3, 8)))})
    >>> handles = cd.plot.difference_key(cd.plot.DifferenceMap.of(windows))
    >>> [handle.get_label() for handle in handles]
    ['not tested: 24 of 24 windows']
    """
    known, tested = int(np.isfinite(found.difference).sum()), int(found.tested.sum())
    handles: list[Any] = []
    if found.significant.any():
        words = (
            f"window, p ≤ {found.alpha:g} ({found.correction}): {int(found.significant.sum())} of {tested}"
        )
        handles.append(Patch(facecolor="none", label=words, **_FRAME))
    if found.cluster.any():
        words = f"cluster, p ≤ {found.alpha:g}: {int((found.cluster > 0).sum())} windows"
        handles.append(Patch(facecolor="none", label=words, **_AROUND))
    if tested < known:
        words = f"not tested: {known - tested} of {known} windows"
        handles.append(
            Patch(facecolor="white", edgecolor=_HATCH_COLOUR, hatch=_HATCH, linewidth=0.0, label=words)
        )
    if known < found.difference.size:
        handles.append(Patch(facecolor=MISSING_COLOUR, linewidth=0, label="no value"))
    return handles


def _filled(
    ax: Axes,
    table: FloatArray,
    on: PolarGrid | CellWindows,
    cmap: str | Colormap,
    limits: tuple[float, float],
    first: int,
) -> PolyCollection:
    if isinstance(on, CellWindows):
        drawn = draw_window_means(ax, on, _turned(table, on, first), cmap=cmap, limits=limits)
        number_sectors(ax, on, SECTOR_NAME, first=first)
    else:
        values = window_values(table, (on.layers, on.sectors))
        drawn = add_filled_windows(ax, disk_polygons(on), values, cmap, limits)
        frame_disk(ax, on.sectors, on.nucleus_radius, angles=False)
    drawn.set_rasterized(table.size > _MOST_VECTOR)
    return drawn


def _turned(table: Any, on: PolarGrid | CellWindows, first: int) -> Any:
    """A table by the sectors of the cell, whose sector `first` is 0 of the table."""
    return np.roll(table, first, axis=-1) if isinstance(on, CellWindows) else table
