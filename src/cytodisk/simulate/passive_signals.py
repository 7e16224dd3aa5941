"""Images that follow no edge: patterns that stand still, a cortex that goes along, and camera noise."""

from collections.abc import Callable
from typing import Any, Literal, get_args

import numpy as np
import xarray as xr
from scipy.ndimage import gaussian_filter

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import one_of, whole_number
from cytodisk.errors import MaskError
from cytodisk.parameters import Parameters, parameter
from cytodisk.simulate.signals import depth
from cytodisk.taking import takes

PassiveKind = Literal["uniform", "still", "ring", "gradient", "texture", "cortex", "thickness"]
PASSIVE_KINDS: tuple[PassiveKind, ...] = get_args(PassiveKind)

_CENTRE_DECAY = 0.55  # of the cell's radius
_RING_AT, _RING_WIDTH_PX = 0.95, 2.0  # of the cell's radius; pixels
_CORTEX_DECAY_PX, _TEXTURE_PX, _THICK_PX = 5.0, 4.0, 20.0


class PassiveSignalParameters(Parameters):
    """How bright and how noisy a passive signal is."""

    peak: float = parameter(100.0, "Value where the pattern is highest.", above=0)
    noise: float = parameter(
        3.0, "Standard deviation of the camera's noise, independent between pixels and frames.", least=0
    )
    bleaching: float = parameter(
        0.0, "Share of the signal that is lost from the first frame to the last.", least=0, most=1
    )


@takes(PassiveSignalParameters)
def passive_signal(kind: PassiveKind, masks: BoolArray, seed: int = 0, **settings: Any) -> xr.DataArray:
    """A signal without biology: it knows nothing of how the edge moves.

    What correlates with the edge's velocity all the same is geometry: a mask that moves over a still pattern,
    or a pattern that goes along with the mask.

    Parameters
    ----------
    kind : str
        One of `PASSIVE_KINDS`. Still in the lab: "uniform"; "still" (decays from the centre of the cell);
        "ring" (a bright ring below the mean edge, like adhesions); "gradient" (grows along x); "texture"
        (smooth random spots). Fixed to the mask: "cortex" (decays with depth over 5 px); "thickness" (grows
        with depth, up to 20 px).
    masks : array_like of shape (T, H, W) and dtype bool
        One cell. Centre and radius of the still patterns are those of its mean over the movie.
    seed : int
        Draws noise and texture; the same arguments give the same signal.
    **settings
        See `PassiveSignalParameters`.

    Returns
    -------
    DataArray with dims (time, y, x) and dtype float

    Raises
    ------
    MaskError
        The masks are not 3D or all empty.
    ParameterError
        An unknown kind or a number out of its range.

    See Also
    --------
    movie : Masks of moving cells, and signals that do follow the edge.
    geometry_controls : What geometry alone would give.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("fluctuating", frames=5, radius_px=15.0, signals=False)
    >>> signal = cd.simulate.passive_signal("still", truth.masks, noise=0.0)
    >>> signal.dims, bool((signal[0] == signal[4]).all())
    (('time', 'y', 'x'), True)
    """
    kind, seed = one_of("kind", kind, PASSIVE_KINDS), whole_number("seed", seed, 0)
    how = PassiveSignalParameters.of(**settings)
    cell = np.asarray(masks, dtype=bool)
    if cell.ndim != 3 or not cell.any():
        raise MaskError(
            f"masks must be 3D (frames, rows, columns) and hold a cell, got shape {cell.shape}: pass "
            "those of a movie"
        )
    random = np.random.default_rng([seed, 7])
    expected = how.peak * _PATTERNS[kind](cell, random)
    left = 1.0 - how.bleaching * np.linspace(0.0, 1.0, len(cell))
    noise = how.noise * random.normal(size=cell.shape)
    return xr.DataArray(left[:, None, None] * expected + noise, dims=("time", "y", "x"), name=kind)


def _uniform(masks: BoolArray, random: np.random.Generator) -> FloatArray:
    return np.ones(masks.shape[1:])


def _from_centre(masks: BoolArray, random: np.random.Generator) -> FloatArray:
    distance, radius = _distance(masks)
    return np.asarray(np.exp(-distance / (_CENTRE_DECAY * radius)))


def _ring(masks: BoolArray, random: np.random.Generator) -> FloatArray:
    distance, radius = _distance(masks)
    return np.asarray(np.exp(-(((distance - _RING_AT * radius) / _RING_WIDTH_PX) ** 2)))


def _gradient(masks: BoolArray, random: np.random.Generator) -> FloatArray:
    return np.broadcast_to(np.linspace(0.0, 1.0, masks.shape[2]), masks.shape[1:])


def _texture(masks: BoolArray, random: np.random.Generator) -> FloatArray:
    spots = gaussian_filter(random.normal(size=masks.shape[1:]), _TEXTURE_PX)
    return np.asarray(np.clip(0.7 + 0.14 * spots / spots.std(), 0.0, None))


def _cortex(masks: BoolArray, random: np.random.Generator) -> FloatArray:
    return np.stack([np.where(mask, np.exp(-depth(mask) / _CORTEX_DECAY_PX), 0.0) for mask in masks])


def _thickness(masks: BoolArray, random: np.random.Generator) -> FloatArray:
    return np.stack([np.minimum(depth(mask) / _THICK_PX, 1.0) for mask in masks])


_PATTERNS: dict[PassiveKind, Callable[[BoolArray, np.random.Generator], FloatArray]] = {
    "uniform": _uniform,
    "still": _from_centre,
    "ring": _ring,
    "gradient": _gradient,
    "texture": _texture,
    "cortex": _cortex,
    "thickness": _thickness,
}


def _distance(masks: BoolArray) -> tuple[FloatArray, float]:
    """Distance of each pixel from the mean cell's centroid, and the mean cell's radius, in pixels."""
    share = masks.mean(axis=0)
    row, column = np.indices(share.shape)
    centre = [(share * place).sum() / share.sum() for place in (row, column)]
    frames = masks.any(axis=(1, 2)).sum()
    radius = np.sqrt(masks.sum() / (np.pi * frames))
    return np.asarray(np.hypot(row - centre[0], column - centre[1])), float(radius)
