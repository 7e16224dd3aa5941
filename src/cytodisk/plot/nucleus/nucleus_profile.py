"""Draw a signal from the nucleus' centre to the membrane, with both borders marked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, get_args

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray
from cytodisk.checks import one_of
from cytodisk.errors import ParameterError
from cytodisk.number_words import rounded
from cytodisk.plot.layer_looks import CYTOPLASM_COLOURS, NUCLEUS_COLOURS
from cytodisk.plot.nucleus.layer_profile import LayerProfile
from cytodisk.plot.style import LINE_COLOUR
from cytodisk.plot.time_axis import TICK_STEPS
from cytodisk.plot.units import with_unit

Along = Literal["layer", "share", "distance"]
CHANNEL_COLOURS = ("#009E73", "#D55E00", "#CC79A7", "#000000")  # of Okabe and Ito
_MARKERS = ("o", "s", "^", "D")
_NUCLEUS_SHADE, _CYTOPLASM_SHADE = NUCLEUS_COLOURS(1.0), CYTOPLASM_COLOURS(1.0)
_SHADE, _BAND = 0.3, 0.2  # opacity
_BORDER: Any = {"color": LINE_COLOUR, "linewidth": 0.8}
_MOST_TICKS = 12


def draw_nucleus_profile(
    ax: Axes,
    data: xr.Dataset,
    *,
    along: Along = "layer",
    relative: bool = False,
    colors: Sequence[str] = CHANNEL_COLOURS,
) -> list[Line2D]:
    """Draw a signal by layer, from the nucleus' centre on the left to the membrane on the right.

    The nuclear outline and the membrane are the two upright lines. A line is the mean of each layer, its band
    the quartiles of the sectors.

    Parameters
    ----------
    ax : Axes
    data : Dataset with dims (layer, sector), and channel or time
        Of `sample` or `sample_movie`, on maps with a nucleus. Frames are averaged.
    along : {"layer", "share", "distance"}
        What goes to the right: layers in equal steps, with the depth of each below; the share of the cell's
        area from the nucleus' centre out; or the distance to the nuclear outline, negative in the nucleus.
    relative : bool
        Divide each channel by its mean over the cell, so that channels of other brightness compare.
    colors : sequence of str
        One a channel.

    Returns
    -------
    list of Line2D
        One a channel.

    Raises
    ------
    WindowError
        The data have no layers of a nucleus.
    ParameterError
        They are no Dataset, or have more channels than there are colours.

    See Also
    --------
    draw_nucleus : The nuclear outline in the cell.
    nuclear_profile : The same as numbers.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> cell = cd.simulate.cell_with_nucleus("off centre")
    >>> signal = cd.simulate.profile_signal(cell.mask, cell.nucleus, lambda place: 100 + 50 * place)
    >>> disk = cd.map_to_disk(cell.mask, nucleus=cell.nucleus)
    >>> windows = cd.polar_windows(layers=5, sectors=12, nucleus_layers=2).on(disk)
    >>> figure, ax = plt.subplots()
    >>> (line,) = cd.plot.draw_nucleus_profile(ax, cd.sample(windows, signal))
    >>> len(line.get_xdata())  # layers
    7
    """
    one_of("along", along, get_args(Along))
    profile = LayerProfile.of(data)
    profile = profile.relative if relative else profile
    if len(profile.channels) > len(colors):
        raise ParameterError(
            f"data has {len(profile.channels)} channels for {len(colors)} colours: select channels, "
            "or pass more colors"
        )
    places, borders = _places(profile, along)
    shade_compartments(ax, borders)
    order, lines = np.argsort(places, kind="stable"), []
    for k, (name, colour) in enumerate(zip(profile.channels, colors, strict=False)):
        low, high = profile.low[k, order], profile.high[k, order]
        ax.fill_between(places[order], low, high, color=colour, alpha=_BAND, linewidth=0)
        style: Any = {"marker": _MARKERS[k % len(_MARKERS)], "markersize": 2.8, "linewidth": 1.0}
        lines += ax.plot(places[order], profile.values[k, order], color=colour, label=name, **style)
    _label(ax, profile, along, places)
    ax.set_xlim(borders[0], borders[-1])
    ax.set_ylabel("mean / mean of the cell" if relative else with_unit("mean", profile.units["mean"]))
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    return lines


def _places(profile: LayerProfile, along: Along) -> tuple[FloatArray, tuple[float, float, float]]:
    """Where each layer lies on the axis; and where that begins, the nuclear outline and the membrane."""
    outer = profile.cytoplasm_layers
    if along == "layer":
        top = float(profile.layers)
        return np.asarray(top - 0.5 - np.arange(profile.layers)), (0.0, top - outer, top)
    if along == "share":
        share = 100.0 * profile.area / profile.area.sum()
        inner = 100.0 - np.cumsum(share)
        return inner + 0.5 * share, (0.0, float(share[outer:].sum()), 100.0)
    places = np.where(np.arange(profile.layers) < outer, profile.distance, -profile.distance)
    margin = 0.04 * (profile.thickness - places.min())
    membrane = max(profile.thickness, float(np.nanmax(places)))
    return np.asarray(places), (float(places.min() - margin), 0.0, membrane)


def shade_compartments(ax: Axes, borders: tuple[float, float, float]) -> None:
    """Both compartments in their hues and with their names, and the two borders."""
    centre, outline, membrane = borders
    ax.axvspan(centre, outline, color=_NUCLEUS_SHADE, alpha=_SHADE, linewidth=0, zorder=-2)
    ax.axvspan(outline, membrane, color=_CYTOPLASM_SHADE, alpha=2 * _SHADE, linewidth=0, zorder=-2)
    ax.axvline(outline, **_BORDER)
    ax.axvline(membrane, clip_on=False, **_BORDER)
    above: Any = {"xycoords": ax.get_xaxis_transform(), "textcoords": "offset points", "va": "bottom"}
    for x, words in ((0.5 * (centre + outline), "nucleus"), (0.5 * (outline + membrane), "cytoplasm")):
        ax.annotate(words, (x, 1.0), xytext=(0, 2), ha="center", annotation_clip=False, **above)
    ax.annotate(
        "membrane", (membrane, 0.5), xytext=(2, 0), rotation=90, ha="left", **above | {"va": "center"}
    )


def _label(ax: Axes, profile: LayerProfile, along: Along, places: FloatArray) -> None:
    unit = profile.units["depth"]
    if along == "share":
        ax.set_xlabel("share of the cell's area from the nucleus' centre (%)")
        return
    if along == "distance":
        ax.set_xlabel(f"distance to the nuclear outline ({unit})")
        return
    every = -(-profile.layers // _MOST_TICKS)
    shown = range(0, profile.layers, every)
    ax.set_xticks(places[shown], [f"{layer}\n{_short(profile.depth[layer])}" for layer in shown])
    ax.tick_params(axis="x", length=0)
    ax.set_xlabel(f"layer, and below it its depth ({unit})")


def _short(depth: float) -> str:
    return rounded(depth, 2) if np.isfinite(depth) else ""
