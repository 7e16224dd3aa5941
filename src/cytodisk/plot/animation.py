"""Write a movie of a cell beside its disk, frame by frame, so that long movies need little memory."""

import os
import shutil
import subprocess
from collections.abc import Callable, Iterable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Colormap
from PIL import Image

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError, SignalError, StudyError
from cytodisk.files import replacing
from cytodisk.plot.disk import disk_polygons, frame_disk
from cytodisk.plot.sheet import Sheet
from cytodisk.plot.strip import (
    EDGE_WIDTH,
    ON_WHITE,
    OVER_SIGNAL,
    Extent,
    draw_sectors,
    frame_field,
    mark_point,
    note_sector,
    sector_colours,
    time_stamp,
)
from cytodisk.plot.style import SIGNAL_COLOURS, colour_bar, colour_map, paper_style, scale_bar, signal_limits
from cytodisk.windows.cell_windows import CellWindows
from cytodisk.windows.grid import PolarWindows

MOST_FRAMES = 150

_DPI = 100
_WIDTH, _PANEL, _TOP, _BELOW = 140.0, 56.0, 7.0, 7.0  # mm
_DISK_PIXELS = 192
_SIGNAL_LEVELS = 48  # noise in many colours is what makes such files long

Frame = tuple[CellWindows, Any, int]


def write_animation(
    path: str | os.PathLike[str],
    frames: Iterable[Frame],
    *,
    extent_yx: Extent,
    fps: float = 8,
    pixel_size_um: float | None = None,
    frame_interval_s: float | None = None,
    limits: tuple[float, float] | None = None,
    label: str = "signal (a.u.)",
    progress: Callable[[int], None] | None = None,
) -> Path:
    """Write an animated picture: the cell with its windows on the left, its disk on the right.

    Colours along the edge tell the sectors apart, as in `draw_strip`; a frame without a signal has its
    outermost windows filled with them. At most 150 frames are shown: of a longer movie every second, fourth,
    eighth and so on, so that the number of frames need not be known beforehand.

    Parameters
    ----------
    path : path-like
        Ends in `.gif`, or in `.mp4` where the program ffmpeg is installed.
    frames : iterable of (CellWindows, array_like of shape (H, W) or None, int)
        Windows, one channel of the signal, and number of the frame, from 0. Is read once, one at a time.
    extent_yx : (float, float, float, float)
        Field of view: top, bottom, left and right in pixels, such as `field_of_view` gives.
    fps : float
        Frames shown per second.
    pixel_size_um : float, optional
        Micrometres a pixel; without it the scale bar is in px.
    frame_interval_s : float, optional
        Seconds between frames; without it the time stamp is the frame's number.
    limits : (float, float), optional
        Of the signal's colours in all frames; by default percentiles 1 and 99.5 inside the first cell.
    label : str
        Of the colour bar, with its unit.
    progress : callable, optional
        Is called with the number of frames read so far.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    ParameterError
        The path has another suffix or ffmpeg is missing, there is no frame, the frames have different grids,
        or a number is out of its range.
    SignalError
        A signal has another shape than its mask.
    StudyError
        The file cannot be written.
    """
    target = Path(path)
    _check(target, fps)
    images: list[Image.Image] = []
    stage, every = None, 1
    for number, (windows, signal, index) in enumerate(frames):
        if number % every == 0:
            stage = stage or _Stage(windows.grid, extent_yx, pixel_size_um, limits, label)
            images.append(stage.draw(windows, signal, time_stamp(index, frame_interval_s)))
        if len(images) > MOST_FRAMES:
            images, every = images[::2], 2 * every
        if progress is not None:
            progress(number + 1)
    if not images:
        raise ParameterError("frames is empty: pass at least one frame")
    with replacing(target) as temporary:
        write = _write_gif if target.suffix.lower() == ".gif" else _write_mp4
        write(temporary, images, fps)
    return target


def _check(path: Path, fps: float) -> None:
    suffix = path.suffix.lower()
    if suffix not in (".gif", ".mp4"):
        raise ParameterError(f"path must end in .gif or .mp4, got {path}")
    if suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise ParameterError(f"{path} needs ffmpeg, which is not installed: install it, or end in .gif")
    if not 0 < fps <= 100:
        raise ParameterError(f"fps must be a number above 0 and at most 100, got {fps!r}")


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


_PALETTE = _palette()


