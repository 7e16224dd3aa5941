"""Cells of several experiments and conditions as windows, with known variances and a known effect."""

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.checks import whole_number
from cytodisk.errors import ParameterError
from cytodisk.simulate.null_series import depth_weights, ring_weights
from cytodisk.simulate.populations.simulated_cells import cell_rows, cell_table
from cytodisk.simulate.populations.simulated_population_parameters import SimulatedPopulationParameters
from cytodisk.taking import takes

_BLOCK = 4096  # cells that are made at once, so that memory stays near that of the values
_Floats: TypeAlias = np.ndarray[Any, np.dtype[np.floating[Any]]]


@dataclass(frozen=True, eq=False)
class SimulatedPopulation:
    """Windows of many cells, and what is known of them.

    Attributes
    ----------
    values : DataArray with dims (cell, [channel,] layer, sector)
        NaN where a window has no value.
    cells : DataFrame
        Row i belongs to ``values[i]``. Columns: `cell`, `condition`, `experiment`, `area`, for the directions
        "nucleus" and "front" `disk_direction_NAME`, in degrees from +u towards +v, and
        `direction_strength_NAME`; with days `day`, with doses `dose`.
    region : DataArray of bool with dims (layer, sector)
        Windows in which conditions differ, in a cell that is not turned, in the first channel.
    expected : DataArray with dims (condition, [channel,] layer, sector)
        Mean of the values by condition, in a cell that is not turned.
    shifts : ndarray of shape (cells,) and dtype int
        Sectors by which each cell is turned: what is in sector 0 of the region is in that sector of the cell.
    seed : int

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.population(experiments=4, cells=5, layers=3, sectors=12)
    >>> dict(truth.values.sizes)
    {'cell': 40, 'layer': 3, 'sector': 12}
    >>> truth.cells["condition"].value_counts().to_dict()
    {'control': 20, 'drug': 20}
    """

    values: xr.DataArray
    cells: pd.DataFrame
    region: xr.DataArray
    expected: xr.DataArray
    shifts: IntArray
    seed: int


@takes(SimulatedPopulationParameters)
def population(seed: int = 0, *, region: BoolArray | None = None, **settings: Any) -> SimulatedPopulation:
    """Cells of several experiments and conditions, with known variances and a known effect in a region.

    A value is a mean, plus the effect of the condition where the region is, plus Gaussian deviations of the
    experiment, of its dish (experiment and condition) and of the cell. All three are fields over the windows,
    each with its share of the variance, and with the same correlation between neighbouring windows.

    Parameters
    ----------
    seed : int
        The same arguments give the same population.
    region : array_like of shape (layers, sectors) and dtype bool, optional
        Windows in which conditions differ; without it the outer half of the layers, in a third of the
        sectors from a sixth on.
    **settings
        See `SimulatedPopulationParameters`.

    Returns
    -------
    SimulatedPopulation

    Raises
    ------
    ParameterError
        A number is out of its range, or numbers do not fit each other.

    See Also
    --------
    population_images : Label images and signals of a population, as files.
    independent_series : Series of one movie.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.population(1, experiments=200, cells=4, layers=2, sectors=6)
    >>> drug = (truth.cells["condition"] == "drug").to_numpy()
    >>> difference = truth.values[drug].mean("cell") - truth.values[~drug].mean("cell")
    >>> difference.round(0).astype(int).to_numpy()  # 2 standard deviations of a cell
    array([[0, 2, 2, 0, 0, 0],
           [0, 0, 0, 0, 0, 0]])
    """
    how = SimulatedPopulationParameters.of(**settings)
    seed = whole_number("seed", seed, 0)
    where = _default_region(how) if region is None else _checked_region(region, how)
    random = np.random.default_rng([23, seed])
    rows = cell_rows(how, random)
    shifts = random.integers(how.sectors, size=len(rows[0]))
    shifts = shifts if how.turned != "none" else np.zeros_like(shifts)
    cells = cell_table(how, rows, shifts, random)
    expected = _expected(how, where)
    values = _values(how, rows, shifts, expected, random)
    return SimulatedPopulation(
        values=_labelled(values, "cell", cells["cell"].to_numpy(), how),
        cells=cells,
        region=_region_array(where, how),
        expected=_labelled(expected, "condition", np.array(how.conditions), how),
        shifts=shifts,
        seed=seed,
    )


