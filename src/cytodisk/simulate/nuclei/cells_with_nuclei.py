"""One cell with its nucleus in the places that microscopists know."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import number_between, one_of, whole_number
from cytodisk.geometry.mask import clean_mask
from cytodisk.simulate.cells import disk
from cytodisk.simulate.drawing import half_covered
from cytodisk.simulate.nuclei.nucleus_shapes import bean, oval
from cytodisk.simulate.random_cells import branching, migrating, random_spiky
from cytodisk.simulate.signals import depth

NucleusKind = Literal["centred", "off centre", "touching", "bean", "two"]
NUCLEUS_KINDS: tuple[NucleusKind, ...] = get_args(NucleusKind)
CellShape = Literal["round", "spread", "spiky", "branched"]
CELL_SHAPES: tuple[CellShape, ...] = get_args(CellShape)

_SPREAD_RADIUS = 69.0  # px, of the disk of the same area as a migrating cell of size 1
_CLOSEST = 2.0  # px between nucleus and membrane, and between two nuclei
_OVERLAP = 0.5  # px by which a nucleus that touches the membrane would stand out of it
_LARGEST = {"centred": 0.8, "off centre": 0.6, "touching": 0.6, "bean": 0.85, "two": 0.38}  # of the depth


@dataclass(frozen=True, eq=False)
class CellWithNucleus:
    """A cell and its nucleus, and what is known of them.

    Attributes
    ----------
    mask, nucleus : ndarray of shape (H, W) and dtype bool
        The nucleus lies inside the mask; for "two" it has two pieces.
    nuclei_yx : tuple of ndarray of shape (720, 2) and dtype float
        The outline that was drawn of each nucleus, (row, column) in pixels. Of a nucleus that touches the
        membrane a sliver lies outside of the cell.
    centres_yx : ndarray of shape (1 or 2, 2) and dtype float
        Centroid of each of these outlines.
    kind : str
    shape : str
    seed : int

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.cell_with_nucleus("centred", radius_px=30.0, nucleus_share=0.25)
    >>> cell.centres_yx.round(1).tolist()  # the middle of the image
    [[38.0, 38.0]]
    """

    mask: BoolArray
    nucleus: BoolArray
    nuclei_yx: tuple[FloatArray, ...]
    centres_yx: FloatArray
    kind: NucleusKind
    shape: CellShape
    seed: int


def cell_with_nucleus(
    kind: NucleusKind = "centred",
    seed: int = 0,
    *,
    shape: CellShape = "round",
    radius_px: float = 40.0,
    nucleus_share: float = 0.15,
) -> CellWithNucleus:
    """A cell with a nucleus whose place and outline are known.

    Parameters
    ----------
    kind : {"centred", "off centre", "touching", "bean", "two"}
        "centred": a round nucleus where the cell is deepest. "off centre": close to the membrane, at least
        2 px away. "touching": it touches the membrane. "bean": bent, where the cell is deepest. "two": two
        round nuclei beside that place, at least 2 px apart.
    seed : int
        Directions, and the cell's outline if `shape` is not "round"; the same seed gives the same cell.
    shape : {"round", "spread", "spiky", "branched"}
        "round" is a plain disk, so with a "centred" nucleus all answers are known on paper.
    radius_px : float
        Size of the cell, at least 20: for "round" its radius, for "spread" that of the disk of the same area,
        else roughly that.
    nucleus_share : float
        Share of the cell's area that the nucleus has, both of two together, 0.01 to 0.6. Where the cell is
        not deep enough, the nucleus is smaller.

    Returns
    -------
    CellWithNucleus

    Raises
    ------
    ParameterError
        An unknown kind or shape, or a number out of its range.

    See Also
    --------
    profile_signal : A signal between nucleus and membrane.
    label_image_with_nuclei : Many cells.
    movie_with_nuclei : A cell that moves.
    random_pair : Every shape that could break a map.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.cell_with_nucleus("off centre", seed=1, shape="spread")
    >>> round(float(cell.nucleus.sum() / cell.mask.sum()), 2)
    0.15
    """
    kind, shape = one_of("kind", kind, NUCLEUS_KINDS), one_of("shape", shape, CELL_SHAPES)
    seed = whole_number("seed", seed, 0)
    radius_px = number_between("radius_px", radius_px, 20.0)
    nucleus_share = number_between("nucleus_share", nucleus_share, 0.01, 0.6)
    mask = clean_mask(_SHAPES[shape](seed, radius_px))[0]
    random = np.random.default_rng([13, seed])
    outlines = _outlines(kind, mask, nucleus_share * float(mask.sum()), random)
    size = (mask.shape[0], mask.shape[1])
    nucleus = np.any([half_covered(outline, size) for outline, _ in outlines], axis=0) & mask
    return CellWithNucleus(
        mask=mask,
        nucleus=nucleus,
        nuclei_yx=tuple(outline for outline, _ in outlines),
        centres_yx=np.array([centre for _, centre in outlines]),
        kind=kind,
        shape=shape,
        seed=seed,
    )


def deepest_place(mask: BoolArray) -> tuple[FloatArray, float]:
    """The pixel farthest from the edge, of several the one nearest to the centroid; its depth in pixels."""
    inward = depth(mask)
    places = np.argwhere(inward >= inward.max() - 1e-9).astype(np.float64)
    middle = np.argwhere(mask).mean(axis=0)
    away = np.hypot(*(places - middle).T)
    return places[int(away.argmin())], float(inward.max())


def _outlines(
    kind: NucleusKind, mask: BoolArray, area: float, random: np.random.Generator
) -> list[tuple[FloatArray, FloatArray]]:
    """Outline and centre of each nucleus."""
    deepest, deep = deepest_place(mask)
    angle, room = random.uniform(0.0, 2.0 * np.pi), _LARGEST[kind] * deep
    if kind == "bean":
        reach = np.hypot(*bean(1.0).T).max()  # grows with the root of the area
        return [(bean(min(area, (room / reach) ** 2), angle) + deepest, deepest)]
    if kind == "two":
        radius = min(np.sqrt(0.5 * area / np.pi), room)
        away = (radius + _CLOSEST) * np.array([np.sin(angle), np.cos(angle)])
        return [_round(radius, deepest + away), _round(radius, deepest - away)]
    radius = min(np.sqrt(area / np.pi), room)
    if kind == "centred":
        return [_round(radius, deepest)]
    at_depth = radius + (max(_CLOSEST, 0.1 * radius) if kind == "off centre" else -_OVERLAP)
    return [_round(radius, _place_at(depth(mask), at_depth, random))]


def _place_at(inward: FloatArray, at_depth: float, random: np.random.Generator) -> FloatArray:
    """A pixel at a depth, or up to a pixel deeper."""
    places = np.argwhere((inward >= at_depth) & (inward < at_depth + 1.0))
    return np.asarray(random.choice(places), dtype=np.float64)


def _round(radius: float, centre: FloatArray) -> tuple[FloatArray, FloatArray]:
    return oval(np.pi * radius**2) + centre, centre


def _disk(seed: int, radius: float) -> BoolArray:
    return disk(radius)


def _spread(seed: int, radius: float) -> BoolArray:
    return migrating(seed, size=radius / _SPREAD_RADIUS)


def _spiky(seed: int, radius: float) -> BoolArray:
    return random_spiky(seed, radius=0.9 * radius, spikes=10, spike_length=0.8 * radius)


def _branched(seed: int, radius: float) -> BoolArray:
    return branching(
        seed, soma_radius=0.6 * radius, processes=5, process_length=1.8 * radius, process_width=5.0
    )


_SHAPES: dict[CellShape, Callable[[int, float], BoolArray]] = {
    "round": _disk,
    "spread": _spread,
    "spiky": _spiky,
    "branched": _branched,
}
