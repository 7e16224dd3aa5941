"""`DiskState`: which cell, frame and window the dock shows, and what it says of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cytodisk.arrays import AnyArray, FloatArray
from cytodisk.napari.disk_view.cell_numbers import CellNumbers, WindowNumbers
from cytodisk.napari.disk_view.disk_choices import DiskChoice
from cytodisk.napari.disk_view.disk_pixels import DiskColours, colours_of
from cytodisk.napari.disk_view.pointing import Pointed
from cytodisk.napari.disk_view.window_words import place_words
from cytodisk.napari.given.layer_kinds import pixels_of
from cytodisk.plot.style import DIVERGING_COLOURS, SIGNAL_COLOURS
from cytodisk.windows.polar_windows import CellWindows

_IMAGE_SIZE = 200  # pixels across the disk of a signal that is mapped onto it


@dataclass(frozen=True)
class KeyWords:
    """What a colour bar says.

    Attributes
    ----------
    words : str
    limits : (float, float)
    colours : str
    """

    words: str
    limits: tuple[float, float]
    colours: str


class DiskState:
    """One cell of a shown study in the frame under the slider.

    Parameters
    ----------
    shown : ShownStudy
    cell : int
    choice : DiskChoice
    frame : int or None
    """

    def __init__(self, shown: Any, numbers: CellNumbers, choice: DiskChoice, frame: int | None):
        self.shown, self.numbers, self.choice, self.frame = shown, numbers, choice, frame

    @property
    def cell(self) -> int:
        """Number of the cell."""
        return self.numbers.cell

    @property
    def channel(self) -> str:
        """The channel that is drawn through time: the one of the colours, or else the one that is shown."""
        first = next(iter(self.choice.names), "")
        return first if first in self.shown.channels else str(self.shown.channel)

    @property
    def cytoplasm_layers(self) -> int | None:
        """How many layers are not in the nucleus, of cells with one."""
        grid = self.numbers.grid
        return grid.cytoplasm_layers if grid.nucleus_layers else None

    @cached_property
    def no_map(self) -> str:
        """Why there is no map; empty if there is one."""
        return self.numbers.no_map(self.frame)

    @cached_property
    def windows(self) -> CellWindows | None:
        """Windows on the cell; None without a map."""
        if self.frame is None or self.no_map:
            return None
        found: CellWindows = self.shown.windows_at(self.cell, self.frame)
        return found

    @cached_property
    def values(self) -> WindowNumbers | None:
        """Numbers of the windows; None without a map."""
        if self.frame is None or self.no_map:
            return None
        return self.numbers.of_windows(self.choice, self.frame)

    def colours(self) -> DiskColours | None:
        """What the picture shows; None without a map."""
        if self.windows is None or self.values is None:
            return None
        grid, values = self.windows.grid, self.values
        shown = colours_of(values.values[: grid.layers], values.limits, values.colours).ravel()
        chance = None if values.hatched is None else values.hatched[: grid.layers].ravel()
        return DiskColours(
            grid, shown, self._ring(), chance, self._image(self.windows), self.windows.disk.nucleus_radius
        )

    def _ring(self) -> AnyArray | None:
        if self.frame is None or not self.numbers.is_movie:
            return None
        velocity, top = self.numbers.velocities(self.frame), self.shown.top_speed
        return None if velocity is None else colours_of(velocity, (-top, top), DIVERGING_COLOURS)

    @property
    def _layer(self) -> Any:
        """The open image whose pixels are shown; None if it is gone."""
        layers = [] if self.shown.viewer is None else self.shown.viewer.layers
        return next((layer for layer in layers if layer.name in self.choice.names), None)

    def _image(self, windows: CellWindows) -> AnyArray | None:
        layer = self._layer if self.choice.kind == "image" else None
        if layer is None:
            return None
        data = pixels_of(layer)
        pixels = np.asarray(data if data.ndim == 2 else data[self.frame])
        low, high = layer.contrast_limits
        return colours_of(windows.disk.image(pixels, _IMAGE_SIZE), (low, high), SIGNAL_COLOURS)

    def keys(self) -> tuple[KeyWords | None, KeyWords | None]:
        """Colour bars of the disk and of its ring; None for one that is not there."""
        ring = None
        if self.numbers.is_movie:
            speed = self.numbers.speed_unit
            top = self.shown.top_speed * speed.factor
            name = f"ring: edge velocity ({speed.name}), red outward"
            ring = KeyWords(name, (-top, top), DIVERGING_COLOURS)
        if self.values is None:
            return None, ring
        if self.choice.kind == "image":
            layer = self._layer
            limits = (0.0, 1.0) if layer is None else tuple(layer.contrast_limits)
            return KeyWords(self.choice.label, limits, SIGNAL_COLOURS), ring
        unit = f" ({self.values.unit})" if self.values.unit else ""
        hatched = "; hatched: not significant" if self.values.hatched is not None else ""
        return KeyWords(f"{self.choice.key}{unit}{hatched}", self.values.limits, self.values.colours), ring

    def words(self, window: tuple[int, int]) -> list[str]:
        """A window in words: where it is, its value, the velocity of its edge.

        Parameters
        ----------
        window : (int, int)
            Its layer and sector.
        """
        if self.windows is None or self.values is None or self.frame is None:
            return []
        grid, (layer, sector) = self.windows.grid, window
        outer = grid.cytoplasm_layers if grid.nucleus_layers else None
        depth, unit = self.numbers.depth(self.frame, layer, sector), self.shown.unit("depth")
        place = place_words(layer, sector, grid.layers, outer, depth, unit)
        return [place, *self.numbers.value_words(self.values, self.choice, self.frame, window)]

    def outline_yx(self, window: tuple[int, int] | None) -> FloatArray | None:
        """Outline of a window in the cell."""
        if window is None or self.windows is None or window[0] >= self.windows.layers:
            return None
        return self.windows.polygon(*window)

    def place_yx(self, pointed: Pointed | None) -> FloatArray | None:
        """Where in the cell the place is that the cursor points at in the disk, shape (1, 2)."""
        if pointed is None or not pointed.by_disk or self.windows is None:
            return None
        return self.windows.disk.to_cell([pointed.uv])

    @property
    def sector_0_yx(self) -> FloatArray | None:
        """The middle of sector 0 on the cell's edge, shape (1, 2)."""
        if self.windows is None:
            return None
        angle = float(self.windows.grid.angles[:2].mean())
        return self.windows.disk.to_cell([(np.cos(angle), np.sin(angle))])