class _Stage:
    """One figure that is cleared and drawn anew for each frame."""

    def __init__(
        self,
        grid: PolarWindows,
        extent_yx: Extent,
        pixel_size_um: float | None,
        limits: tuple[float, float] | None,
        label: str,
    ) -> None:
        self._grid, self._extent, self._pixel_size_um = grid, extent_yx, pixel_size_um
        self._limits, self._label = limits, label
        self._colours = _signal_colours()
        with paper_style():
            self._sheet = Sheet(_TOP + _PANEL + _BELOW, _WIDTH)
            self._cell = self._sheet.axes(3.0, _TOP, _PANEL, _PANEL)
            self._disk = self._sheet.axes(6.0 + _PANEL, _TOP, _PANEL, _PANEL)
            self._stamp = self._sheet.text(3.0, 4.5, "", fontsize=9)
        self._bar: Axes | None = None
        self._canvas = FigureCanvasAgg(self._sheet.figure)
        self._sheet.figure.set_dpi(_DPI)

    def draw(self, windows: CellWindows, signal: Any, stamp: str) -> Image.Image:
        """The picture of one frame, in the fixed colours."""
        if windows.grid != self._grid:
            raise ParameterError(f"frames have the grids {self._grid} and {windows.grid}: pass one for all")
        image = None if signal is None else np.asarray(signal)
        if image is not None and image.shape != windows.mask.shape:
            raise SignalError(
                f"signal has shape {image.shape}, the mask {windows.mask.shape}: pass one channel a frame"
            )
        with paper_style():
            self._stamp.set_text(stamp)
            self._draw_cell(windows, image)
            self._draw_disk(windows, image)
            return self._rendered()

    def _rendered(self) -> Image.Image:
        self._canvas.draw()  # type: ignore[no-untyped-call]
        pixels = np.asarray(self._canvas.buffer_rgba())  # type: ignore[no-untyped-call]
        return Image.fromarray(pixels[..., :3].copy()).quantize(palette=_PALETTE, dither=Image.Dither.NONE)

    def _draw_cell(self, windows: CellWindows, image: FloatArray | None) -> None:
        _empty(self._cell)
        if image is not None:
            self._limits = self._limits or signal_limits(image, windows.mask)
            low, high = self._limits
            drawn = self._cell.imshow(image, cmap=self._colours, vmin=low, vmax=high)
            if self._bar is None:
                self._bar = self._sheet.axes(8.0 + 2 * _PANEL, _TOP + 0.15 * _PANEL, 2.4, 0.7 * _PANEL)
                colour_bar(drawn, self._bar, self._label, extend="both")
        draw_sectors(self._cell, windows, over_signal=image is not None)
        frame_field(self._cell, self._extent)
        scale_bar(self._cell, self._pixel_size_um)
        note_sector(self._cell)

    def _draw_disk(self, windows: CellWindows, image: FloatArray | None) -> None:
        _empty(self._disk)
        grid, colours = self._grid, sector_colours(self._grid.sectors)
        faces = np.zeros((grid.n_windows, 4))
        if image is not None:
            low, high = self._limits or (0.0, 1.0)
            on_disk = windows.disk.image(image, _DISK_PIXELS)
            shown = self._colours.with_extremes(bad=(1.0, 1.0, 1.0, 0.0))
            self._disk.imshow(on_disk, cmap=shown, vmin=low, vmax=high, extent=(-1.0, 1.0, 1.0, -1.0))
        else:
            faces[: grid.sectors] = colours
        lines = OVER_SIGNAL if image is not None else ON_WHITE
        self._disk.add_collection(
            PolyCollection(disk_polygons(grid), facecolors=faces, **lines), autolim=False
        )
        frame_disk(self._disk)
        if image is not None:
            self._disk.add_collection(
                LineCollection(_arcs(grid), colors=colours, linewidths=EDGE_WIDTH, zorder=4), autolim=False
            )
        middle = 0.5 * grid.angles[1]
        mark_point(self._disk, float(np.sin(middle)), float(np.cos(middle)))


def _empty(ax: Axes) -> None:
    """Remove what is drawn, but not the axes' own parts, which take long to make."""
    for artist in (*ax.images, *ax.collections, *ax.patches, *ax.lines, *ax.texts):
        artist.remove()


def _arcs(grid: PolarWindows) -> list[FloatArray]:
    """The circle, one arc a sector."""
    arcs = []
    for start, stop in pairwise(grid.angles):
        angle = np.linspace(start, stop, 8 + 360 // grid.sectors)
        arcs.append(np.column_stack([np.cos(angle), np.sin(angle)]))
    return arcs


def _write_gif(path: Path, images: list[Image.Image], fps: float) -> None:
    first, *others = images
    first.save(path, save_all=True, append_images=others, duration=round(1000 / fps), loop=0)


def _write_mp4(path: Path, images: list[Image.Image], fps: float) -> None:
    """H.264 needs sides of even length."""
    width, height = images[0].size
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", f"{fps:g}", "-i", "-"]
    encoded = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p", str(path)]
    pixels = b"".join(image.convert("RGB").tobytes() for image in images)
    done = subprocess.run(
        ["ffmpeg", "-y", "-loglevel", "error", *raw, *encoded], input=pixels, capture_output=True, check=False
    )
    if done.returncode:
        raise StudyError(f"cannot write {path}: ffmpeg said {done.stderr.decode(errors='replace').strip()}")