def _default_region(how: SimulatedPopulationParameters) -> BoolArray:
    region = np.zeros((how.layers, how.sectors), dtype=bool)
    first, last = how.sectors // 6, max(how.sectors // 2, how.sectors // 6 + 1)
    region[: (how.layers + 1) // 2, first:last] = True
    return region


def _checked_region(region: Any, how: SimulatedPopulationParameters) -> BoolArray:
    given = np.asarray(region)
    if given.dtype != bool or given.shape != (how.layers, how.sectors):
        raise ParameterError(
            f"region must be bool of shape ({how.layers}, {how.sectors}), got {given.dtype} of shape "
            f"{given.shape}: pass True for each window in which conditions differ"
        )
    return given


def _expected(how: SimulatedPopulationParameters, region: BoolArray) -> FloatArray:
    """Means of shape (condition, channel, layer, sector)."""
    falling = np.exp(-np.arange(how.layers) * 3.0 / how.layers)
    around = np.cos(2.0 * np.pi * (np.arange(how.sectors) + 0.5) / how.sectors)
    plain = how.mean + how.deviation * (how.peripheral * falling[:, None] + how.polarity * around)
    means = np.tile(plain, (len(how.conditions), max(len(how.channels), 1), 1, 1))
    means[:, 0] += how.deviation * np.array(how.effect_of)[:, None, None] * region
    return np.asarray(means)


def _values(
    how: SimulatedPopulationParameters,
    rows: tuple[IntArray, IntArray],
    shifts: IntArray,
    expected: FloatArray,
    random: np.random.Generator,
) -> _Floats:
    """Values of shape (cell, channel, layer, sector), a block of cells at a time."""
    condition, experiment = rows
    own = max(1.0 - how.between_experiments - how.between_dishes, 0.0)
    n_experiments = int(experiment.max()) + 1
    of_experiment = _fields(how, how.between_experiments, n_experiments, random)
    of_dish = _fields(how, how.between_dishes, len(expected) * n_experiments, random)
    dish = condition * n_experiments + experiment
    values = np.empty((len(condition), *expected.shape[1:]), dtype=how.precision)
    for start in range(0, len(condition), _BLOCK):
        part = slice(start, start + _BLOCK)
        block = _fields(how, own, len(condition[part]), random)
        block += expected.astype(how.precision)[condition[part]]
        block += of_experiment[experiment[part]]
        block += of_dish[dish[part]]
        if how.missing:
            block[random.random(block.shape) < how.missing] = np.nan
        values[part] = block if how.turned == "none" else _turned(block, shifts[part])
    return values


def _fields(
    how: SimulatedPopulationParameters, share: float, count: int, random: np.random.Generator
) -> _Floats:
    """So many fields over the windows of all channels, of a share of the variance."""
    shape = count, max(len(how.channels), 1)
    kind: Any = np.dtype(how.precision)
    if not share:
        return np.zeros((*shape, how.layers, how.sectors), dtype=kind)
    if how.correlation_length:
        around = ring_weights(how.sectors, how.correlation_length).astype(kind)
        inwards = depth_weights(how.layers, how.correlation_length).astype(kind)
        noise = random.standard_normal((*shape, inwards.shape[1], how.sectors), dtype=kind)
        fields = inwards @ (noise @ around.T)
    else:
        fields = random.standard_normal((*shape, how.layers, how.sectors), dtype=kind)
    whole = random.standard_normal(shape, dtype=kind)[..., None, None] if how.common else kind.type(0.0)
    mixed = kind.type(np.sqrt(1.0 - how.common)) * fields + kind.type(np.sqrt(how.common)) * whole
    mixed *= kind.type(how.deviation * np.sqrt(share))
    return np.asarray(mixed)


def _turned(block: _Floats, shifts: IntArray) -> _Floats:
    """Each cell by its number of sectors."""
    source = np.mod(np.arange(block.shape[-1]) - shifts[:, None], block.shape[-1])
    return np.take_along_axis(block, source[:, None, None, :], axis=-1)


def _layer_coordinates(how: SimulatedPopulationParameters) -> dict[str, Any]:
    layers = np.arange(how.layers)
    found: dict[str, Any] = {"layer": layers, "sector": np.arange(how.sectors)}
    if how.nucleus_layers:
        in_nucleus = layers >= how.layers - how.nucleus_layers
        found["compartment"] = "layer", np.where(in_nucleus, "nucleus", "cytoplasm")
    return found


def _region_array(region: BoolArray, how: SimulatedPopulationParameters) -> xr.DataArray:
    return xr.DataArray(region, _layer_coordinates(how), ("layer", "sector"), name="region")


def _labelled(values: _Floats, first: str, names: Any, how: SimulatedPopulationParameters) -> xr.DataArray:
    coordinates = {first: names} | _layer_coordinates(how)
    if how.channels:
        coordinates |= {"channel": list(how.channels)}
        return xr.DataArray(values, coordinates, (first, "channel", "layer", "sector"), name="signal")
    return xr.DataArray(values[:, 0], coordinates, (first, "layer", "sector"), name="signal")
