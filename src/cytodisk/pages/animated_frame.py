"""The picture of one frame of an animation: a cell beside its disk."""

from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Colormap, Normalize
from PIL import Image

from cytodisk.arrays import AnyArray, FloatArray
from cytodisk.errors import ParameterError
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.cell.cell_axes import fitting_image
from cytodisk.plot.cell.disk_axes import disk_polygons, fit_disk, frame_disk
from cytodisk.plot.cell.sector_marks import (
    EDGE_WIDTH,
    NUCLEUS_WIDTH,
    draw_edge,
    mark_point,
    note_sector,
    nucleus_arcs,
    sector_arcs,
    sector_colours,
    sector_style,
)
from cytodisk.plot.field_of_view import Extent, frame_field
from cytodisk.plot.style import (
    SIGNAL_COLOURS,
    STAMP,
    colour_bar,
    colour_map,
    paper_style,
    scale_bar,
    signal_limits,
)
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows, PolarGrid

_DPI = 118
_WIDTH, _PANEL, _TOP, _BELOW = 119.0, 47.0, 7.0, 7.0  # mm
_DISK_PIXELS = 176  # as wide as it is drawn
_SIGNAL_LEVELS = 48  # noise in many colours is what makes such files long
_RING_POINTS, _SPOKE_POINTS = 720, 96


class AnimatedFrames:
    """Draws frames one by one: what moves is drawn for each, what stays is drawn once and laid over it.

    Parameters
    ----------
    grid : PolarGrid
        Grid of all frames.
    extent_yx : (float, float, float, float)
        Field of view: top, bottom, left and right in pixels.
    scale : Scale
        Without a pixel size the scale bar is in px.
    limits : (float, float) or None
        Limits of the signal's colours; by default percentiles 1 and 99.5 inside the first cell with a signal.
    label : str
        Label of the colour bar, with its unit.
    """

    def __init__(
        self,
        grid: PolarGrid,
        extent_yx: Extent,
        scale: Scale,
        limits: tuple[float, float] | None,
        label: str,
    ) -> None:
        self._grid, self._extent, self._scale = grid, extent_yx, scale
        self._limits, self._label = limits, label
        self._colours, self._palette = _signal_colours(), _palette()
        self._has_bar = False
        self._moving = _Scene(extent_yx)
        self._fixed: dict[tuple[bool, bool], Image.Image] = {}

    def draw(self, windows: CellWindows, signal: Any, stamp: str) -> Image.Image:
        """The picture of one frame, in the colours that all frames share.

        Raises
        ------
        ParameterError
            The windows have another grid.
        SignalError
            The signal has another shape than the mask.
        """
        if windows.grid.of_any_cell != self._grid.of_any_cell:
            raise ParameterError(f"frames have the grids {self._grid} and {windows.grid}: pass one for all")
        if windows.grid != self._grid:  # layers by depth have other radii in each frame
            self._grid = windows.grid
            self._fixed.clear()
        image = None if signal is None else fitting_image(signal, windows.mask, "signal")
        with paper_style():
            self._moving.clear(stamp)
            if image is not None:
                self._draw_signal(windows, image)
            _draw_cell(self._moving.cell, windows, over_signal=image is not None)
            picture = self._moving.rendered()
            picture.alpha_composite(self._laid_over(over_signal=image is not None))
        return picture.convert("RGB").quantize(palette=self._palette, dither=Image.Dither.NONE)

    def _draw_signal(self, windows: CellWindows, image: AnyArray) -> None:
        self._limits = self._limits or signal_limits(image, windows.mask_without_holes)
        self._has_bar = True
        low, high = self._limits
        self._moving.cell.imshow(image, cmap=self._colours, vmin=low, vmax=high)
        shown = self._colours.with_extremes(bad=(1.0, 1.0, 1.0, 0.0))
        on_disk = windows.disk.image(image, _DISK_PIXELS)
        extent = (-1.0, 1.0, 1.0, -1.0)
        self._moving.disk.imshow(on_disk, cmap=shown, vmin=low, vmax=high, extent=extent)

    def _laid_over(self, *, over_signal: bool) -> Image.Image:
        """Scale bar, the disk's windows and, once there was a signal, its colour bar, on nothing."""
        kind = over_signal, self._has_bar
        if kind not in self._fixed:
            scene = _Scene(self._extent)
            scale_bar(scene.cell, self._scale)
            note_sector(scene.cell)
            _draw_disk(scene.disk, self._grid, over_signal=over_signal)
            if self._has_bar:
                self._draw_bar(scene.sheet)
            scene.sheet.figure.patch.set_visible(False)
            self._fixed[kind] = scene.rendered()
        return self._fixed[kind]

    def _draw_bar(self, sheet: Sheet) -> None:
        low, high = self._limits or (0.0, 1.0)
        colours = ScalarMappable(Normalize(low, high), self._colours)
        beside = sheet.axes(8.0 + 2 * _PANEL, _TOP + 0.15 * _PANEL, 2.4, 0.7 * _PANEL)
        colour_bar(colours, beside, self._label, extend="both")


