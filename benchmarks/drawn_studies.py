"""Studies of several experiments, drawn from a store of cells that were analysed once."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

MOST_CELLS = 5  # of an experiment; their number is drawn


def drawn_cells(
    rng: np.random.Generator, condition: str, experiments: int, stored: int
) -> Iterator[tuple[int, dict[str, object]]]:
    """Numbers of stored cells, each once, and where they are in a study.

    Parameters
    ----------
    rng : Generator
    condition : str
    experiments : int
        Each of 1 to `MOST_CELLS` cells.
    stored : int
        How many there are to draw from.

    Yields
    ------
    (int, dict)
        The dict has input, cell, condition and experiment.
    """
    sizes = rng.integers(1, MOST_CELLS + 1, experiments)
    chosen = iter(rng.choice(stored, int(sizes.sum()), replace=False).tolist())
    for experiment, size in enumerate(sizes.tolist()):
        for cell in range(size):
            name = f"{condition} {experiment}"
            place = {"input": name, "cell": cell, "condition": condition, "experiment": name}
            yield next(chosen), place


def drawn_study(
    rng: np.random.Generator, conditions: dict[str, tuple[int, list[pd.DataFrame]]]
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Tables of a study: rows of all cells, and where each cell is.

    Parameters
    ----------
    rng : Generator
    conditions : dict of str to (int, list of DataFrame)
        By condition the number of experiments, and the store that its cells are drawn from.
    """
    rows, cells = [], []
    for name, (experiments, store) in conditions.items():
        for number, place in drawn_cells(rng, name, experiments, len(store)):
            rows.append(store[number].assign(**{key: place[key] for key in ("input", "cell")}))
            cells.append(place)
    return pd.concat(rows, ignore_index=True), pd.DataFrame(cells)


def attained(experiments: int, level: float = 0.05) -> float:
    """Largest level up to `level` that turned signs of so many experiments can attain, to both sides."""
    ways = 2**experiments
    return np.floor(level * ways / 2.0) * 2.0 / ways


def is_level(found: int, studies: int, level: float) -> bool:
    """Whether a share of studies is no more than three standard errors above a level."""
    return bool(found / studies <= level + 3.0 * np.sqrt(max(level, 0.01) * (1.0 - level) / studies))
