"""`WindowsOnCell`: what all windows on one cell have in common, polar, edge-based or rings."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy import sparse

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.geometry.edge_distance import EdgeDistance
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.scale import UNKNOWN, Scale
from cytodisk.windows.depths import DEPTHS, NUCLEUS_DISTANCES, window_depths
from cytodisk.windows.pieces import pieces_by_window
from cytodisk.windows.pixel_shares.hole_pixels import hole_pixels, without_pixels
from cytodisk.windows.pixel_shares.shares import (
    NOWHERE,
    PER_SIDE,
    WindowShares,
    gather_shares,
    strips,
    subpixels_by_strips,
)


class Grid(Protocol):
    """What all grids have."""

    @property
    def layers(self) -> int: ...
    @property
    def sectors(self) -> int: ...


class WindowsOnCell(ABC):
    """Windows in a cell, by layer from the edge (0) inwards and sector along the edge.

    Window (layer, sector) has number layer · sectors + sector. A window that holds nothing of the cell is
    empty: its area is 0, and what cannot be measured of it is NaN.
    """

    grid: Grid

    @property
    @abstractmethod
    def mask(self) -> BoolArray:
        """The cell's mask, its holes filled, shape (H, W) and dtype bool."""

    @property
    def holes(self) -> PlacedMask | None:
        """Holes in the mask that belong to no window; None if there are none, or they count as cell."""
        return None

    @cached_property
    def placed_mask(self) -> PlacedMask:
        """The mask as its box in the image."""
        return PlacedMask.of(self.mask)

    @property
    def mask_without_holes(self) -> BoolArray:
        """The cell's mask without excluded holes, shape (H, W) and dtype bool."""
        return self.mask if self.holes is None else self.mask & ~self.holes.whole

    @property
    @abstractmethod
    def outline_yx(self) -> FloatArray:
        """Outline of the cell, shape (B, 2) and dtype float, (row, column) in pixels."""

    @property
    def scale(self) -> Scale:
        """Scale of the image, as the map or the mask knows it."""
        return UNKNOWN

    @property
    def layers(self) -> int:
        """Number of layers."""
        return self.grid.layers

    @property
    def sectors(self) -> int:
        """Number of sectors."""
        return self.grid.sectors

    @abstractmethod
    def windows_of_subpixels(self, pixels_yx: IntArray) -> IntArray:
        """Number of the window that each subpixel of some mask pixels lies in, shape (P, 16); -1 for none.

        Parameters
        ----------
        pixels_yx : ndarray of shape (P, 2) and dtype int
            (row, column).
        """

    @cached_property
    def shares(self) -> WindowShares:
        """Shares of pixels in windows, and moments of the windows, from subpixels."""
        placed, n_windows = self.placed_mask, self.layers * self.sectors
        subpixels = subpixels_by_strips(placed, self.windows_of_subpixels)
        left_out = hole_pixels(placed, self.holes)
        if left_out is None:
            return gather_shares(placed, n_windows, subpixels)
        return gather_shares(placed, n_windows, *without_pixels(subpixels, left_out, n_windows))

    @property
    def weights(self) -> sparse.csr_array:
        """Share of each mask pixel (row-major order) in each window, (windows, pixels).

        A column sums to 1, or to less where a pixel, or a part of it, lies in no window, as in excluded
        holes.
        """
        return self.shares.weights

    @property
    def subpixel_windows(self) -> IntArray:
        """Number of the window of each subpixel of the mask, shape (pixels, 16); -1 for none."""
        windows = np.concatenate(
            [self.windows_of_subpixels(block) for _, block in strips(self.placed_mask.pixels_yx)]
        )
        left_out = hole_pixels(self.placed_mask, self.holes)
        if left_out is not None:
            windows[left_out] = NOWHERE
        return windows

    @property
    def subpixel_labels(self) -> IntArray:
        """As `labels`, with each pixel divided into 4×4 subpixels, shape (4 H, 4 W)."""
        height, width = self.placed_mask.image_shape
        labels = np.full((height, PER_SIDE, width, PER_SIDE), -1, dtype=np.int64)
        row, column = self.placed_mask.pixels_yx.T
        labels[row, :, column, :] = self.subpixel_windows.reshape(-1, PER_SIDE, PER_SIDE)
        return labels.reshape(PER_SIDE * height, PER_SIDE * width)

    @cached_property
    def areas(self) -> FloatArray:
        """Area of each window in square pixels, shape (layers, sectors)."""
        return self._by_window(np.asarray(self.weights.sum(axis=1), dtype=np.float64).ravel())

    @property
    def filled_areas(self) -> FloatArray:
        """`areas` as if holes counted as cell, shape (layers, sectors)."""
        return self.areas + self._by_window(self.shares.hole_areas)

    @property
    def n_empty(self) -> int:
        """Number of windows that hold nothing of the cell."""
        return int((self.areas == 0).sum())

    @property
    def completeness(self) -> FloatArray:
        """Share of windows that hold signal, by layer, shape (layers,).

        References
        ----------
        u-Unwrap, section 4.1 and Fig. 3B.
        """
        return np.asarray((self.areas > 0).mean(axis=1))

    @property
    def coverage(self) -> float:
        """Share of the area within the outline that lies in a window, 0 to 1; excluded holes do not."""
        return float(self.areas.sum() / self.placed_mask.box.sum())

    @cached_property
    def labels(self) -> IntArray:
        """Number of the window with the largest share of each pixel, shape (H, W); -1 where there is none."""
        by_pixel = sparse.csc_array(self.weights)
        counts = np.diff(by_pixel.indptr)
        pixel = np.repeat(np.arange(by_pixel.shape[1]), counts)
        order = np.lexsort((by_pixel.data, pixel))
        held = np.full(by_pixel.shape[1], -1, dtype=np.int64)
        held[counts > 0] = by_pixel.indices[order][np.cumsum(counts)[counts > 0] - 1]
        labels = np.full(self.placed_mask.image_shape, -1, dtype=np.int64)
        self.placed_mask.cut_out_of(labels)[self.placed_mask.box] = held
        return labels

    @cached_property
    def centroids_yx(self) -> FloatArray:
        """Centre of each window's area, shape (layers, sectors, 2), (row, column) in pixels, or NaN."""
        return self._mean_moments[..., :2] + self.shares.origin_yx

    @cached_property
    def depths(self) -> FloatArray:
        """Median, 5th and 95th percentile of the distance of each window's subpixels to the cell's edge.

        Shape (layers, sectors, 3), in pixels; NaN if empty. The border of the image is no edge of the cell:
        beside it, the distance is that to the nearest edge in the image, and NaN if there is none.
        """
        found = window_depths(self.edge_distance, self.shares.subpixels, self.layers * self.sectors)
        return found.reshape(self.layers, self.sectors, len(DEPTHS))

    @property
    def depth_columns(self) -> dict[str, FloatArray]:
        """`depths` by name, each of shape (layers, sectors): depth, depth_p5, depth_p95, in pixels.

        Where a nucleus is known, too, nucleus_distance, nucleus_distance_p5 and nucleus_distance_p95.
        """
        columns = dict(zip(DEPTHS, np.moveaxis(self.depths, -1, 0), strict=True))
        if self.nucleus_distances is not None:
            columns |= zip(NUCLEUS_DISTANCES, np.moveaxis(self.nucleus_distances, -1, 0), strict=True)
        return columns

    @property
    def nucleus_distances(self) -> FloatArray | None:
        """As `depths`, from the outline of the nucleus on either side of it; None if none is known."""
        return None

    @cached_property
    def edge_distance(self) -> EdgeDistance:
        """Distance to the cell's edge from anywhere in it."""
        return EdgeDistance(self.placed_mask, self.outline_yx)

    @cached_property
    def eccentricities(self) -> FloatArray:
        """Eccentricity of the ellipse with each window's second moments, shape (layers, sectors), 0 to 1.

        Each subpixel counts as a square, so a window may be thinner than a pixel, but none has zero width.
        NaN if empty.
        """
        y, x, yy, xx, xy = np.moveaxis(self._mean_moments, -1, 0)
        yy, xx, xy = yy - y * y, xx - x * x, xy - x * y
        middle, root = 0.5 * (yy + xx), np.hypot(0.5 * (yy - xx), xy)
        return np.asarray(np.sqrt(np.clip(2.0 * root / (middle + root), 0.0, 1.0)))

    @cached_property
    def pieces(self) -> IntArray:
        """Number of pieces each window falls into, shape (layers, sectors); 0 if empty.

        A window is made of the pixels it has any share in, and pixels that touch, be it at a corner, are one
        piece. So what is counted is apart by a whole pixel at least.
        """
        return pieces_by_window(self.weights, self.placed_mask.box).reshape(self.layers, self.sectors)

    @cached_property
    def layer_pieces(self) -> IntArray:
        """Number of pieces that the windows of each layer fall into together, shape (layers,); 0 if empty.

        In a neck a layer of polar windows can be thinner than a subpixel, and then it counts as apart.
        """
        into_layers = sparse.kron(sparse.eye_array(self.layers), np.ones((1, self.sectors)))
        return pieces_by_window(sparse.csr_array(into_layers @ self.weights), self.placed_mask.box)

    @property
    def _mean_moments(self) -> FloatArray:
        """Means of y, x, y², x², x y in each window, shape (layers, sectors, 5); NaN if empty."""
        areas = np.where(self.areas > 0, self.areas, np.nan)
        return np.asarray(self.shares.moments.reshape(self.layers, self.sectors, 5) / areas[..., None])

    def _by_window(self, values: FloatArray) -> FloatArray:
        return values.reshape(self.layers, self.sectors)
