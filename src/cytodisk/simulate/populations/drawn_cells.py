"""One cell of an image: its mask, its nucleus, the region and the signals."""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.geometry.mask import clean_mask
from cytodisk.simulate.drawing import half_covered
from cytodisk.simulate.nuclei.cells_with_nuclei import deepest_place
from cytodisk.simulate.nuclei.nucleus_shapes import oval
from cytodisk.simulate.populations.population_image_parameters import PopulationImageParameters
from cytodisk.simulate.random_cells import random_smooth, random_spiky
from cytodisk.simulate.signals import depth

_REGION_DEPTH, _REGION_DEG = 1.0 / 3.0, 60.0  # of the largest depth; to both sides of its direction
_NUCLEUS, _ASIDE = 0.4, 0.4  # radius, and distance from the deepest place, in depths
_CORTEX_PX, _CORTEX = 4.0, 0.6  # how deep the cortex reaches, and how bright it is
_TEXTURE_PX, _TEXTURE = 2.5, 0.15  # smooth noise within a cell


@dataclass(frozen=True, eq=False)
class DrawnCell:
    """A cell in its box.

    Attributes
    ----------
    mask, nucleus, region : ndarray of shape (h, w) and dtype bool
    signals : ndarray of shape (C, h, w) and dtype float
        Without noise; 1 is the mean of a cell of brightness 1 deep inside, 0 is outside.
    arms : bool
    brightness : float
    direction_deg : float
        Of the region, from +x towards +y.
    """

    mask: BoolArray
    nucleus: BoolArray
    region: BoolArray
    signals: FloatArray
    arms: bool
    brightness: float
    direction_deg: float


def drawn_cell(
    how: PopulationImageParameters, effect: float, brightness: float, random: np.random.Generator
) -> DrawnCell:
    """A random cell with a cortex, brighter in its region by a share."""
    arms = bool(random.random() < how.arms)
    mask = clean_mask(_mask(how.radius_px, arms, random))[0]
    inward = depth(mask)
    place, deep = deepest_place(mask)
    towards = random.uniform(0.0, 2.0 * np.pi) if how.nuclei else np.pi
    nucleus = np.zeros_like(mask)
    if how.nuclei:
        centre = place + _ASIDE * deep * np.array([np.sin(towards), np.cos(towards)])
        outline = oval(np.pi * (_NUCLEUS * deep) ** 2) + centre
        nucleus = half_covered(outline, (mask.shape[0], mask.shape[1])) & mask
    centroid = np.argwhere(mask).mean(axis=0)
    if how.nuclei:  # as the user can see it: from the nucleus' centroid to the cell's
        away = centroid - np.argwhere(nucleus).mean(axis=0)
        direction = float(np.degrees(np.arctan2(*away)) % 360.0)
    else:
        direction = 0.0
    region = _region(mask, inward, centroid, direction)
    plain = 1.0 + _CORTEX * np.exp(-inward / _CORTEX_PX)
    signals = np.stack([brightness * plain * _texture(mask, random) for _ in how.channels])
    signals[0] *= 1.0 + effect * region
    return DrawnCell(mask, nucleus, region, signals, arms, brightness, direction)


def _mask(radius: float, arms: bool, random: np.random.Generator) -> BoolArray:
    seed = int(random.integers(2**31))
    if not arms:
        return random_smooth(seed, radius=radius * random.uniform(0.85, 1.15), roughness=0.08, margin=0)
    return random_spiky(
        seed,
        radius=0.8 * radius,
        spikes=int(random.integers(3, 6)),
        spike_length=0.9 * radius,
        spike_width=0.3 * radius,
        margin=0,
    )


def _region(mask: BoolArray, inward: FloatArray, centroid: FloatArray, direction: float) -> BoolArray:
    row, column = np.indices(mask.shape)
    angle = np.degrees(np.arctan2(row - centroid[0], column - centroid[1])) - direction
    beside = np.abs((angle + 180.0) % 360.0 - 180.0) <= _REGION_DEG
    return np.asarray(mask & beside & (inward <= _REGION_DEPTH * inward.max()))


def _texture(mask: BoolArray, random: np.random.Generator) -> FloatArray:
    """Smooth noise of mean 1 in a cell, 0 outside."""
    noise = ndimage.gaussian_filter(random.normal(size=mask.shape), _TEXTURE_PX)
    inside = noise[mask]
    smooth = np.exp(_TEXTURE * (noise - inside.mean()) / max(float(inside.std()), 1e-9))
    return np.asarray(np.where(mask, smooth / smooth[mask].mean(), 0.0))
