"""Random cells with a nucleus of every kind that could break a map: for tests and benchmarks."""

from collections.abc import Callable

import numpy as np
from scipy import ndimage
from skimage.graph import MCP_Geometric

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import whole_number
from cytodisk.geometry.mask import clean_mask
from cytodisk.simulate.drawing import half_covered
from cytodisk.simulate.nuclei.nucleus_shapes import EIGHT, bean, oval, room_for_nucleus
from cytodisk.simulate.random_cells import branching, random_smooth, random_spiky

PAIR_CELLS = ("smooth", "spiky", "branched")
PAIR_NUCLEI = ("oval", "bean", "ball", "rough", "in an arm", "largest")
_SMALLEST, _LARGEST = 0.01, 0.8  # shares of the cell's area
_GAPS = (1, 1, 1, 2, 3, 5)  # px of cytoplasm around each nuclear pixel, at least


def random_pair(seed: int = 0) -> tuple[BoolArray, BoolArray]:
    """A random cell and a nucleus that a map of both accepts as it is.

    Parameters
    ----------
    seed : int
        The same seed gives the same pair. See `random_pair_kinds` for what it shows.

    Returns
    -------
    mask : ndarray of shape (H, W) and dtype bool
        One cell without holes, of some dozens to some thousands of pixels.
    nucleus : ndarray of shape (H, W) and dtype bool
        One piece without holes, from 1 % to 80 % of the cell's area, at least 1 px. All 8 neighbours of each
        of its pixels are cell pixels. Where the cytoplasm is narrowest it is 1 px wide in half of the pairs.

    Raises
    ------
    ParameterError
        `seed` is not a whole number of at least 0.

    See Also
    --------
    random_pair_kinds : What a seed shows.
    cell_with_nucleus : Kinds of nuclei that microscopists know.
    random_mask : Cells alone.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask, nucleus = cd.simulate.random_pair(3)
    >>> bool((mask | nucleus).sum() == mask.sum())  # the nucleus lies in the cell
    True
    """
    cell, kind = random_pair_kinds(seed)
    random = np.random.default_rng([11, seed])
    while True:
        mask = clean_mask(_CELLS[cell](random))[0]
        room = room_for_nucleus(mask, 1 if kind == "largest" else int(random.choice(_GAPS)))
        if not room.any():
            continue
        nucleus = _filled(_NUCLEI[kind](random, room, _target(random, kind, int(mask.sum()))))
        if _SMALLEST <= nucleus.sum() / mask.sum() <= _LARGEST:
            return mask, nucleus


