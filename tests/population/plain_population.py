"""A population and the means of its experiments by plain loops, for tests against other packages."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

import cytodisk as cd
from cytodisk.arrays import FloatArray

LAYERS, SECTORS = 3, 8


@dataclass(frozen=True, eq=False)
class Compared:
    """What is compared: a population, and its means (experiments, layers, sectors) by condition."""

    population: cd.Population
    control: FloatArray
    drug: FloatArray

    @cached_property
    def found(self) -> cd.ConditionComparison:
        """The comparison under test."""
        return cd.compare_conditions(self.population, "control", "drug", seed=3)


def compared(
    experiments: int | tuple[int, int], paired: bool, seed: int = 1, effect: float = 0.8
) -> Compared:
    """Cells in unequal numbers, some of them without a value in some windows."""
    truth = cd.simulate.population(
        seed,
        experiments=experiments,
        paired=paired,
        cells=6,
        cells_spread=0.4,
        layers=LAYERS,
        sectors=SECTORS,
        effect=effect,
        missing=0.05,
    )
    means = []
    for condition in ("control", "drug"):
        cells = truth.cells[truth.cells["condition"] == condition]
        values = [
            np.nanmean(truth.values.to_numpy()[rows.index], axis=0)
            for _, rows in cells.groupby("experiment", sort=False)
        ]
        means.append(np.stack(values))
    return Compared(cd.Population(truth.values, truth.cells), *means)


def cell_scalars(population: cd.Population, name: str) -> tuple[FloatArray, FloatArray]:
    """Means over the cells of each experiment of a scalar, by condition."""
    table = population.cells.assign(scalar=population.scalar_table()[name].to_numpy())
    of_experiment = table.groupby(["condition", "experiment"], sort=False)["scalar"].mean()
    return of_experiment["control"].to_numpy(), of_experiment["drug"].to_numpy()
