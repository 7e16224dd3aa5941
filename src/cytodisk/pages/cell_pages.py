"""The pictures of a study: one page a cell."""

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError
from cytodisk.pages.grid_words import grid_words
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.cell.area_distortion import DISTORTION_LABEL, draw_area_distortion, draw_area_spread
from cytodisk.plot.cell.cell_axes import draw_cell, draw_mesh, draw_outline, frame_cell
from cytodisk.plot.cell.disk_axes import draw_disk_image, draw_disk_means, draw_disk_mesh, draw_disk_windows
from cytodisk.plot.cell.hole_marks import cover_holes
from cytodisk.plot.cell.window_polygons import draw_window_means, draw_windows
from cytodisk.plot.nucleus.nucleus_profile import draw_nucleus_profile
from cytodisk.plot.style import DOUBLE_COLUMN_MM, SIGNAL_COLOURS, colour_bar, paper_style, signal_limits
from cytodisk.plot.units import scale_for
from cytodisk.runs.channel_names import shortened, shown_name
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows
from cytodisk.windows.sample import sample

_MOST_CHANNELS = 3
_LONGEST_NAME = 80
_LONGEST_CHANNEL = 20
_PANEL, _GAP, _LEFT, _BAR = 32.5, 4.0, 6.0, 14.0  # mm, with a signal
_PAIR = 2 * (_PANEL + _GAP) + _BAR - 1.0  # mm, cell, disk and colour bar; two of them side by side
_WIDE_PANEL = 43.0  # mm, without a signal: three panels
_TOP, _HEADING, _BELOW = 11.0, 4.5, 6.0  # mm: page heading, headings of panels, room for scale bars
_TALLEST = 1.45  # height of a panel over its width