class _Scene:
    """A page with room for a cell and its disk."""

    def __init__(self, extent_yx: Extent) -> None:
        with paper_style():
            self.sheet = Sheet(_TOP + _PANEL + _BELOW, _WIDTH)
            self.cell = self.sheet.axes(3.0, _TOP, _PANEL, _PANEL)
            self.disk = self.sheet.axes(6.0 + _PANEL, _TOP, _PANEL, _PANEL)
            self._stamp = self.sheet.text(3.0, 4.5, "", **STAMP)
        self.sheet.figure.set_dpi(_DPI)
        self._canvas = FigureCanvasAgg(self.sheet.figure)
        frame_field(self.cell, extent_yx)
        fit_disk(self.disk)

    def clear(self, stamp: str) -> None:
        """Take away what is drawn, but not the axes' own parts, which take long to make."""
        self._stamp.set_text(stamp)
        for ax in (self.cell, self.disk):
            for artist in (*ax.images, *ax.collections, *ax.patches, *ax.lines, *ax.texts):
                artist.remove()

    def rendered(self) -> Image.Image:
        """What is drawn, red, green, blue and opacity."""
        self._canvas.draw()  # type: ignore[no-untyped-call]
        pixels = np.asarray(self._canvas.buffer_rgba())  # type: ignore[no-untyped-call]
        return Image.fromarray(pixels.copy())


def _draw_cell(ax: Axes, windows: CellWindows, *, over_signal: bool) -> None:
    """As `draw_sectors`, with lines rather than a polygon a window."""
    grid = windows.grid
    rings, spokes = _inner_rings(windows), _spokes(windows)
    if not over_signal:
        _fill_sectors(ax, sector_arcs(windows), rings[0])
        if grid.nucleus_layers:
            _fill_sectors(ax, nucleus_arcs(windows), rings[grid.cytoplasm_layers])
    lines = [line[:, ::-1] for line in (*rings[: grid.layers - 1], *spokes)]
    style = sector_style(grid, over_signal=over_signal)
    # As strong as the sides that neighbours share in `draw_sectors`.
    look: Any = {"colors": style["edgecolors"], "linewidths": 1.8 * style["linewidths"]}
    ax.add_collection(LineCollection(lines, **look), autolim=False)
    draw_edge(ax, windows, over_signal=over_signal)


def _fill_sectors(ax: Axes, arcs_yx: list[FloatArray], ring_yx: FloatArray) -> None:
    """Fill what lies between the arcs of an outline and the inner side of its layer."""
    inner = ring_yx[:-1].reshape(len(arcs_yx), -1, 2)
    ends = np.concatenate([inner, np.roll(inner[:, :1], -1, axis=0)], axis=1)
    filled = [np.concatenate(pair)[:, ::-1] for pair in zip(arcs_yx, ends[:, ::-1], strict=True)]
    ax.add_collection(PolyCollection(filled, facecolors=sector_colours(len(arcs_yx))), autolim=False)


def _inner_rings(windows: CellWindows) -> FloatArray:
    """Inner side of each layer in the cell, closed, as many points a sector, shape (layers, N, 2)."""
    grid = windows.grid
    angle = np.linspace(0.0, 2.0 * np.pi, grid.sectors * -(-_RING_POINTS // grid.sectors) + 1)
    return _in_cell(windows, grid.radii[1:, None], angle)


def _spokes(windows: CellWindows) -> FloatArray:
    """First side of each sector in the cell, from outside in, shape (sectors, N, 2)."""
    return _in_cell(windows, np.linspace(1.0, 0.0, _SPOKE_POINTS), windows.grid.angles[:-1, None])


def _in_cell(windows: CellWindows, radius: FloatArray, angle: FloatArray) -> FloatArray:
    return windows.disk.to_cell(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1))


def _draw_disk(ax: Axes, grid: PolarGrid, *, over_signal: bool) -> None:
    style = sector_style(grid, over_signal=over_signal)
    ax.add_collection(PolyCollection(disk_polygons(grid), **style), autolim=False)
    frame_disk(ax, nucleus_radius=grid.nucleus_radius)
    if over_signal:
        _draw_rim(ax, grid, 1.0, EDGE_WIDTH)
        if grid.nucleus_radius is not None:
            _draw_rim(ax, grid, grid.nucleus_radius, NUCLEUS_WIDTH)
    middle = 0.5 * grid.angles[1]
    mark_point(ax, float(np.sin(middle)), float(np.cos(middle)))


def _draw_rim(ax: Axes, grid: PolarGrid, radius: float, width: float) -> None:
    arcs = [radius * arc for arc in _arcs(grid)]
    colours = sector_colours(grid.sectors)
    ax.add_collection(LineCollection(arcs, colors=colours, linewidths=width, zorder=4), autolim=False)


def _arcs(grid: PolarGrid) -> list[FloatArray]:
    """The unit circle, one arc a sector."""
    arcs = []
    for start, stop in pairwise(grid.angles):
        angle = np.linspace(start, stop, 8 + 360 // grid.sectors)
        arcs.append(np.column_stack([np.cos(angle), np.sin(angle)]))
    return arcs


def _signal_colours() -> Colormap:
    return colour_map(SIGNAL_COLOURS).resampled(_SIGNAL_LEVELS)


def _palette() -> Image.Image:
    """The colours of all frames, so that nothing flickers: greys, signal, signal under lines, sectors."""
    signal = _signal_colours()(np.linspace(0.0, 1.0, _SIGNAL_LEVELS))[:, :3]
    greys = np.repeat(np.linspace(0.0, 1.0, 17)[:, None], 3, axis=1)
    under_lines = [(1.0 - share) * signal + share for share in (0.2, 0.45)]
    colours = np.concatenate([greys, signal, *under_lines, sector_colours(48)[:, :3]])
    image = Image.new("P", (1, 1))
    image.putpalette((255.0 * colours).round().astype(np.uint8).tobytes())
    return image
