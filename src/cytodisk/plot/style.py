"""How figures look: sizes of a printed page, colours, scale bar and colour bar."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Colormap
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator, ScalarFormatter
from matplotlib.transforms import ScaledTranslation

from cytodisk.arrays import BoolArray
from cytodisk.checks import positive_number
from cytodisk.errors import ParameterError
from cytodisk.scale import Scale

SINGLE_COLUMN_MM = 85.0
WIDE_MM = 119.0
"""Width of a page that needs more room: at 85 mm its text of 7 points still has 5, which print asks for."""
MM_PER_INCH = 25.4
DPI = 300

SIGNAL_COLOURS = "viridis"
DIVERGING_COLOURS = "RdBu_r"
LAYER_COLOURS = "plasma"
MISSING_COLOUR = "0.85"
CHANCE_COLOUR, CHANCE_LINE = "0.93", "0.7"  # of the band that chance gives, and of its border
LINE_COLOUR = "0.15"
OUTWARD_COLOUR, INWARD_COLOUR = "#B2182B", "#2166AC"  # near the ends of the diverging colours
STATUS_COLOURS = {"ok": "#0072B2", "refused": "#E69F00", "unreadable": "#999999"}

TEXT_SIZE, TITLE_SIZE, NUMBER_SIZE = 7.0, 7.5, 6.0  # points: of text, above a panel, of sectors on a column
HEADING: Any = {"fontsize": 8.0, "weight": "bold"}  # of a page
STAMP: Any = {"fontsize": 9.0}  # of a frame of an animation

PAPER: Any = {
    "font.family": "sans-serif",
    "font.size": TEXT_SIZE,
    "axes.titlesize": TITLE_SIZE,
    "axes.labelsize": TEXT_SIZE,
    "xtick.labelsize": TEXT_SIZE,
    "ytick.labelsize": TEXT_SIZE,
    "legend.fontsize": TEXT_SIZE,
    "axes.linewidth": 0.5,
    "xtick.major.width": 0.5,
    "ytick.major.width": 0.5,
    "xtick.major.size": 2.0,
    "ytick.major.size": 2.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "hatch.linewidth": 0.3,
    "savefig.facecolor": "white",
    "svg.fonttype": "none",  # text stays text in vector files
    "svg.hashsalt": "cytodisk",  # the same picture is the same file
    "pdf.fonttype": 42,
}
"""Matplotlib settings for print."""

_PERCENTILES = (1.0, 99.5)
_BAR_SHARE = 0.3  # of the axes' width, or of half their height, that a scale bar may take
_BAR_BELOW = 5.0  # points from the axes to the bar
_BAR_NAME = "scale bar"


class _PlainNumbers(ScalarFormatter):
    """Numbers as plain text, which is set far faster than formulas; a common power of ten is a formula."""

    def get_offset(self) -> str:
        self.set_useMathText(True)
        power = super().get_offset()
        self.set_useMathText(False)
        return power


def plain_numbers() -> ScalarFormatter:
    """Numbers of an axis that stay short: from 10 000 on, and below 0.001, a power of ten stands apart."""
    numbers = _PlainNumbers(useMathText=False)
    numbers.set_powerlimits((-3, 4))
    return numbers


@contextmanager
def paper_style() -> Iterator[None]:
    """Apply `PAPER` to what is made inside the block.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> with cd.plot.paper_style():
    ...     figure, ax = plt.subplots(figsize=(3.35, 2))
    ...     _ = ax.set_title("sizes of a printed page")
    ...
    """
    with mpl.rc_context(PAPER):
        yield


def colour_map(name: str | Colormap) -> Colormap:
    """A colour map that shows missing values in light grey.

    Parameters
    ----------
    name : str or Colormap

    Returns
    -------
    Colormap

    Raises
    ------
    ParameterError
        Matplotlib has no colour map of this name.
    """
    if isinstance(name, str) and name not in mpl.colormaps:
        raise ParameterError(
            f"cmap {name!r} is not a colour map: pass one of Matplotlib's, such as 'viridis'"
        )
    base = mpl.colormaps[name] if isinstance(name, str) else name
    return base.with_extremes(bad=MISSING_COLOUR)


def signal_limits(values: Any, mask: BoolArray | None = None) -> tuple[float, float]:
    """Limits of the colours for a signal: its percentiles 1 and 99.5, inside the cell if its mask is given.

    Parameters
    ----------
    values : array_like
    mask : ndarray of the values' shape and dtype bool, optional

    Returns
    -------
    (float, float)
        In the signal's unit, the second above the first; (0, 1) when none is finite.
    """
    inside = np.asarray(values, dtype=np.float64)
    inside = inside if mask is None else inside[mask]
    inside = inside[np.isfinite(inside)]
    if not inside.size:
        return 0.0, 1.0
    low, high = np.percentile(inside, _PERCENTILES).tolist()
    if high > low:
        return low, high
    half = 0.5 * max(abs(low), 1.0)
    return low - half, high + half


def nice_length(longest: float) -> float:
    """The longest of 1, 2, 5 times a power of ten that is not above a length.

    Parameters
    ----------
    longest : float
        Above 0.

    Returns
    -------
    float
        In the same unit.

    Raises
    ------
    ParameterError
        `longest` is not a positive number.
    """
    longest = positive_number("longest", longest)
    power = 10.0 ** np.floor(np.log10(longest))
    return float(max(step * power for step in (0.5, 1.0, 2.0, 5.0) if step * power <= longest * (1 + 1e-9)))


def scale_bar(ax: Axes, scale: Scale | None = None) -> tuple[Line2D, Text]:
    """Draw a bar of round length below axes whose x is in pixels; a former bar gives way.

    Parameters
    ----------
    ax : Axes
        With its limits set.
    scale : Scale, optional
        Without a pixel size the bar is in px.

    Returns
    -------
    (Line2D, Text)

    See Also
    --------
    frame_cell : Fits axes to a cell and draws the bar.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> _ = ax.imshow(cd.simulate.disk(40))
    >>> line, text = cd.plot.scale_bar(ax)
    >>> text.get_text()
    '20 px'
    """
    for artist in (*ax.lines, *ax.texts):
        if artist.get_gid() == _BAR_NAME:
            artist.remove()
    left, right = ax.get_xlim()
    scale = scale or Scale()
    size = scale.length(1.0)
    width, height = abs(right - left), abs(np.subtract(*ax.get_ylim()))
    length = nice_length(size * min(width, _BAR_SHARE * max(width, 0.5 * height)))
    stop = left + np.copysign(length / size, right - left)
    below = ScaledTranslation(0.0, -_BAR_BELOW / 72.0, ax.figure.dpi_scale_trans)
    across = ax.get_xaxis_transform() + below
    (bar,) = ax.plot([left, stop], [0.0, 0.0], color=LINE_COLOUR, linewidth=1.5, transform=across)
    bar.set(clip_on=False, solid_capstyle="butt", gid=_BAR_NAME)
    text = ax.annotate(
        f"{length:g} {scale.length_unit}",
        (stop, 0.0),
        xycoords=across,
        xytext=(3, 0),
        textcoords="offset points",
        va="center_baseline",
        annotation_clip=False,
    )
    text.set_gid(_BAR_NAME)
    return bar, text


def colour_bar(
    mappable: ScalarMappable,
    into: Axes,
    label: str,
    unit: str | None = None,
    *,
    extend: str = "neither",
    upright: bool = True,
) -> Colorbar:
    """Draw a colour bar with its label and unit.

    Parameters
    ----------
    mappable : ScalarMappable
        What the colours stand for.
    into : Axes
        Filled by the colour bar.
    label : str
        Taken literally, a dollar sign too.
    unit : str, optional
        Follows the label in brackets.
    extend : {"neither", "both", "min", "max"}
        At which ends values are cut off.
    upright : bool
        Or from left to right.

    Returns
    -------
    Colorbar

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> drawn = ax.imshow([[0, 1], [2, 3]])
    >>> bar = cd.plot.colour_bar(drawn, ax, "signal")
    """
    way = "vertical" if upright else "horizontal"
    bar = into.figure.colorbar(mappable, cax=into, extend=extend, extendfrac=0.04, orientation=way)
    bar.set_label(f"{label} ({unit})" if unit else label, parse_math=False)
    bar.outline.set_linewidth(0.4)
    bar.ax.tick_params(width=0.4, length=2)
    bar.locator = MaxNLocator(5, steps=[1, 2, 2.5, 5, 10])
    bar.formatter = plain_numbers()
    bar.update_ticks()
    return bar


def key_above(ax: Axes) -> None:
    """Draw a legend of two columns above the axes, where no line can run through it."""
    ax.legend(frameon=False, ncols=2, loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.1)
