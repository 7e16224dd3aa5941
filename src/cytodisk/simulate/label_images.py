"""Label images: many cells of every shape in one picture, as a segmentation program returns them."""

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from cytodisk.arrays import BoolArray
from cytodisk.checks import number_between
from cytodisk.simulate.random_cells import branching, migrating, random_smooth, random_spiky

_GAP_PX = 1  # background between the boxes of neighbours
_CUT_PX = 4  # of the picture's sides, so that cells there are cut off


def label_image(cells: int = 50, seed: int = 0) -> np.ndarray[Any, np.dtype[np.uint16]]:
    """A picture full of cells: round, spindly, spiky, with tails and with processes.

    Parameters
    ----------
    cells : int
        At least 1 and at most 65 535. Those at the left and the upper side are cut off by the border.
    seed : int
        The same seed gives the same picture.

    Returns
    -------
    ndarray of shape (H, W) and dtype uint16
        Cells are 1, 2, …, of about 200 to 4000 pixels; 0 is background.

    Raises
    ------
    ParameterError
        `cells` is below 1.

    See Also
    --------
    label_image_with_nuclei : Cells with their nuclei.
    movie : One cell through time.

    Examples
    --------
    >>> import cytodisk as cd
    >>> labels = cd.simulate.label_image(cells=5, seed=0)
    >>> int(labels.max())
    5
    """
    number_between("cells", cells, 1)
    masks = cell_masks(cells, np.random.default_rng([7, seed]))
    corners, shape = packed(masks)
    image = np.zeros(shape, dtype=np.uint16)
    for label, (mask, (y, x)) in enumerate(zip(masks, corners, strict=True), start=1):
        image[y : y + mask.shape[0], x : x + mask.shape[1]][mask] = label
    return image[_CUT_PX:, _CUT_PX:]


def cell_masks(cells: int, random: np.random.Generator) -> list[BoolArray]:
    """Masks of cells of all kinds, without a margin."""
    makers = [_MAKERS[kind] for kind in random.choice(len(_MAKERS), cells, p=_SHARES)]
    return [make(random) for make in makers]


def packed(masks: list[BoolArray]) -> tuple[list[tuple[int, int]], tuple[int, int]]:
    """Corners of boxes that stand in rows, in a picture about as high as wide."""
    total = sum((mask.shape[0] + _GAP_PX) * (mask.shape[1] + _GAP_PX) for mask in masks)
    width = max(int(1.1 * total**0.5), *(mask.shape[1] for mask in masks), 1)
    corners, y, x, row = [], 0, 0, 0
    for mask in masks:
        if x and x + mask.shape[1] > width:
            y, x, row = y + row + _GAP_PX, 0, 0
        corners.append((y, x))
        x, row = x + mask.shape[1] + _GAP_PX, max(row, mask.shape[0])
    return corners, (y + row, width)


def _smooth(random: np.random.Generator) -> BoolArray:
    radius, roughness = random.uniform(9.0, 28.0), random.uniform(0.05, 0.35)
    return random_smooth(_seed(random), radius=radius, roughness=roughness, margin=0)


def _spiky(random: np.random.Generator) -> BoolArray:
    return random_spiky(
        _seed(random),
        radius=random.uniform(9.0, 20.0),
        spikes=int(random.integers(3, 12)),
        spike_length=random.uniform(6.0, 22.0),
        spike_width=random.uniform(2.0, 4.0),
        margin=0,
    )


def _crawling(random: np.random.Generator) -> BoolArray:
    cell = migrating(_seed(random), size=random.uniform(0.2, 0.4), margin=0)
    return np.rot90(cell, int(random.integers(4)))


def _with_processes(random: np.random.Generator) -> BoolArray:
    return branching(
        _seed(random),
        soma_radius=random.uniform(8.0, 12.0),
        processes=int(random.integers(2, 5)),
        process_length=random.uniform(12.0, 32.0),
        process_width=random.uniform(3.0, 5.0),
        branch_every=30.0,
        margin=0,
    )


def _seed(random: np.random.Generator) -> int:
    return int(random.integers(2**31))


_Maker: TypeAlias = Callable[[np.random.Generator], BoolArray]
_MAKERS: tuple[_Maker, ...] = (_smooth, _spiky, _crawling, _with_processes)
_SHARES = (0.55, 0.2, 0.15, 0.1)
