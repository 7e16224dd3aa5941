"""`WindowsOnCell`: what all windows on one cell have in common, polar, edge-based or rings."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np
from scipy import sparse

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.windows.pieces import pieces_by_window

PARTS = 4  # along a pixel's side


class WindowsOnCell(ABC):
    """Windows in a cell, by layer from the edge (0) inwards and sector along the edge.

    Window (layer, sector) has number layer · sectors + sector. A window that holds nothing of the cell is
    empty: its area is 0, and what cannot be measured of it is NaN.
    """

    @property
    @abstractmethod
    def mask(self) -> BoolArray:
        """The cell's mask, shape (H, W) and dtype bool."""

    @property
    @abstractmethod
    def layers(self) -> int:
        """Number of layers."""

    @property
    @abstractmethod
    def sectors(self) -> int:
        """Number of sectors."""

    @property
    @abstractmethod
    def weights(self) -> sparse.csr_array:
        """Share of each mask pixel (row-major order) in each window, (windows, pixels); sums to ≤ 1."""

    @property
    @abstractmethod
    def part_windows(self) -> IntArray:
        """Number of the window that each part of each mask pixel lies in, shape (pixels, 16); -1 for none."""

    @property
    def part_labels(self) -> IntArray:
        """As `labels`, with each pixel divided into 4×4 parts, shape (4 H, 4 W)."""
        height, width = self.mask.shape
        labels = np.full((height, PARTS, width, PARTS), -1, dtype=np.int64)
        row, column = np.nonzero(self.mask)
        labels[row, :, column, :] = self.part_windows.reshape(-1, PARTS, PARTS)
        return labels.reshape(PARTS * height, PARTS * width)

    @cached_property
    def areas(self) -> FloatArray:
        """Area of each window in square pixels, shape (layers, sectors)."""
        return self._by_window(np.asarray(self.weights.sum(axis=1), dtype=np.float64).ravel())

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
        """Share of the cell's area that lies in a window, 0 to 1."""
        return float(self.areas.sum() / self.mask.sum())

    @cached_property
    def labels(self) -> IntArray:
        """Number of the window with the largest share of each pixel, shape (H, W); -1 where there is none."""
        by_pixel = sparse.csc_array(self.weights)
        counts = np.diff(by_pixel.indptr)
        pixel = np.repeat(np.arange(by_pixel.shape[1]), counts)
        order = np.lexsort((by_pixel.data, pixel))
        held = np.full(by_pixel.shape[1], -1, dtype=np.int64)
        held[counts > 0] = by_pixel.indices[order][np.cumsum(counts)[counts > 0] - 1]
        labels = np.full(self.mask.shape, -1, dtype=np.int64)
        labels[self.mask] = held
        return labels

    @cached_property
    def centroids_yx(self) -> FloatArray:
        """Centre of mass of each window, shape (layers, sectors, 2), (row, column) in pixels, or NaN."""
        return self._means(np.argwhere(self.mask).astype(np.float64))

    @cached_property
    def eccentricities(self) -> FloatArray:
        """Eccentricity of the ellipse with each window's second moments, shape (layers, sectors), 0 to 1.

        A pixel counts as a square of side 1, so no window has zero width. NaN if empty.
        """
        points = np.argwhere(self.mask).astype(np.float64)
        products = np.column_stack([points[:, 0] ** 2, points[:, 1] ** 2, points[:, 0] * points[:, 1]])
        mean = self._means(products)
        y, x = self.centroids_yx[..., 0], self.centroids_yx[..., 1]
        yy, xx, xy = mean[..., 0] - y * y + 1 / 12, mean[..., 1] - x * x + 1 / 12, mean[..., 2] - x * y
        middle, root = 0.5 * (yy + xx), np.hypot(0.5 * (yy - xx), xy)
        return np.asarray(np.sqrt(np.clip(2.0 * root / (middle + root), 0.0, 1.0)))

    @cached_property
    def pieces(self) -> IntArray:
        """Number of pieces each window falls into, shape (layers, sectors); 0 if empty.

        A window is made of the pixels it has any share in, and pixels that touch, be it at a corner, are one
        piece. So what is counted is apart by a whole pixel at least.
        """
        return pieces_by_window(self.weights, self.mask).reshape(self.layers, self.sectors)

    @cached_property
    def layer_pieces(self) -> IntArray:
        """Number of pieces that the windows of each layer fall into together, shape (layers,); 0 if empty.

        In a neck a layer of polar windows can be thinner than the parts that pixels are divided into, and
        then it counts as apart.
        """
        into_layers = sparse.kron(sparse.eye_array(self.layers), np.ones((1, self.sectors)))
        return pieces_by_window(sparse.csr_array(into_layers @ self.weights), self.mask)

    def _means(self, values: FloatArray) -> FloatArray:
        """Mean of pixel values (P, K) in each window, shape (layers, sectors, K); NaN if empty."""
        sums = np.asarray(self.weights @ values).reshape(self.layers, self.sectors, -1)
        areas = np.where(self.areas > 0, self.areas, np.nan)
        return np.asarray(sums / areas[..., None])

    def _by_window(self, values: FloatArray) -> FloatArray:
        return values.reshape(self.layers, self.sectors)
