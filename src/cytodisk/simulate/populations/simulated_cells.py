"""The table of simulated cells: condition, experiment, name, and what the design asks for besides."""

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.simulate.populations.simulated_population_parameters import (
    DesignParameters,
    SimulatedPopulationParameters,
)

DIRECTIONS = ("nucleus", "front")
_WEAKEST = 0.3  # strength of a direction that is known
_AREA, _AREA_SPREAD = 2000.0, 0.25  # px², and the standard deviation of its logarithm


def cell_rows(design: DesignParameters, random: np.random.Generator) -> tuple[IntArray, IntArray]:
    """Number of the condition and of the experiment of each cell, by condition, then by experiment."""
    each = design.experiments_of
    first = np.zeros(len(each), dtype=np.int64) if design.paired else np.cumsum((0, *each[:-1]))
    conditions = np.repeat(np.arange(len(each)), each)
    experiments = np.concatenate([start + np.arange(count) for start, count in zip(first, each, strict=True)])
    low = max(round((1.0 - design.cells_spread) * design.cells), 1)
    high = max(round((1.0 + design.cells_spread) * design.cells), low)
    cells = random.integers(low, high + 1, len(conditions))
    return np.repeat(conditions, cells), np.repeat(experiments, cells)


def cell_table(
    how: SimulatedPopulationParameters,
    rows: tuple[IntArray, IntArray],
    shifts: IntArray,
    random: np.random.Generator,
) -> pd.DataFrame:
    """The table of the cells, in the order of the rows.

    Parameters
    ----------
    how : SimulatedPopulationParameters
    rows : (ndarray, ndarray) of shape (cells,) and dtype int
        Number of the condition and of the experiment.
    shifts : ndarray of shape (cells,) and dtype int
        Sectors by which each cell is turned.
    random : numpy.random.Generator
    """
    condition, experiment = rows
    names = np.array([f"experiment {number + 1}" for number in range(int(experiment.max()) + 1)])
    columns = {
        "cell": np.arange(1, len(condition) + 1),
        "condition": np.array(how.conditions)[condition],
        "experiment": names[experiment],
    }
    if how.days != "none":
        own = condition if how.days == "by condition" else _number_in_condition(condition, experiment)
        columns["day"] = np.array([f"day {number + 1}" for number in range(int(own.max()) + 1)])[own]
    if how.doses:
        columns["dose"] = np.array(how.doses)[condition]
    columns["area"] = _areas(how, rows, random)
    for name in DIRECTIONS:
        columns |= _direction(how, name, shifts, random)
    return pd.DataFrame(columns)


def _number_in_condition(condition: IntArray, experiment: IntArray) -> IntArray:
    """Number of each cell's experiment among those of its condition."""
    first = np.array([experiment[condition == one].min() for one in range(int(condition.max()) + 1)])
    return np.asarray(experiment - first[condition])


def _areas(
    how: SimulatedPopulationParameters, rows: tuple[IntArray, IntArray], random: np.random.Generator
) -> FloatArray:
    """Areas in px², with the shares of variance of the design; no condition has an effect on them."""
    condition, experiment = rows
    shares = how.between_experiments, how.between_dishes
    of_experiment = random.normal(size=int(experiment.max()) + 1)[experiment]
    of_dish = random.normal(size=(len(how.conditions), int(experiment.max()) + 1))[condition, experiment]
    of_cell = random.normal(size=len(condition))
    own = np.sqrt(max(1.0 - sum(shares), 0.0))
    spread = np.sqrt(shares[0]) * of_experiment + np.sqrt(shares[1]) * of_dish + own * of_cell
    return np.asarray(_AREA * np.exp(_AREA_SPREAD * spread))


def _direction(
    how: SimulatedPopulationParameters, name: str, shifts: IntArray, random: np.random.Generator
) -> dict[str, FloatArray]:
    """Direction of each cell in the disk and its strength; NaN and 0 for a cell without one."""
    count = len(shifts)
    true = random.uniform(0.0, 360.0, count) if name != how.turned else shifts * (360.0 / how.sectors)
    known = np.mod(true + how.direction_error_deg * random.normal(size=count), 360.0)
    strength = random.uniform(_WEAKEST, 1.0, count)
    without = random.random(count) < how.without_direction
    return {
        f"disk_direction_{name}": np.where(without, np.nan, known),
        f"direction_strength_{name}": np.where(without, 0.0, strength),
    }
