"""`dose_trend`: does the signal rise or fall with an ordered dose?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from scipy.stats import rankdata, t

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.checks import instance_of
from cytodisk.errors import PopulationError
from cytodisk.population.comparison_parameters import DoseParameters
from cytodisk.population.conditions.comparison_sentences import trend_words
from cytodisk.population.conditions.condition_comparison import chosen_channels
from cytodisk.population.conditions.tested_units import unit_results
from cytodisk.population.conditions.unit_values import usable_cells
from cytodisk.population.exchange.dose_exchanges import DoseExchanges, DoseSlope, without_levels
from cytodisk.population.exchange.effect_intervals import CONFIDENCE
from cytodisk.population.exchange.exchanges import Exchanges
from cytodisk.population.exchange.studentised import Statistic
from cytodisk.population.group_columns import EXPERIMENT, codes_of, names_in
from cytodisk.population.population import Population
from cytodisk.population.significance import LEVEL
from cytodisk.taking import takes


@dataclass(frozen=True, eq=False)
class DoseTrend:
    """Where the signal rises or falls with the dose.

    Attributes
    ----------
    doses : ndarray of float64
        Those that were tested, sorted.
    windows : Dataset with dims ([channel,] layer, sector)
        `difference`: change by one step of the dose (see `scale`), with its 95 % interval `difference_low`,
        `difference_high`; `correlation` of units with the dose; `p`, `p_fwer`, `q`, `n_units`, `cluster`,
        `status`, as in `ConditionComparison`.
    clusters, scalars : DataFrame
    smallest_p : float
    design : str
        "within experiments" or "between experiments".
    sentences : tuple of str
    """

    doses: FloatArray
    windows: xr.Dataset
    clusters: pd.DataFrame
    scalars: pd.DataFrame
    smallest_p: float
    design: str
    sentences: tuple[str, ...]


@takes(DoseParameters)
def dose_trend(
    pop: Population,
    dose: str = "dose",
    *,
    channel: str | Sequence[str] | None = None,
    parameters: DoseParameters | None = None,
    **settings: Any,
) -> DoseTrend:
    """Test a trend over a dose that the cells' table has as a number.

    Doses are exchanged between whole experiments, or within experiments where each holds several.

    Parameters
    ----------
    pop : Population
    dose : str
        Column of cells with the dose.
    channel : str or sequence of str, optional
        By default all.
    parameters : DoseParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `DoseParameters`.

    Returns
    -------
    DoseTrend

    Raises
    ------
    PopulationError
        There is no such column, it holds fewer than two doses, or experiments are unknown.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> truth = cd.simulate.population(experiments=4, effect=3.0, seed=0)
    >>> cells = truth.cells.assign(dose=np.where(truth.cells["condition"] == "drug", 2.0, 0.0))
    >>> cd.dose_trend(cd.Population(truth.values, cells)).smallest_p.__round__(3)
    0.029
    """
    instance_of("pop", pop, Population, "a Population")
    chosen = DoseParameters.chosen(parameters, settings)
    channels = chosen_channels(pop, channel)
    usable = usable_cells(pop, channels)
    codes, experiment, doses = _units(pop, usable, dose)
    scaled = _scaled(doses, chosen.scale)
    counts = np.bincount(experiment)
    within = bool((counts[counts > 0] > 1).all())
    if not within and (counts > 1).any():
        raise PopulationError(
            "dose_trend: some experiments hold several doses and others one: give all experiments several "
            "doses, or different names to what are different experiments"
        )
    blocks = experiment if within else np.zeros(len(doses), dtype=np.int64)
    test = _Trend(scaled, blocks, chosen)
    found = unit_results(pop, channels, codes, len(doses), test)
    design = "within experiments" if within else "between experiments"
    p = test.exchanges.smallest_p
    step = {"rank": "step of the dose", "linear": "unit of dose", "log": "factor of 10"}[chosen.scale]
    reach = "" if p <= LEVEL else f": no trend can reach {LEVEL:g}"
    without = int((usable & (codes < 0)).sum())
    left_out = f"{without} of {int(usable.sum())} cells have no dose or no experiment: they are in no trend."
    words = (
        f"{len(doses)} units at {len(np.unique(doses))} doses, exchanged {design}, can give p = {p:.2g} at "
        f"best{reach}.",
        *trend_words(found.windows, found.clusters, found.scalars, step),
        *([left_out] if without else []),
    )
    windows = found.windows.squeeze("channel") if len(channels) == 1 else found.windows
    return DoseTrend(np.unique(doses), windows, found.clusters, found.scalars, p, design, words)


@dataclass(frozen=True, eq=False)
class _Trend:
    """A trend over doses, as a `UnitTest`."""

    doses: FloatArray
    blocks: IntArray
    chosen: DoseParameters

    @property
    def exchanges(self) -> Exchanges:
        return DoseExchanges(self.doses, self.blocks, self.chosen.permutations, self.chosen.seed)

    def statistic(self, values: FloatArray, families: IntArray | None) -> Statistic:
        return DoseSlope(values, self.doses, self.blocks, families)

    def effects(self, values: FloatArray) -> Mapping[str, FloatArray]:
        """Slopes by least squares, where all units have a value."""
        complete = np.isfinite(values).all(axis=0)
        doses = without_levels(self.doses[:, None], self.blocks)[:, 0]
        away = without_levels(np.where(complete, values, np.nan), self.blocks)
        spread, squares = float((doses**2).sum()), (away**2).sum(axis=0)
        slope = doses @ away / spread
        degrees = len(doses) - len(np.unique(self.blocks)) - 1
        if degrees < 1:
            half = np.full(slope.shape, np.nan)
        else:
            error = np.sqrt(np.maximum(squares - slope**2 * spread, 0.0) / degrees / spread)
            half = t.ppf(0.5 + CONFIDENCE / 2, degrees) * error
        with np.errstate(invalid="ignore", divide="ignore"):
            correlation = slope * np.sqrt(spread / squares)
        return {
            "difference": slope,
            "difference_low": slope - half,
            "difference_high": slope + half,
            "correlation": np.where(squares > 0, correlation, np.nan),
            "n_units": np.isfinite(values).sum(axis=0),
        }


def _units(pop: Population, usable: BoolArray, dose: str) -> tuple[IntArray, IntArray, FloatArray]:
    """Unit of each cell, and experiment and dose of each unit."""
    if dose not in pop.cells:
        raise PopulationError(
            f"dose_trend: cells has no column {dose!r}: add the dose of each cell as a number"
        )
    given = _numbers(pop.cells[dose], dose)
    experiment, names = codes_of(names_in(pop.cells, EXPERIMENT))
    if not names:
        raise PopulationError(
            "dose_trend: experiments are unknown: add a column experiment with the name of each independent "
            "repetition (day, dish, animal), as with --groups"
        )
    use = usable & np.isfinite(given) & (experiment >= 0)
    levels, level = np.unique(given[use], return_inverse=True)
    if len(levels) < 2:
        raise PopulationError(
            f"dose_trend: column {dose!r} holds {len(levels)} dose of cells with values: 2 are needed"
        )
    present, code = np.unique(experiment[use] * len(levels) + level, return_inverse=True)
    codes = np.full(len(pop), -1, dtype=np.int64)
    codes[use] = code
    return codes, present // len(levels), levels[present % len(levels)]


def _numbers(column: pd.Series[Any], name: str) -> FloatArray:
    """Doses as numbers, NaN where the column is empty.

    Raises
    ------
    PopulationError
        A dose is no number.
    """
    given = column.notna() & (column.astype(str).str.strip() != "")
    numbers = pd.to_numeric(column.where(given).astype(object), errors="coerce").to_numpy(np.float64)
    wrong = np.flatnonzero(given & ~np.isfinite(numbers))
    if len(wrong):
        raise PopulationError(
            f"dose_trend: column {name!r} holds {str(column.iloc[wrong[0]])!r} ({len(wrong)} of "
            f"{len(column)} cells have no finite number): write all doses as numbers of one unit"
        )
    return np.asarray(numbers)


def _scaled(doses: FloatArray, scale: str) -> FloatArray:
    if scale == "linear":
        return doses
    if scale == "rank":
        return np.asarray(rankdata(doses, method="dense"), dtype=np.float64)
    if (doses <= 0).any():
        raise PopulationError(
            f"dose_trend: a dose of {doses.min():g} has no logarithm: use scale='rank', as --dose-scale rank"
        )
    return np.log10(doses)