def write_cell_figures(
    folder: Path,
    name: str,
    windows: CellWindows,
    signal: xr.DataArray | None,
    scale: Scale | None = None,
    heading: str = "",
) -> list[Path]:
    """Write the page of one cell: signal and means in cell and disk by channel, mesh and area distortion.

    Without a signal the windows are drawn in the colours of their layers. With a signal and a nucleus they
    are so too, beside the signal by layer from the nucleus' centre to the membrane.

    Parameters
    ----------
    folder : Path
        Exists already.
    name : str
        Name of the cell; the file is `<name>.png`, 180 mm wide at 200 dots per inch.
    windows : CellWindows
    signal : DataArray with dims (channel,) y, x, or None
        One frame. The first three channels are drawn.
    scale : Scale, optional
        By default that of the windows; without a pixel size scale bars are in px.
    heading : str
        What stands above the pictures; by default the name.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    SignalError
        The signal does not fit the mask.
    ParameterError
        The name cannot be a file's.
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
    path = Path(folder) / f"{name}.png"
    known = scale_for(windows, scale)
    with paper_style():
        if signal is None:
            sheet = _sheet_without_signal(heading or name, windows, known)
        else:
            sheet = _sheet_with_signal(heading or name, windows, signal, known)
        return [sheet.save(path)]


def draw_cell_page(
    folder: Path, name: str, windows: CellWindows, signal: xr.DataArray | None, heading: str
) -> list[Path]:
    """`write_cell_figures` as a run calls it."""
    return write_cell_figures(folder, name, windows, signal, heading=heading)


def _sheet_with_signal(name: str, windows: CellWindows, signal: xr.DataArray, scale: Scale) -> Sheet:
    images = signal.transpose("channel", ...) if "channel" in signal.dims else signal.expand_dims("channel")
    names = _channel_names(images)
    shown = min(len(names), _MOST_CHANNELS)
    sampled = sample(windows, images)
    means = np.asarray(sampled["mean"])
    height = _panel_height(windows.disk, _PANEL)
    row = _HEADING + height + _BELOW
    rows = shown + (1 if windows.disk.nucleus is None else 2)
    sheet = Sheet(_TOP + rows * row + 2.0)
    left_out = f"channels 1–{shown} of {len(means)}" if len(means) > shown else ""
    _write_heading(sheet, name, windows, scale, left_out)
    for k in range(shown):
        top = _TOP + k * row + _HEADING
        _draw_channel(sheet, top, height, windows, np.asarray(images[k]), means[k], names[k], scale)
    if windows.disk.nucleus is not None:
        profile = sampled.isel(channel=slice(shown)).assign_coords(channel=names[:shown])
        _draw_nucleus_row(sheet, _TOP + shown * row + _HEADING, height, windows, profile)
    _draw_map_row(sheet, _TOP + (rows - 1) * row + _HEADING, height, windows.disk, scale)
    return sheet


def _channel_names(images: xr.DataArray) -> list[str]:
    if "channel" in images.coords:
        return [str(name) for name in images["channel"].to_numpy()]
    count = images.sizes["channel"]
    return ["signal"] if count == 1 else [f"channel {k}" for k in range(count)]


def _draw_channel(
    sheet: Sheet,
    top: float,
    height: float,
    windows: CellWindows,
    image: FloatArray,
    means: FloatArray,
    channel: str,
    scale: Scale,
) -> None:
    """The signal in cell and disk in the same colours, then the means, whose range is narrower."""
    sheet.text(
        3.5,
        top + 0.5 * height,
        shown_name(channel, _LONGEST_CHANNEL),
        rotation=90,
        ha="center",
        va="center",
        fontsize=7.5,
        weight="bold",
    )
    second = _LEFT + _PAIR
    headings = ("signal and windows", "signal on the disk")
    cell, wheel = _row_of_axes(sheet, top, height, _PANEL, headings)
    limits = signal_limits(image, windows.mask_without_holes)
    drawn = draw_cell(cell, image, windows.disk, scale=scale, cmap=SIGNAL_COLOURS, limits=limits)
    draw_windows(cell, windows, linewidth=0.15, alpha=0.6)
    draw_disk_image(wheel, windows.disk, image, limits=limits)
    bar = _bar_axes(sheet, top, height, second - _BAR)
    colour_bar(drawn, bar, shown_name(channel, _LONGEST_CHANNEL), "a.u.", extend="both")
    headings = ("window means", "window means on the disk")
    cell, wheel = _row_of_axes(sheet, top, height, _PANEL, headings, left=second)
    filled = draw_window_means(cell, windows, means, scale=scale)
    draw_disk_means(wheel, windows.grid, means)
    bar = _bar_axes(sheet, top, height, second + _PAIR - _BAR)
    colour_bar(filled, bar, f"mean {shown_name(channel, _LONGEST_CHANNEL)}", "a.u.", extend="both")


def _draw_nucleus_row(
    sheet: Sheet, top: float, height: float, windows: CellWindows, sampled: xr.Dataset
) -> None:
    """Which layers there are, in cell and disk, and the signal in them from the nucleus to the membrane."""
    cell, wheel = _row_of_axes(sheet, top, height, _PANEL, ("windows by layer", "windows on the disk"))
    draw_windows(cell, windows, by_layer=True, linewidth=0.15)
    cover_holes(cell, windows.disk)
    draw_outline(cell, windows.disk)
    frame_cell(cell, windows.disk, scale=windows.scale)
    layers = draw_disk_windows(wheel, windows.grid, by_layer=True, color="white", linewidth=0.15)
    second = _LEFT + _PAIR
    _draw_layer_bar(layers, _bar_axes(sheet, top, height, second - _BAR), windows)
    profile = sheet.axes(second + 6.0, top + 2.5, DOUBLE_COLUMN_MM - second - 12.0, height - 9.0)
    channels = [shown_name(str(name), _LONGEST_CHANNEL) for name in sampled["channel"].to_numpy()]
    draw_nucleus_profile(profile, sampled.assign_coords(channel=channels), relative=True)
    sheet.text(second + 6.0, top - 2.2, "mean by layer; bands: quartiles of sectors", fontsize=7.5)
    profile.legend(frameon=False, loc="best", borderpad=0.2, handlelength=1.4)


def _draw_map_row(sheet: Sheet, top: float, height: float, disk: DiskMap, scale: Scale) -> None:
    second = _LEFT + _PAIR
    mesh, wheel = _row_of_axes(sheet, top, height, _PANEL, ("mesh in the cell", "mesh on the disk"))
    spread, area = _row_of_axes(sheet, top, height, _PANEL, ("", "area distortion"), left=second)
    _draw_meshes(mesh, wheel, disk, scale)
    _inset(spread, sheet, 4.0, 9.0, min(height, _PANEL))
    draw_area_spread(spread, disk)
    drawn = draw_area_distortion(area, disk, scale=scale)
    bar = _bar_axes(sheet, top, height, second + _PAIR - _BAR)
    colour_bar(drawn, bar, DISTORTION_LABEL, extend="both")


def _sheet_without_signal(name: str, windows: CellWindows, scale: Scale) -> Sheet:
    """Two rows of three: cell, disk, area distortion."""
    disk, height = windows.disk, _panel_height(windows.disk, _WIDE_PANEL)
    row = _HEADING + height + _BELOW
    sheet = Sheet(_TOP + 2 * row + 2.0)
    _write_heading(sheet, name, windows, scale, "")
    first, second = _TOP + _HEADING, _TOP + row + _HEADING
    third = _LEFT + 2 * (_WIDE_PANEL + _GAP) + 17.0
    cell, wheel = _row_of_axes(sheet, first, height, _WIDE_PANEL, ("windows by layer", "windows on the disk"))
    mesh, disk_mesh = _row_of_axes(
        sheet, second, height, _WIDE_PANEL, ("mesh in the cell", "mesh on the disk")
    )
    (area,) = _row_of_axes(sheet, first, height, _WIDE_PANEL, ("area distortion",), left=third)
    (spread,) = _row_of_axes(sheet, second, height, _WIDE_PANEL, ("",), left=third)
    draw_windows(cell, windows, by_layer=True, linewidth=0.15)
    cover_holes(cell, disk)
    draw_outline(cell, disk)
    frame_cell(cell, disk, scale=scale)
    layers = draw_disk_windows(wheel, windows.grid, by_layer=True, color="white", linewidth=0.15)
    _draw_layer_bar(layers, _bar_axes(sheet, first, height, _LEFT + 2 * (_WIDE_PANEL + _GAP)), windows)
    _draw_meshes(mesh, disk_mesh, disk, scale)
    drawn = draw_area_distortion(area, disk, scale=scale)
    bar = _bar_axes(sheet, first, height, third + _WIDE_PANEL + 1.0)
    colour_bar(drawn, bar, DISTORTION_LABEL, extend="both")
    _inset(spread, sheet, 9.0, 9.0, min(height, _WIDE_PANEL))
    draw_area_spread(spread, disk)
    return sheet


def _draw_meshes(cell: Axes, wheel: Axes, disk: DiskMap, scale: Scale) -> None:
    draw_mesh(cell, disk.vertices_yx, disk.triangles)
    draw_outline(cell, disk, linewidth=0.4)
    frame_cell(cell, disk, scale=scale)
    draw_disk_mesh(wheel, disk)


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


def _row_of_axes(
    sheet: Sheet, top: float, height: float, width: float, headings: tuple[str, ...], left: float = _LEFT
) -> list[Axes]:
    """Axes side by side, each with its heading above."""
    places = [left + k * (width + _GAP) for k in range(len(headings))]
    for place, heading in zip(places, headings, strict=True):
        sheet.text(place + 0.5 * width, top - 1.5, heading, ha="center", fontsize=7.5)
    return [sheet.axes(place, top, width, height) for place in places]


def _bar_axes(sheet: Sheet, top: float, height: float, left: float) -> Axes:
    return sheet.axes(left, top + 0.12 * height, 2.2, 0.76 * height)


def _inset(ax: Axes, sheet: Sheet, left: float, bottom: float, height: float) -> None:
    """Make room inside a panel for the labels of its axes, in millimetres."""
    box = ax.get_position()
    x = left / sheet.width_mm
    tall = (height - bottom) / sheet.height_mm
    ax.set_position((box.x0 + x, box.y1 - tall, box.width - x - 1.0 / sheet.width_mm, tall))


def _write_heading(sheet: Sheet, name: str, windows: CellWindows, scale: Scale, more: str) -> None:
    size = scale.area(float(windows.mask_without_holes.sum()))
    area = (f"{size:,.0f}" if size >= 100 else f"{size:.3g}") + f" {scale.area_unit}"
    distortion = windows.disk.distortion
    facts = [
        area,
        grid_words(windows.grid),
        f"area distortion {distortion.area:.3f}",
        f"angle distortion {distortion.angle:.3g}",
    ]
    sheet.text(_LEFT, 5.0, shortened(name, _LONGEST_NAME), fontsize=8, weight="bold")
    sheet.text(_LEFT, 8.6, " · ".join([*facts, more] if more else facts), color="0.3")
