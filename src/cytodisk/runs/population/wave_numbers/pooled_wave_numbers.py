"""Pool numbers of waves over experiments, test their order against 0, and compare conditions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from cytodisk.runs.population.movies.wave_summaries import WAVE_UNITS, numbers_of
from cytodisk.runs.population.pooling.number_population import KEYS, number_population
from cytodisk.runs.population.pooling.pool_parameters import PoolParameters
from cytodisk.runs.population.pooling.pooled_population import TABLES, Pool, Pooled
from cytodisk.runs.population.wave_numbers.wave_pool_words import difference_sentences, wave_sentences

ORDER = "wave_order"
"""The number that all layers have; the others are of the chosen layer."""

_PLACE = ("channel", "layer")


def wave_numbers(cells: pd.DataFrame, layers: pd.DataFrame) -> pd.DataFrame:
    """Numbers of the waves of a study's cells.

    Parameters
    ----------
    cells, layers : DataFrame
        Tables of waves.

    Returns
    -------
    DataFrame
        cell, channel (one of `WAVE_UNITS`), layer and value. Of velocity the layer is 0, the edge.
    """
    done = cells[cells["status"] == "ok"]
    chosen = numbers_of(done).assign(cell=done["cell"], layer=done["layer"].fillna(0).astype(int))
    of_layers = pd.DataFrame(
        {
            "cell": layers["cell"],
            "layer": layers["layer"].fillna(0).astype(int),
            ORDER: layers["order"].to_numpy(np.float64),
        }
    )
    keys = ["cell", "layer"]
    both = of_layers.merge(chosen.drop(columns=ORDER), on=keys, how="left")
    long = both.melt(keys, list(WAVE_UNITS), var_name="channel", value_name="value")
    return long.dropna(subset="value").reset_index(drop=True)


def pool_waves(numbers: pd.DataFrame, cells: pd.DataFrame, options: PoolParameters) -> Pooled:
    """Mean of each number, layer and condition over experiments, and what chance would give.

    Parameters
    ----------
    numbers : DataFrame
        input and the columns of `wave_numbers`.
    cells : DataFrame
        input, cell, condition, experiment, and kind and p of the wave of the chosen layer.
    options : PoolParameters

    Returns
    -------
    Pooled
        An experiment counts once, whatever the number of its cells. Against 0 the order is tested, of all
        layers together; between conditions all numbers are, together.

    Raises
    ------
    PopulationError
        A condition to compare is not there.
    """
    population = number_population(numbers, cells[[*KEYS, "condition", "experiment"]], [*WAVE_UNITS], "value")
    if population is None:
        return Pooled(tables={name: pd.DataFrame() for name in TABLES})
    found = Pool(population, options.compare, options, _PLACE, "mean", zero=[ORDER]).pooled()
    for name, table in found.tables.items():
        found.tables[name] = _tidy(table)
    found.warnings = [_of_numbers(one) for one in found.warnings]
    said = wave_sentences(found.tables["pooled"], cells)
    said += difference_sentences(found.tables["comparisons"])
    found.sentences = [*said, *found.sentences]
    return found


def _of_numbers(warning: dict[str, Any]) -> dict[str, Any]:
    """A warning of windows in words for numbers of waves."""
    if warning["name"] != "windows not tested":
        return warning
    return warning | {
        "name": "numbers not tested",
        "finding": warning["finding"].replace(" windows ", " numbers of waves "),
        "consequence": "Whether they differ is not known.",
        "remedy": "Only cells with waves have a speed, direction, period and persistence: compare the order, "
        "or film more cells.",
    }


def _tidy(table: pd.DataFrame) -> pd.DataFrame:
    """The table with the names of numbers and their units, without rows of layers that they are not of."""
    if table.empty:
        return table
    value = "difference" if "difference" in table else "mean"
    named = table.rename(columns={"channel": "number"}).dropna(subset=value).reset_index(drop=True)
    named["unit"] = named["number"].map(WAVE_UNITS)
    untested = (named["number"] != ORDER) if "control" not in named else pd.Series(False, index=named.index)
    if "smallest_p" in named:
        named.loc[untested, "smallest_p"] = np.nan
    return named
