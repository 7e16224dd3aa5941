"""Draw the peak of each window's correlation, and its lag, on the disk and on the cell.

Windows that chance could explain are pale and hatched, regions of others have an outline, clusters a bold
one, or a thin broken one if they are lost without the controls; windows without a correlation are grey.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.patches import Patch, PathPatch
from matplotlib.patheffects import withStroke

from cytodisk.arrays import FloatArray
from cytodisk.plot.cell.disk_axes import disk_polygons, draw_disk_means
from cytodisk.plot.cell.sector_numbers import number_sectors
from cytodisk.plot.cell.window_polygons import draw_window_means, window_polygons
from cytodisk.plot.cell.window_regions import pieces_of, region
from cytodisk.plot.correlation.correlation_peaks import PeakMap, Shown
from cytodisk.plot.style import LINE_COLOUR, MISSING_COLOUR, TEXT_SIZE
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows, PolarGrid

PALE_NAME, OUTLINE_NAME, SECTOR_NAME = "not significant", "significant", "sector"
CLUSTER_NAME = "cluster"

_PALE = 0.4  # how far windows that are not significant let the page's white through
_HATCH, _HATCH_COLOUR = "/////", "0.5"
_BOLD, _THIN = 1.2, 0.7  # points
_BROKEN = (0, (3.0, 2.0))
_MOST_VECTOR = 3000  # windows; more become pixels inside vector files


def draw_peaks_on_disk(
    ax: Axes,
    peaks: PeakMap,
    grid: PolarGrid,
    shown: Shown = "correlation",
    *,
    limit: float | None = None,
) -> PolyCollection:
    """Draw the correlation at each window's peak, or its lag, on the disk.

    Parameters
    ----------
    ax : Axes
    peaks : PeakMap
    grid : PolarGrid
    shown : {"correlation", "lag"}
    limit : float, optional
        Colours go from -limit to limit; by default `peaks.limit(shown)`.

    Returns
    -------
    PolyCollection
        One polygon a window, by window number, for a colour bar. Windows that are not significant are
        translucent, and covered by a hatch with the gid "not significant"; the outline of the others has
        the gid "significant", that of each cluster, with its number, "cluster". Four sectors have their
        numbers.

    Raises
    ------
    ParameterError
        `shown` is unknown, or the limit is not a positive number.
    WindowError
        The peaks are of another grid.

    See Also
    --------
    draw_peaks_on_cell : The same in the cell.
    peak_key : Says what is pale, framed and grey.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> signal, velocity = cd.simulate.independent_series("ar1", 0, 60, 3, 8)
    >>> correlations = cd.cross_correlate(signal, velocity, max_lag=5, surrogates=99)
    >>> table = cd.peak_correlation(correlations).to_dataframe().reset_index().assign(cell=0)
    >>> grid = cd.polar_windows(layers=3, sectors=8)
    >>> figure, ax = plt.subplots()
    >>> polygons = cd.plot.draw_peaks_on_disk(ax, cd.plot.PeakMap.of(table, grid), grid)
    """
    values, colours, limits = peaks.picture(shown, limit)
    drawn = draw_disk_means(ax, grid, values, cmap=colours, limits=limits, number_sectors=True)
    _fade(ax, disk_polygons(grid), peaks, drawn)
    _outline_clusters(ax, disk_polygons(grid), peaks)
    return drawn


def draw_peaks_on_cell(
    ax: Axes,
    peaks: PeakMap,
    windows: CellWindows,
    shown: Shown = "correlation",
    *,
    limit: float | None = None,
    scale: Scale | None = None,
) -> PolyCollection:
    """Draw the correlation at each window's peak, or its lag, on the cell.

    Parameters
    ----------
    ax : Axes
    peaks : PeakMap
    windows : CellWindows
        Windows of the frame to draw on.
    shown : {"correlation", "lag"}
    limit : float, optional
        Colours go from -limit to limit; by default `peaks.limit(shown)`.
    scale : Scale, optional
        By default that of the windows; without a pixel size the scale bar is in px.

    Returns
    -------
    PolyCollection
        As of `draw_peaks_on_disk`; numbers of sectors, with the gid "sector", stand where they begin.

    Raises
    ------
    ParameterError
        `shown` is unknown, or the limit is not positive.
    WindowError
        The peaks are of another grid.

    See Also
    --------
    draw_peaks_on_disk : The same on the disk.
    peak_key : Says what is pale, framed and grey.

    References
    ----------
    u-Unwrap, Fig. 5G.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> signal, velocity = cd.simulate.independent_series("ar1", 0, 60, 3, 8)
    >>> correlations = cd.cross_correlate(signal, velocity, max_lag=5, surrogates=99)
    >>> table = cd.peak_correlation(correlations).to_dataframe().reset_index().assign(cell=0)
    >>> grid = cd.polar_windows(layers=3, sectors=8)
    >>> windows = grid.on(cd.map_to_disk(cd.simulate.disk(12)))
    >>> figure, ax = plt.subplots()
    >>> polygons = cd.plot.draw_peaks_on_cell(ax, cd.plot.PeakMap.of(table, grid), windows, "lag")
    """
    values, colours, limits = peaks.picture(shown, limit)
    drawn = draw_window_means(ax, windows, values, cmap=colours, limits=limits, scale=scale)
    _fade(ax, window_polygons(windows), peaks, drawn)
    _outline_clusters(ax, window_polygons(windows), peaks)
    number_sectors(ax, windows, SECTOR_NAME, scale=scale)
    return drawn


def peak_key(peaks: PeakMap, *, partial: str = "without controls") -> list[Any]:
    """Handles of a legend: what is pale, framed and grey, of windows that are there.

    Parameters
    ----------
    peaks : PeakMap
    partial : str
        What was regressed out, such as "without geometry".

    Returns
    -------
    list of Artist

    See Also
    --------
    draw_peaks_on_cell, draw_peaks_on_disk : Draw the peaks.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> signal, velocity = cd.simulate.independent_series("ar1", 0, 60, 3, 8)
    >>> correlations = cd.cross_correlate(signal, velocity, max_lag=5, surrogates=99)
    >>> table = cd.peak_correlation(correlations).to_dataframe().reset_index().assign(cell=0)
    >>> peaks = cd.plot.PeakMap.of(table, cd.polar_windows(layers=3, sectors=8))
    >>> legend = plt.figure().legend(handles=cd.plot.peak_key(peaks))
    """
    handles: list[Any] = []
    pale, known = int(peaks.pale.sum()), int(np.isfinite(peaks.correlation).sum())
    if pale:
        frame: Any = {"facecolor": "white", "linewidth": 0.6}
        words = f"not significant (q ≥ {peaks.alpha:g}): {pale} of {known}"
        handles.append(Patch(label=words, hatch=_HATCH, **frame | {"edgecolor": _HATCH_COLOUR}))
        if pale < known:
            handles.append(Patch(label=f"q < {peaks.alpha:g}", **frame | {"edgecolor": LINE_COLOUR}))
    drawn = set() if peaks.cluster is None else set(np.unique(peaks.cluster).tolist()) - {0}
    for lost, words in ((False, "cluster, p ≤ 0.05"), (True, f"cluster, not {partial}")):
        if drawn & set(peaks.lost) if lost else drawn - set(peaks.lost):
            around: Any = {"facecolor": "none", "edgecolor": "black"} | _cluster_line(lost)
            handles.append(Patch(label=words, **around))
    if known < peaks.correlation.size:
        handles.append(Patch(facecolor=MISSING_COLOUR, linewidth=0, label="none, or not used"))
    return handles


def _fade(ax: Axes, polygons_xy: Sequence[FloatArray], peaks: PeakMap, drawn: PolyCollection) -> None:
    """Make windows that are not significant paler and hatch them, and frame regions of the others."""
    pale = peaks.pale.ravel()
    drawn.set_rasterized(len(polygons_xy) > _MOST_VECTOR)
    if not pale.any() or peaks.significant is None:
        return
    # Arrays are allowed, whatever the stubs say: colour bars take no notice of them, but of lists.
    drawn.set_alpha(np.where(pale, 1.0 - _PALE, 1.0))  # type: ignore[arg-type]
    drawn.set_linewidth(np.where(pale, 0.0, 0.2).tolist())  # translucent lines would be darker than areas
    covered = [polygons_xy[number] for number in np.flatnonzero(pale).tolist()]
    style: Any = {"facecolor": "none", "edgecolor": _HATCH_COLOUR, "linewidth": 0.0}
    hatched = PathPatch(region(covered), hatch=_HATCH, gid=PALE_NAME, **style)
    ax.add_artist(hatched)
    others = [polygons_xy[number] for number in np.flatnonzero(peaks.significant.ravel()).tolist()]
    if others:
        framed: Any = {"fill": False, "edgecolor": LINE_COLOUR, "linewidth": 0.6, "zorder": 2.5}
        ax.add_artist(PathPatch(region(others), gid=OUTLINE_NAME, **framed))


def _outline_clusters(ax: Axes, polygons_xy: Sequence[FloatArray], peaks: PeakMap) -> None:
    """A line with a white rim around each cluster, bold if it survives, and its number."""
    if peaks.cluster is None:
        return
    rim = withStroke(linewidth=2.2 * _BOLD, foreground="white")
    for number in np.unique(peaks.cluster[peaks.cluster > 0]).tolist():
        members = np.flatnonzero(peaks.cluster.ravel() == number).tolist()
        covered = [polygons_xy[member] for member in members]
        style = {"fill": False, "edgecolor": "black", "zorder": 2.7} | _cluster_line(number in peaks.lost)
        ax.add_artist(PathPatch(region(covered), path_effects=[rim], gid=CLUSTER_NAME, **style))
        largest = max(pieces_of(covered), key=lambda piece: piece.area)
        place = largest.representative_point()
        weight = "normal" if number in peaks.lost else "bold"
        words: Any = {"fontsize": TEXT_SIZE, "fontweight": weight, "ha": "center", "va": "center"}
        ax.text(place.x, place.y, str(number), zorder=2.8, gid=CLUSTER_NAME, path_effects=[rim], **words)


def _cluster_line(lost: bool) -> dict[str, Any]:
    return {"linewidth": _THIN, "linestyle": _BROKEN} if lost else {"linewidth": _BOLD}
