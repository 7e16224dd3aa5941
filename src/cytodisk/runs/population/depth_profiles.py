"""The profile by depth: the mean of each layer, by condition and experiment."""

from __future__ import annotations

import numpy as np
import pandas as pd

from cytodisk.population.cell_scalars import LAYER
from cytodisk.population.group_columns import CONDITION, EXPERIMENT
from cytodisk.population.population import Population


def depth_profiles(population: Population, scalars: pd.DataFrame) -> pd.DataFrame:
    """Mean and spread of each layer over the cells of an experiment.

    Parameters
    ----------
    population : Population
        All its cells have a condition; without experiments, all cells of a condition are one.
    scalars : DataFrame
        See `Population.scalar_table`.

    Returns
    -------
    DataFrame
        As the table profiles.
    """
    cells = population.cells
    groups = [cells[CONDITION].to_numpy(object), cells[EXPERIMENT].astype(object).fillna("").to_numpy(object)]
    depths = depth_of_layers(population)
    parts = []
    for channel in population.channels:
        for layer, compartment in enumerate(population.compartments):
            values = scalars[LAYER.format(layer, channel)]
            found = values.groupby(groups, sort=False).agg(["mean", "std", "count"]).reset_index()
            found.columns = [CONDITION, EXPERIMENT, "mean", "sd", "n_cells"]
            place = {"channel": channel, "compartment": compartment, "layer": layer, "depth": depths[layer]}
            parts.append(found.assign(**place))
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def depth_of_layers(population: Population) -> np.ndarray:
    """Distance of each layer to the cell's edge, NaN where it is not known."""
    layers = population.raw.sizes["layer"]
    if "depth" not in population.raw.coords:
        return np.full(layers, np.nan)
    return np.asarray(population.raw.coords["depth"].values, dtype=np.float64)