def random_pair_kinds(seed: int) -> tuple[str, str]:
    """Kind of cell and kind of nucleus that `random_pair` gives for a seed; they take turns.

    Parameters
    ----------
    seed : int

    Returns
    -------
    cell : str
        One of `PAIR_CELLS`.
    nucleus : str
        One of `PAIR_NUCLEI`: "oval" and "bean" (smooth, cut off before the membrane), "ball" (grows from
        a random place along the ways inside the cell), "rough" (the same with a ragged outline), "in an arm"
        (starts where the cell is thin) and "largest" (40 to 80 % of the cell, as far as there is room).

    Raises
    ------
    ParameterError
        `seed` is not a whole number of at least 0.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cd.simulate.random_pair_kinds(4)
    ('spiky', 'bean')
    """
    seed = whole_number("seed", seed, 0)
    return PAIR_CELLS[seed % len(PAIR_CELLS)], PAIR_NUCLEI[seed // len(PAIR_CELLS) % len(PAIR_NUCLEI)]


def _target(random: np.random.Generator, kind: str, cell_px: int) -> int:
    """Pixels that the nucleus shall have, if there is room."""
    if kind == "largest":
        share = random.uniform(0.5 * _LARGEST, _LARGEST)
    else:
        share = np.exp(random.uniform(np.log(_SMALLEST), np.log(_LARGEST)))
    return int(np.ceil(share * cell_px))


def _smooth(random: np.random.Generator) -> BoolArray:
    radius = np.exp(random.uniform(np.log(4.0), np.log(40.0)))
    return random_smooth(_seed(random), radius=radius, roughness=random.uniform(0.0, 0.5), margin=2)


def _spiky(random: np.random.Generator) -> BoolArray:
    return random_spiky(
        _seed(random),
        radius=random.uniform(4.0, 20.0),
        spikes=int(random.integers(1, 25)),
        spike_length=random.uniform(1.0, 40.0),
        spike_width=random.uniform(1.0, 9.0),
        margin=2,
    )


def _branched(random: np.random.Generator) -> BoolArray:
    return branching(
        _seed(random),
        soma_radius=random.uniform(3.0, 12.0),
        processes=int(random.integers(1, 6)),
        process_length=random.uniform(5.0, 50.0),
        process_width=random.uniform(2.0, 9.0),
        branch_every=random.uniform(10.0, 60.0),
        margin=2,
    )


def _oval(random: np.random.Generator, room: BoolArray, target: int) -> BoolArray:
    return _drawn(random, room, oval(target, random.uniform(1.0, 3.0), random.uniform(0.0, np.pi)))


def _bean(random: np.random.Generator, room: BoolArray, target: int) -> BoolArray:
    return _drawn(random, room, bean(target, random.uniform(0.0, 2.0 * np.pi)))


def _drawn(random: np.random.Generator, room: BoolArray, outline_yx: FloatArray) -> BoolArray:
    """What lies inside an outline about a random place, of one piece and with that place."""
    start = _place(random, room)
    inside = half_covered(outline_yx + np.array(start), (room.shape[0], room.shape[1])) & room
    inside[start] = True
    return _piece(inside, start)


def _ball(random: np.random.Generator, room: BoolArray, target: int) -> BoolArray:
    return _grown(room, _place(random, room), target, np.ones(room.shape))


def _rough(random: np.random.Generator, room: BoolArray, target: int) -> BoolArray:
    return _grown(room, _place(random, room), target, np.exp(random.normal(0.0, 1.5, room.shape)))


def _in_an_arm(random: np.random.Generator, room: BoolArray, target: int) -> BoolArray:
    """Starts at a place that is among the thinnest, far from where the cell is thick."""
    depth = ndimage.distance_transform_edt(room)
    away = ndimage.distance_transform_edt(depth < 0.7 * depth.max())
    thin = away >= np.quantile(away[room], 0.9)
    return _grown(room, _place(random, room & thin), target, np.exp(random.normal(0.0, 0.3, room.shape)))


def _largest(random: np.random.Generator, room: BoolArray, target: int) -> BoolArray:
    """Leaves as even a cytoplasm as it can: starts at the deepest place."""
    depth = ndimage.distance_transform_edt(room)
    row, column = np.unravel_index(int(depth.argmax()), room.shape)
    return _grown(room, (int(row), int(column)), target, 1.0 / depth.clip(0.5))


def _grown(room: BoolArray, start: tuple[int, int], target: int, cost: FloatArray) -> BoolArray:
    """The pixels that are reached first from a start on ways inside the room, each at a cost."""
    reached, _ = MCP_Geometric(np.where(room, cost, -1.0)).find_costs([start])
    count = min(target, int(np.isfinite(reached).sum()))
    return np.asarray(reached <= np.partition(reached.ravel(), count - 1)[count - 1])


def _place(random: np.random.Generator, allowed: BoolArray) -> tuple[int, int]:
    row, column = random.choice(np.argwhere(allowed))
    return int(row), int(column)


def _piece(mask: BoolArray, start: tuple[int, int]) -> BoolArray:
    labels, _ = ndimage.label(mask, EIGHT)
    return np.asarray(labels == labels[start])


def _filled(nucleus: BoolArray) -> BoolArray:
    """Without holes; what they held keeps its neighbours in the cell, because that has no holes."""
    return np.asarray(ndimage.binary_fill_holes(nucleus))


def _seed(random: np.random.Generator) -> int:
    return int(random.integers(2**31))


_CELLS: dict[str, Callable[[np.random.Generator], BoolArray]] = {
    "smooth": _smooth,
    "spiky": _spiky,
    "branched": _branched,
}
_NUCLEI: dict[str, Callable[[np.random.Generator, BoolArray, int], BoolArray]] = {
    "oval": _oval,
    "bean": _bean,
    "ball": _ball,
    "rough": _rough,
    "in an arm": _in_an_arm,
    "largest": _largest,
}
