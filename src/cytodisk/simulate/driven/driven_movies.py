"""Movies of a cell whose edge moves as series say, and whose channels are as bright as series say."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import tifffile
import xarray as xr
from scipy.ndimage import map_coordinates, spline_filter
from scipy.signal import lfilter
from scipy.spatial import cKDTree
from scipy.special import expit

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import is_path
from cytodisk.errors import ParameterError
from cytodisk.files import make_folder
from cytodisk.geometry.polygon import edge_lengths
from cytodisk.scale import Scale
from cytodisk.simulate.drawing import half_covered
from cytodisk.simulate.driven.driven_cell_parameters import DrivenCellParameters
from cytodisk.simulate.growing_edges import swept_velocity
from cytodisk.simulate.jittered_masks import evenly_spaced, jittered
from cytodisk.simulate.movie_signals import camera, rasterised
from cytodisk.simulate.moving_cells import image_frame
from cytodisk.simulate.paths import BOUNDARY_POINTS
from cytodisk.simulate.pose import Pose
from cytodisk.simulate.resting_shapes import lobed

_ROUGHNESS, _THINNEST = 0.03, 0.3  # height of lobes; least distance from the centre: of the radius
_JITTER_LENGTH, _MARGIN = 8.0, 10  # pixels
_BACKGROUND, _BRIGHTNESS, _DIMMEST = 20.0, 400.0, 5.0  # counts
_FADE = 1.0  # pixels over which what happens at the edge goes over into the inside
_WRAP = 8  # sectors beyond either end, so that splines go around


@dataclass(frozen=True, eq=False)
class DrivenMovie:
    """A movie of one cell and the series that moved its edge and made its channels.

    Attributes
    ----------
    masks : ndarray of shape (T, H, W) and dtype bool
        Pixels of which the drawn outline, the true one or one with jitter, covers half or more.
    signal : DataArray with dims (time, channel, y, x) and dtype uint16
        What a camera would count, with Poisson noise; attrs `pixel_size_um` and `frame_interval_s`.
    boundary_yx : ndarray of shape (T, N, 2) and dtype float
        Points of the true edge, (row, column) in pixels, from +x towards +y.
    series : Dataset with dims (time, sector)
        What moved the edge, and each channel; sector s is at the angle 2π s / sectors from +x towards +y in
        the cell, in frame 0 of the image too. Its attrs are the truth.
    pixel_size_um, frame_interval_s : float

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.wave_movie("running", frames=3, radius_px=15.0)
    >>> cell.masks.shape[0], cell.signal.dims, cell.velocity_px.shape
    (3, ('time', 'channel', 'y', 'x'), (3, 3000))
    """

    masks: BoolArray
    signal: xr.DataArray
    boundary_yx: FloatArray
    series: xr.Dataset
    pixel_size_um: float
    frame_interval_s: float

    @property
    def truth(self) -> dict[str, Any]:
        """What is known of the series."""
        return self.series.attrs

    @property
    def scale(self) -> Scale:
        """Both sizes, as maps and arrays carry them."""
        return Scale(self.pixel_size_um, self.frame_interval_s)

    @cached_property
    def velocity_px(self) -> FloatArray:
        """True velocity of each piece of the edge, from a boundary point to the next; shape (T, N).

        In pixels per frame, outward positive; NaN in the last frame.
        """
        return swept_velocity(self.boundary_yx)

    def write(self, folder: str | os.PathLike[str]) -> tuple[Path, Path]:
        """Write masks and signal as a user has them, with the names of the channels, pixel size and interval.

        Parameters
        ----------
        folder : path-like
            Is made if it is not there; files of the same names in it are replaced.

        Returns
        -------
        (Path, Path)
            masks.tif and signal.ome.tif.

        Raises
        ------
        ParameterError
            `folder` is no path.
        """
        is_path("folder", folder)
        make_folder(Path(folder))
        masks, signal = Path(folder) / "masks.tif", Path(folder) / "signal.ome.tif"
        tifffile.imwrite(masks, self.masks.astype(np.uint8))
        metadata: dict[str, Any] = {
            "axes": "TCYX",
            "Channel": {"Name": self.signal["channel"].values.tolist()},
            "TimeIncrement": self.frame_interval_s,
            "TimeIncrementUnit": "s",
        }
        for axis in "XY":
            metadata |= {f"PhysicalSize{axis}": self.pixel_size_um, f"PhysicalSize{axis}Unit": "µm"}
        tifffile.imwrite(signal, self.signal.to_numpy(), metadata=metadata, ome=True)
        return masks, signal


@dataclass(frozen=True, eq=False)
class ChannelSeries:
    """How bright a channel is, by depth and angle.

    Attributes
    ----------
    values : ndarray of shape (T, L, S) and dtype float
        0 is the mean, 1 brighter by the contrast.
    layer_depth_px : float
        Depth of each layer.
    inside : ndarray of shape (T, S) and dtype float, optional
        What takes the place of `values` deeper than the edge reaches.
    """

    values: FloatArray
    layer_depth_px: float = 1.0
    inside: FloatArray | None = None


def resting_edge(seed: int, how: DrivenCellParameters, pushes: FloatArray) -> FloatArray:
    """True edge of a cell that series push in and out along its radii.

    Parameters
    ----------
    seed : int
        Draws the shape at rest.
    how : DrivenCellParameters
    pushes : ndarray of shape (T, S) and dtype float
        Speed of each sector over `edge_speed_px`, from a frame to the next.

    Returns
    -------
    ndarray of shape (T, 3000, 2) and dtype float
        (row, column) in pixels, from the cell's centre, in its own frame.

    Raises
    ------
    ParameterError
        The edge comes too close to the centre.
    """
    rest = evenly_spaced(lobed(np.random.default_rng([seed, 40]), how.radius_px, _ROUGHNESS), BOUNDARY_POINTS)
    y, x = rest.T
    away = lfilter([0.0, 1.0], [1.0, -np.exp(-1.0 / how.relaxation)], pushes, axis=0)
    angle = np.arctan2(y, x)
    moved = np.stack([_around(row[None], angle, np.zeros_like(angle)) for row in away])
    reach = np.hypot(y, x) + how.edge_speed_px * moved
    if reach.min() < _THINNEST * how.radius_px:
        raise ParameterError(
            f"edge_speed_px={how.edge_speed_px:g} takes the edge within {max(reach.min(), 0.0):.0f} px of "
            f"the centre of a cell of radius {how.radius_px:g} px: take a lower one, a shorter relaxation or "
            "a larger radius_px"
        )
    return np.asarray(reach[..., None] * np.stack([np.sin(angle), np.cos(angle)], axis=-1))


def driven_movie(
    seed: int,
    how: DrivenCellParameters,
    edge_yx: FloatArray,
    channels: Mapping[str, ChannelSeries],
    series: xr.Dataset,
) -> DrivenMovie:
    """Draw masks and channels of a cell whose edge is known.

    Parameters
    ----------
    seed : int
    how : DrivenCellParameters
    edge_yx : ndarray of shape (T, N, 2) and dtype float
        See `resting_edge`.
    channels : mapping of str to ChannelSeries
    series : Dataset
        Kept as the truth.

    Returns
    -------
    DrivenMovie
    """
    pose = Pose(how.radius_px, turn=np.radians(how.turn_deg))
    boundary = np.stack([pose.to_image(outline, frame) for frame, outline in enumerate(edge_yx)])
    drawn = jittered(boundary, how.jitter_px, _JITTER_LENGTH, np.random.default_rng([seed, 41]))
    shape, shift = image_frame(drawn, _MARGIN)
    boundary, drawn = boundary + shift, drawn + shift
    counts = np.zeros((how.frames, len(channels), *shape))
    for frame, outline in enumerate(boundary):
        inside = rasterised(outline, shape)
        pixels = np.argwhere(inside).astype(np.float64)
        row, column = pose.to_cell(pixels - shift, frame).T
        tree = cKDTree(outline, leafsize=64, compact_nodes=False, balanced_tree=False)
        depth = np.asarray(tree.query(pixels)[0], dtype=np.float64)
        counts[frame] = _BACKGROUND
        for k, channel in enumerate(channels.values()):
            level = _level(channel, frame, np.arctan2(row, column), depth, how.depth_px)
            counts[frame, k, inside] += np.maximum(_BRIGHTNESS * (1.0 + how.contrast * level), _DIMMEST)
    scale = Scale(how.pixel_size_um, how.frame_interval_s)
    expected = xr.DataArray(
        counts, {"channel": list(channels)}, ("time", "channel", "y", "x"), attrs=scale.attrs
    )
    return DrivenMovie(
        masks=np.stack([half_covered(outline, shape) for outline in drawn]),
        signal=camera(expected, np.random.default_rng([seed, 42])),
        boundary_yx=boundary,
        series=series,
        pixel_size_um=how.pixel_size_um,
        frame_interval_s=how.frame_interval_s,
    )


def mean_length_um(edge_yx: FloatArray, pixel_size_um: float) -> float:
    """Length of the true edge, mean over the frames."""
    return float(np.mean([edge_lengths(outline).sum() for outline in edge_yx]) * pixel_size_um)


def _level(
    channel: ChannelSeries, frame: int, angle: FloatArray, depth: FloatArray, reaches: float
) -> FloatArray:
    layer = np.clip(depth / channel.layer_depth_px - 0.5, 0.0, len(channel.values[frame]) - 1.0)
    level = _around(channel.values[frame], angle, layer)
    if channel.inside is None:
        return level
    share = expit((reaches - depth) / _FADE)
    return share * level + (1.0 - share) * _around(channel.inside[frame][None], angle, np.zeros_like(angle))


def _around(values: FloatArray, angle: FloatArray, layer: FloatArray) -> FloatArray:
    """Splines through values (L, S) at angles and at layers between the first and the last."""
    sectors = values.shape[1]
    around = spline_filter(np.pad(values, ((0, 0), (_WRAP, _WRAP)), mode="wrap"), mode="nearest")
    sector = angle / (2.0 * np.pi) * sectors % sectors + _WRAP
    return np.asarray(map_coordinates(around, [layer, sector], prefilter=False, mode="nearest"))
