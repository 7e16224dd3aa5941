"""`Population`: the windows of many cells, with what was done to each."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import IntArray
from cytodisk.checks import number_between
from cytodisk.errors import PopulationError
from cytodisk.population.anndata_table import population_anndata
from cytodisk.population.cell_directions import SIGNAL, chosen_direction, no_alignment
from cytodisk.population.cell_levels import cell_levels
from cytodisk.population.cell_scalars import scalars_of
from cytodisk.population.cell_values import CellValues
from cytodisk.population.group_columns import CONDITION
from cytodisk.population.population_atlas import atlas_of

if TYPE_CHECKING:
    from cytodisk.population.anndata_table import AnnData


class Population(CellValues):
    """The windows of many cells, and a table with what was done to each.

    Values are copied, normalised and turned only where they are asked for, so a population takes the memory
    of the array that it was made of.

    Parameters
    ----------
    values : DataArray with dims (cell, [channel,] layer, sector) or (cell, [channel,] layer, lag), or None
        A number for each window of each cell, NaN where it has none; float64 or float32. Without a dim
        channel its name is that of the array. A coord `compartment` along layer tells nucleus from cytoplasm.
        None for cells that have scalars alone.
    cells : DataFrame
        Row i belongs to values[i]. `condition` says what was done to the cell and `experiment` names the
        independent repetition: day, dish or animal. `disk_direction_NAME` (degrees in the disk) and
        `direction_strength_NAME` (0 to 1) are what `align` reads.
    areas : DataArray with dims (cell, layer, sector), optional
        Area of each window, in any unit: its weight in means over a cell. By default all are equal.
    scalars : sequence of str
        Numeric columns of cells that are compared beside the windows, such as area.

    Attributes
    ----------
    cells : DataFrame
        As given, with rows numbered from 0.
    raw : DataArray with dims (cell, channel, layer, sector)
        As given.
    areas : DataArray or None
    scalars : tuple of str
    normalisation : tuple of str
        What was done by `normalise`, in order.
    aligned_by : str
        What `align` turned cells by.
    level_status : ndarray of shape (cells,) and dtype object
        Why a cell could not be normalised and has no values; empty if it could.
    alignment : DataFrame
        By cell: `direction` (degrees in the disk), `strength` (resultant length, 0 to 1), `shift` (sectors)
        and `status` (ok, or why the cell was not turned).

    Raises
    ------
    PopulationError
        Values and table do not fit, values are infinite, or a column that is named is missing or no number.

    See Also
    --------
    open_population : Reads one from studies.
    compare_conditions : Compares two conditions.

    Examples
    --------
    >>> import numpy as np, pandas as pd, xarray as xr
    >>> import cytodisk as cd
    >>> values = xr.DataArray(np.ones((4, 2, 6)), dims=("cell", "layer", "sector"), name="Rac1")
    >>> cells = pd.DataFrame({"condition": ["control", "drug"] * 2, "experiment": ["a", "a", "b", "b"]})
    >>> cd.Population(values, cells)
    <Population: 4 cells, 2 conditions, 2 experiments, channels Rac1, 2 × 6 windows>
    """

    def normalise(self, method: str) -> Population:
        """Take out how bright each cell is as a whole.

        Parameters
        ----------
        method : {"none", "cell mean", "cell total", "z-score", "background"}
            "cell mean": values over the cell's mean. "cell total": share of the cell's total that a window of
            mean area holds. "z-score": standard deviations over the windows from the cell's mean.
            "background": minus the column `background_CHANNEL` of the table. Windows count by area. A second
            one goes on from the first, as background and then cell mean.

        Returns
        -------
        Population
            A cell that cannot be normalised, such as one with a mean of 0, has no values; `level_status` says
            why.

        Raises
        ------
        PopulationError
            There is no such method, or the table has no background.

        Examples
        --------
        >>> import cytodisk as cd
        >>> cells = cd.simulate.population(seed=0)
        >>> pop = cd.Population(cells.values + 10.0, cells.cells).normalise("cell mean")
        >>> float(pop.values[0].mean().round(6))
        1.0
        """
        still = self.unturned().blocks()  # as areas are
        done = cell_levels(method, still, self.scaling, self.cells, self.channels, self.weights)
        status = np.where(self.level_status == "", done.status, self.level_status)
        history = self.normalisation if method == "none" else (*self.normalisation, method)
        return self.changed(scaling=done.scaling, level_status=status, normalisation=history)

    def align(self, by: str, *, weakest: float = 0.05) -> Population:
        """Turn each cell on the disk so that sector 0 starts at a direction of its own.

        Cells are turned by whole sectors. A cell without a direction, or with one that is weaker than
        `weakest`, stays as it is, and `alignment` says so.

        Parameters
        ----------
        by : {"none", "nucleus", "front", "motion", "axis"} or "signal:CHANNEL"
            "none" undoes it. A signal's direction is its first harmonic around the cell. A long axis has two
            ends: the one of its column `disk_direction_axis` is taken.
        weakest : float
            Resultant length below which a cell has no direction.

        Returns
        -------
        Population

        Raises
        ------
        PopulationError
            There is no such direction, or values have no sectors.
        ParameterError
            `weakest` is no number from 0 to 1.

        Warnings
        --------
        Aligned by the signal that is shown, every atlas has a front, even one of noise.

        Examples
        --------
        >>> import cytodisk as cd
        >>> cells = cd.simulate.population(seed=0)
        >>> pop = cd.Population(cells.values, cells.cells).align("nucleus")
        >>> pop.alignment["status"].unique().tolist()
        ['ok']
        """
        if self.last != "sector":
            raise PopulationError(
                f"align: values run along {self.last}, not around the cell: use align('none')"
            )
        signal = None
        weakest = number_between("weakest", weakest, 0.0, 1.0)
        if isinstance(by, str) and by.startswith(SIGNAL):
            number = self.channel_number(by.removeprefix(SIGNAL))
            signal = self.unturned().blocks([self.channels[number]])
        table = chosen_direction(by, self.cells, signal, self.raw.sizes["sector"], weakest)
        scaling = self.scaling.turned_to(table["shift"].to_numpy(np.int64))
        return self.changed(scaling=scaling, alignment=table, aligned_by=by)

    def unturned(self) -> Population:
        """The same cells as they came, not aligned."""
        still = self.scaling.turned_to(np.zeros(len(self), dtype=np.int64))
        return self.changed(scaling=still, alignment=no_alignment(len(self)), aligned_by="none")

    def turned(self, sectors: IntArray) -> Population:
        """Each cell turned by so many sectors more, as a null of patterns.

        Parameters
        ----------
        sectors : ndarray of shape (cells,) and dtype int

        Returns
        -------
        Population
        """
        return self.changed(scaling=self.scaling.turned_to(self.scaling.shift + sectors))

    def atlas(self, by: str = CONDITION) -> xr.Dataset:
        """Mean and spread of the cells' windows, by condition.

        Parameters
        ----------
        by : str
            Column of cells, such as condition.

        Returns
        -------
        Dataset with dims (by, channel, layer, sector)
            `mean`: mean of the experiments' means; `sd`: over cells; `sem`: standard error over experiments;
            `n_cells` and `n_experiments` with a value. Without experiments the mean is that over cells, and
            sem is NaN.

        Raises
        ------
        PopulationError
            There is no such column.

        Examples
        --------
        >>> import cytodisk as cd
        >>> cells = cd.simulate.population(seed=0)
        >>> dict(cd.Population(cells.values, cells.cells).atlas()["mean"].sizes)
        {'condition': 2, 'channel': 1, 'layer': 4, 'sector': 12}
        """
        return atlas_of(by, self.cells, self.raw, self.blocks, self.units)

    def to_anndata(self) -> AnnData:
        """Cells × windows as `anndata.AnnData`, to go on in scanpy: PCA, neighbours, UMAP, clusters.

        Returns
        -------
        AnnData
            `X` (cells, windows): values as they are normalised and turned, NaN where a window has none; of
            cells without windows, their scalars. `obs`: the table of cells, with names that are unique.
            `var`: channel, layer, sector, compartment, and in how many cells the window has a value.
            `obsm`: "scalars" (`scalar_table`), "direction_NAME" (u and v in the turned disk, as long as it is
            strong) and "window_areas". `uns["cytodisk"]`: units, grid, normalisation, alignment, version. It
            shares no memory with the population.

        Raises
        ------
        MissingPartError
            anndata is not installed.

        Notes
        -----
        Text is kept as objects and categories, which `write_h5ad` of every version of AnnData writes. PCA
        takes no NaN: ``table[:, table.var["cells"] == table.n_obs]`` has the windows of all cells.

        Examples
        --------
        >>> import cytodisk as cd
        >>> cells = cd.simulate.population(seed=0)
        >>> table = cd.Population(cells.values, cells.cells).to_anndata()  # doctest: +SKIP
        >>> table.shape, table.obs["condition"].cat.categories.tolist()  # doctest: +SKIP
        ((144, 48), ['control', 'drug'])
        """
        return population_anndata(self)

    def scalar_table(self) -> pd.DataFrame:
        """One number a cell: signal by layer, edge to centre, nucleus to cytoplasm, polarity, and columns.

        Returns
        -------
        DataFrame
            A row for each cell. For each channel `layer_K_CHANNEL` from normalised values; `mean_CHANNEL`,
            `edge_to_centre_CHANNEL` (outermost over innermost layer of the cytoplasm),
            `nucleus_to_cytoplasm_CHANNEL` and `polarity_CHANNEL` (size of the first harmonic around the cell
            over the mean) from values without background, not normalised. Then the columns in `scalars`.
        """
        still = self.unturned()
        return scalars_of(
            self.cells, self.scalars, self.channels, self.compartments, still.blocks, self.levels, self.last
        )
