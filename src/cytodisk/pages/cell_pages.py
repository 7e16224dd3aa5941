"""The pictures of a study: one page a cell."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError
from cytodisk.pages.figure_formats import chosen_formats, save_in_formats
from cytodisk.pages.grid_words import grid_words
from cytodisk.pages.sheet import BOLD_MM, Sheet, broken_lines
from cytodisk.plot.cell.area_distortion import draw_area_distortion, draw_area_spread
from cytodisk.plot.cell.cell_axes import draw_cell, draw_mesh, draw_outline, frame_cell
from cytodisk.plot.cell.disk_axes import draw_disk_image, draw_disk_means, draw_disk_mesh, draw_disk_windows
from cytodisk.plot.cell.grid_look import line_opacity, line_width
from cytodisk.plot.cell.hole_marks import cover_holes
from cytodisk.plot.cell.window_polygons import draw_window_means, draw_windows
from cytodisk.plot.nucleus.nucleus_profile import draw_nucleus_profile
from cytodisk.plot.style import SIGNAL_COLOURS, SINGLE_COLUMN_MM, colour_bar, paper_style, signal_limits
from cytodisk.plot.units import scale_for
from cytodisk.runs.channel_names import shortened, shown_name
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows
from cytodisk.windows.sample import sample

_MOST_CHANNELS = 3
_LONGEST_CHANNEL = 16
_PANELS = ((4, 42.0), (6, 36.0), (99, 31.0))  # rows up to which panels have this width in mm
_GAP, _LEFT, _BAR = 4.0, 5.0, 14.0  # mm
_TOP, _LINE, _HEADING, _BELOW = 7.0, 3.6, 4.5, 6.0  # mm: name, facts, headings of panels, scale bars
_PROFILE_LEFT = 8.0  # mm, for the numbers of its axis
_TALLEST = 1.45  # height of a panel over its width


def write_cell_figures(
    folder: Path,
    name: str,
    windows: CellWindows,
    signal: xr.DataArray | None,
    scale: Scale | None = None,
    heading: str = "",
    formats: Sequence[str] = ("png",),
) -> list[Path]:
    """Write the page of one cell: signal and means in cell and disk by channel, mesh and area distortion.

    Without a signal the windows are drawn in the colours of their layers. With a signal and a nucleus they
    are so too, above the signal by layer from the nucleus' centre to the membrane.

    Parameters
    ----------
    folder : Path
        Exists already.
    name : str
        Name of the cell; a file is `<name>.<format>`, 85 to 119 mm wide at 300 dots per inch.
    windows : CellWindows
    signal : DataArray with dims (channel,) y, x, or None
        One frame. The first three channels are drawn.
    scale : Scale, optional
        By default that of the windows; without a pixel size scale bars are in px.
    heading : str
        What stands above the pictures; by default the name.
    formats : sequence of {"png", "pdf", "svg"}
        Text stays text in the last two.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    SignalError
        The signal does not fit the mask.
    ParameterError
        The name cannot be a file's, or a format is unknown.
    StudyError
        The folder cannot be written.

    Examples
    --------
    >>> from pathlib import Path
    >>> import cytodisk as cd
    >>> windows = cd.polar_windows(layers=3, sectors=8).on(cd.map_to_disk(cd.simulate.disk(12)))
    >>> files = cd.pages.write_cell_figures(Path("."), "cell", windows, None, None)
    >>> [file.name for file in files]
    ['cell.png']
    """
    if not name or Path(name).name != name:
        raise ParameterError(f"name must be a file name without folders, got {name!r}: pass the cell's name")
    chosen = chosen_formats(formats)
    known = scale_for(windows, scale)
    with paper_style():
        return save_in_formats(_page(heading or name, windows, signal, known), Path(folder), name, chosen)


@dataclass(frozen=True)
class CellPages:
    """`write_cell_figures` as a run calls it.

    Attributes
    ----------
    formats : sequence of {"png", "pdf", "svg"}
    """

    formats: Sequence[str] = ("png",)

    def __call__(
        self, folder: Path, name: str, windows: CellWindows, signal: xr.DataArray | None, heading: str
    ) -> list[Path]:
        """Draw a cell."""
        return write_cell_figures(folder, name, windows, signal, heading=heading, formats=self.formats)


def _page(name: str, windows: CellWindows, signal: xr.DataArray | None, scale: Scale) -> Sheet:
    """Rows of cell and disk: signal and means by channel or else layers, mesh, area distortion."""
    rows, left_out = _rows(windows, signal, scale)
    panel = next(size for most, size in _PANELS if len(rows) <= most)
    height = _panel_height(windows.disk, panel)
    step = _HEADING + height + _BELOW
    heading = _heading(windows, scale, left_out, _width(panel))
    first = _TOP + _LINE * len(heading)
    sheet = Sheet(first + len(rows) * step + 1.0, _width(panel))
    _write_heading(sheet, name, heading)
    for number, row in enumerate(rows):
        row(_Row(sheet, first + number * step + _HEADING, panel, height))
    return sheet


def _rows(
    windows: CellWindows, signal: xr.DataArray | None, scale: Scale
) -> tuple[list[Callable[[_Row], None]], str]:
    """What draws each row of the page, and which channels are left out, in words."""
    rows: list[Callable[[_Row], None]] = []
    left_out, profile = "", None
    if signal is not None:
        images = (
            signal.transpose("channel", ...) if "channel" in signal.dims else signal.expand_dims("channel")
        )
        names = [shown_name(name, _LONGEST_CHANNEL) for name in _channel_names(images)]
        shown = min(len(names), _MOST_CHANNELS)
        sampled = sample(windows, images)
        left_out = f"channels 1–{shown} of {len(names)}" if len(names) > shown else ""
        means = np.asarray(sampled["mean"])
        for k in range(shown):
            rows.append(partial(_draw_signal, windows, np.asarray(images[k]), names[k], scale))
            rows.append(partial(_draw_means, windows, means[k], names[k], scale))
        profile = sampled.isel(channel=slice(shown)).assign_coords(channel=names[:shown])
    if signal is None or windows.disk.nucleus is not None:
        rows.append(partial(_draw_layers, windows, scale))
    if profile is not None and windows.disk.nucleus is not None:
        rows.append(partial(_draw_profile, profile))
    return [
        *rows,
        partial(_draw_meshes, windows.disk, scale),
        partial(_draw_distortion, windows.disk, scale),
    ], left_out


def _channel_names(images: xr.DataArray) -> list[str]:
    if "channel" in images.coords:
        return [str(name) for name in images["channel"].to_numpy()]
    count = images.sizes["channel"]
    return ["signal"] if count == 1 else [f"channel {k}" for k in range(count)]


@dataclass(frozen=True)
class _Row:
    """A row of the page: room for cell and disk, and for a colour bar."""

    sheet: Sheet
    top: float
    panel: float
    height: float

    def axes(self, *headings: str) -> list[Axes]:
        """Axes side by side, each with its heading above."""
        places = [_LEFT + k * (self.panel + _GAP) for k in range(len(headings))]
        for place, heading in zip(places, headings, strict=True):
            self.sheet.panel_title(place + 0.5 * self.panel, self.top - 1.5, heading, ha="center")
        return [self.sheet.axes(place, self.top, self.panel, self.height) for place in places]

    def bar(self) -> Axes:
        """Axes of the colour bar, to the right."""
        left = _LEFT + 2 * (self.panel + _GAP) - 1.0
        return self.sheet.axes(left, self.top + 0.1 * self.height, 2.2, 0.8 * self.height)


def _draw_signal(windows: CellWindows, image: FloatArray, channel: str, scale: Scale, row: _Row) -> None:
    """The signal in cell and disk in the same colours, windows over the cell."""
    cell, wheel = row.axes(f"{channel} and windows", f"{channel} on the disk")
    limits = signal_limits(image, windows.mask_without_holes)
    drawn = draw_cell(cell, image, windows.disk, scale=scale, cmap=SIGNAL_COLOURS, limits=limits)
    count = windows.grid.n_windows
    draw_windows(cell, windows, linewidth=line_width(count), alpha=line_opacity(count))
    draw_disk_image(wheel, windows.disk, image, limits=limits)
    colour_bar(drawn, row.bar(), channel, "a.u.", extend="both")


def _draw_means(windows: CellWindows, means: FloatArray, channel: str, scale: Scale, row: _Row) -> None:
    """Means of windows in colours of their own, as their range is narrower."""
    cell, wheel = row.axes("window means", "window means on the disk")
    filled = draw_window_means(cell, windows, means, scale=scale)
    draw_disk_means(wheel, windows.grid, means)
    colour_bar(filled, row.bar(), f"mean {channel}", "a.u.", extend="both")


def _draw_layers(windows: CellWindows, scale: Scale, row: _Row) -> None:
    """Which layers there are."""
    cell, wheel = row.axes("windows by layer", "windows on the disk")
    width = line_width(windows.grid.n_windows)
    draw_windows(cell, windows, by_layer=True, linewidth=width)
    cover_holes(cell, windows.disk)
    draw_outline(cell, windows.disk)
    frame_cell(cell, windows.disk, scale=scale)
    layers = draw_disk_windows(wheel, windows.grid, by_layer=True, color="white", linewidth=width)
    _draw_layer_bar(layers, row.bar(), windows)


def _draw_profile(sampled: xr.Dataset, row: _Row) -> None:
    """The signal from the nucleus to the membrane, across the whole row."""
    wide = row.sheet.width_mm - _LEFT - _PROFILE_LEFT - 8.0
    ax = row.sheet.axes(_LEFT + _PROFILE_LEFT, row.top + 3.5, wide, row.panel - 12.0)
    draw_nucleus_profile(ax, sampled, relative=True)
    row.sheet.panel_title(_LEFT, row.top - 1.5, "mean by layer; bands: quartiles of sectors")
    ax.legend(frameon=False, loc="best", borderpad=0.2, handlelength=1.4)


def _draw_meshes(disk: DiskMap, scale: Scale, row: _Row) -> None:
    cell, wheel = row.axes("mesh in the cell", "mesh on the disk")
    draw_mesh(cell, disk.vertices_yx, disk.triangles)
    draw_outline(cell, disk, linewidth=0.4)
    frame_cell(cell, disk, scale=scale)
    draw_disk_mesh(wheel, disk)


def _draw_distortion(disk: DiskMap, scale: Scale, row: _Row) -> None:
    """Where areas are distorted, and beside it how much of the cell, in the same colours: their key."""
    area, spread = row.axes("area distortion", "how much of the cell has it")
    draw_area_distortion(area, disk, scale=scale)
    _inset(spread, row.sheet, 9.0, 9.0, min(row.height, row.panel))
    draw_area_spread(spread, disk)


def _draw_layer_bar(layers: PolyCollection, into: Axes, windows: CellWindows) -> None:
    words = "layer; blue: nucleus" if windows.grid.nucleus_layers else "layer, 0 at the cell's edge"
    bar = colour_bar(layers, into, words)
    count = windows.grid.layers
    bar.set_ticks(list(range(0, count, max(1, -(-count // 10)))))
    bar.ax.minorticks_off()
    bar.ax.invert_yaxis()


def _panel_height(disk: DiskMap, width: float) -> float:
    high, wide = np.ptp(disk.outline_yx, axis=0)
    return float(np.clip(width * high / wide, width, _TALLEST * width))


def _inset(ax: Axes, sheet: Sheet, left: float, bottom: float, height: float) -> None:
    """Make room inside a panel for the labels of its axes, in millimetres."""
    box = ax.get_position()
    x = left / sheet.width_mm
    tall = (height - bottom) / sheet.height_mm
    ax.set_position((box.x0 + x, box.y1 - tall, box.width - x - 1.0 / sheet.width_mm, tall))


def _width(panel: float) -> float:
    return max(_LEFT + 2 * (panel + _GAP) + _BAR, SINGLE_COLUMN_MM)


def _heading(windows: CellWindows, scale: Scale, more: str, width: float) -> list[str]:
    """Size, grid and distortion of the cell, in lines that fit the page."""
    size = scale.area(float(windows.mask_without_holes.sum()))
    area = (f"{size:,.0f}" if size >= 100 else f"{size:.3g}") + f" {scale.area_unit}"
    distortion = windows.disk.distortion
    facts = [
        area,
        grid_words(windows.grid),
        f"area distortion {distortion.area:.3f}",
        f"angle distortion {distortion.angle:.3g}",
    ]
    return broken_lines([*facts, more] if more else facts, " · ", width - 2 * _LEFT)


def _write_heading(sheet: Sheet, name: str, lines: list[str]) -> None:
    longest = int((sheet.width_mm - 2 * _LEFT) / BOLD_MM)
    sheet.title(_LEFT, 5.0, shortened(name, longest))
    for number, words in enumerate(lines):
        sheet.text(_LEFT, 8.8 + _LINE * number, words, color="0.3")
