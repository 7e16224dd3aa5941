"""Random masks of every kind that has broken a map somewhere: for tests and benchmarks."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from scipy import ndimage
from skimage.draw import line

from cytodisk.arrays import BoolArray
from cytodisk.errors import ParameterError
from cytodisk.simulate.random_cells import branching, random_smooth, random_spiky


def random_mask(kind: str, seed: int) -> BoolArray:
    """One random mask, from 1 to some thousands of pixels.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    seed : int
        The same kind and seed give the same mask.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool
        At least one pixel; it may be in several pieces, have holes and touch the image border.

    Raises
    ------
    ParameterError
        An unknown kind.

    See Also
    --------
    random_smooth : A mask in one piece without holes.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.random_mask(cd.simulate.KINDS[0], seed=0)
    >>> mask.ndim, mask.dtype.name
    (2, 'bool')
    """
    if kind not in _MAKERS:
        raise ParameterError(f"kind must be one of {', '.join(KINDS)}, got {kind!r}")
    return _MAKERS[kind](np.random.default_rng([KINDS.index(kind), seed]))


def _smooth(random: np.random.Generator) -> BoolArray:
    return random_smooth(
        _seed(random),
        radius=random.uniform(1.0, 40.0),
        roughness=random.uniform(0.0, 0.6),
        margin=_margin(random),
    )


def _spiky(random: np.random.Generator) -> BoolArray:
    return random_spiky(
        _seed(random),
        radius=random.uniform(1.0, 20.0),
        spikes=int(random.integers(1, 25)),
        spike_length=random.uniform(1.0, 40.0),
        spike_width=random.uniform(1.0, 6.0),
        margin=_margin(random),
    )


def _branching(random: np.random.Generator) -> BoolArray:
    return branching(
        _seed(random),
        soma_radius=random.uniform(1.0, 12.0),
        processes=int(random.integers(1, 6)),
        process_length=random.uniform(5.0, 50.0),
        process_width=random.uniform(1.0, 5.0),
        branch_every=random.uniform(10.0, 60.0),
        margin=_margin(random),
    )


def _percolation(random: np.random.Generator) -> BoolArray:
    """The largest cluster of sites occupied at random, near the threshold where clusters are raggedest."""
    size = int(random.integers(5, 65))
    sites = random.random((size, size)) < random.uniform(0.35, 0.65)
    sites[size // 2, size // 2] = True
    structure = ndimage.generate_binary_structure(2, int(random.integers(1, 3)))
    labels, _ = ndimage.label(sites, structure)
    return np.asarray(labels == 1 + np.bincount(labels.ravel())[1:].argmax())


def _line(random: np.random.Generator) -> BoolArray:
    """A polyline one pixel wide, in any direction."""
    corners = random.integers(0, int(random.integers(3, 80)), size=(int(random.integers(2, 5)), 2))
    mask = np.zeros(corners.max(axis=0) + 2, dtype=bool)
    for start, stop in pairwise(corners):
        row, column = line(*start, *stop)  # type: ignore[no-untyped-call]
        mask[row, column] = True
    return mask


def _diagonal(random: np.random.Generator) -> BoolArray:
    """Pixels that touch at corners only, in a zigzag."""
    run = int(random.integers(1, 60))
    period = int(random.integers(1, run + 1))
    row = np.arange(run)
    column = np.abs((row + period) % (2 * period) - period)
    mask = np.zeros((run + 2, period + 3), dtype=bool)
    mask[row + 1, column + 1] = True
    return mask if random.random() < 0.5 else mask[:, ::-1].copy()


def _spiral_thin(random: np.random.Generator) -> BoolArray:
    return _spiral(random, width=0, pitch=random.uniform(3.0, 7.0))


def _spiral_thick(random: np.random.Generator) -> BoolArray:
    width = int(random.integers(1, 4))
    return _spiral(random, width=width, pitch=2.0 * width + random.uniform(3.5, 8.0))


def _spiral(random: np.random.Generator, width: int, pitch: float) -> BoolArray:
    turns = random.uniform(0.5, 4.0)
    angle = np.linspace(0.0, 2.0 * np.pi * turns, int(200 * turns * (turns + 1)))
    radius = pitch * (angle / (2.0 * np.pi) + 0.5)
    reach = int(np.ceil(radius.max())) + width + 1
    mask = np.zeros((2 * reach + 1, 2 * reach + 1), dtype=bool)
    start = random.uniform(0.0, 2.0 * np.pi)
    row, column = radius * np.sin(angle + start), radius * np.cos(angle + start)
    mask[np.rint(row).astype(int) + reach, np.rint(column).astype(int) + reach] = True
    return np.asarray(ndimage.distance_transform_edt(~mask) <= width)


def _comb(random: np.random.Generator) -> BoolArray:
    teeth, length = int(random.integers(1, 15)), int(random.integers(1, 50))
    tooth, gap, back = int(random.integers(1, 5)), int(random.integers(1, 5)), int(random.integers(1, 8))
    mask = np.zeros((back + length, teeth * (tooth + gap)), dtype=bool)
    mask[:back] = True
    for k in range(teeth):
        start = k * (tooth + gap)
        mask[: back + int(random.integers(1, length + 1)), start : start + tooth] = True
    return np.rot90(np.pad(mask, _margin(random)), int(random.integers(4))).copy()


def _single(random: np.random.Generator) -> BoolArray:
    return _block(random, 1, 1)


def _square(random: np.random.Generator) -> BoolArray:
    return _block(random, 2, 2)


def _few(random: np.random.Generator) -> BoolArray:
    """Up to 3 × 3 pixels, any of them."""
    mask = random.random(random.integers(1, 4, size=2)) < 0.6
    mask[0, 0] = True
    return np.pad(mask, _margin(random))


def _block(random: np.random.Generator, height: int, width: int) -> BoolArray:
    mask = np.zeros((int(random.integers(height, 8)), int(random.integers(width, 8))), dtype=bool)
    row = int(random.integers(0, mask.shape[0] - height + 1))
    column = int(random.integers(0, mask.shape[1] - width + 1))
    mask[row : row + height, column : column + width] = True
    return mask


def _border(random: np.random.Generator) -> BoolArray:
    """A smooth or spiky cell cut by the image border on one side or all."""
    mask = _smooth(random) if random.random() < 0.5 else _spiky(random)
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    centre = int(rows[len(rows) // 2]), int(columns[len(columns) // 2])
    height, width = random.integers(1, np.array(mask.shape) + 1)
    top, left = max(centre[0] - int(height) // 2, 0), max(centre[1] - int(width) // 2, 0)
    cut = mask[top : top + int(height), left : left + int(width)].copy()
    cut[centre[0] - top, centre[1] - left] = True
    return cut


def _full(random: np.random.Generator) -> BoolArray:
    """The whole image, or all but a few pixels of it."""
    mask = np.ones(random.integers(1, 60, size=2), dtype=bool)
    if random.random() < 0.5:
        mask &= random.random(mask.shape) > 0.05
        mask[0, 0] = True
    return mask


def _seed(random: np.random.Generator) -> int:
    return int(random.integers(2**31))


def _margin(random: np.random.Generator) -> int:
    return int(random.integers(0, 3))


_MAKERS: dict[str, Callable[[np.random.Generator], BoolArray]] = {
    "smooth": _smooth,
    "spiky": _spiky,
    "branching": _branching,
    "percolation": _percolation,
    "line": _line,
    "diagonal": _diagonal,
    "spiral_thin": _spiral_thin,
    "spiral_thick": _spiral_thick,
    "comb": _comb,
    "single": _single,
    "square": _square,
    "few": _few,
    "border": _border,
    "full": _full,
}

KINDS = tuple(_MAKERS)
