"""`CellValues`: the windows of many cells and their table, read block by block."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Self

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import PopulationError
from cytodisk.population.cell_directions import no_alignment
from cytodisk.population.cell_scaling import BLOCK_VALUES, CellScaling, rolled
from cytodisk.population.excluded_cells import excluded_cells
from cytodisk.population.group_columns import CONDITION, EXPERIMENT, names_in
from cytodisk.population.population_checks import (
    check_table,
    checked_areas,
    checked_scalars,
    checked_values,
)


class CellValues:
    """What a `Population` holds, and how it is read; see there."""

    def __init__(
        self,
        values: xr.DataArray | None,
        cells: pd.DataFrame,
        *,
        areas: xr.DataArray | None = None,
        scalars: Sequence[str] = (),
    ) -> None:
        check_table(cells)
        self.cells = cells.reset_index(drop=True)
        self.raw = checked_values(values, len(cells))
        self.areas = checked_areas(areas, self.raw)
        self.scalars = checked_scalars(scalars, self.cells)
        self.normalisation: tuple[str, ...] = ()
        self.aligned_by = "none"
        self.alignment = no_alignment(len(self))
        self.level_status = np.full(len(self), "", dtype=object)
        self.scaling = CellScaling.none(len(self), self.raw.sizes["channel"])

    def __len__(self) -> int:
        return len(self.cells)

    def __repr__(self) -> str:
        words = [f"{len(self)} cells"]
        if self.conditions:
            words.append(f"{len(self.conditions)} conditions")
        if self.experiments:
            words.append(f"{len(self.experiments)} experiments")
        if self.channels:
            words.append(f"channels {', '.join(self.channels)}")
            words.append(f"{self.raw.sizes['layer']} × {self.raw.shape[-1]} windows")
        return f"<Population: {', '.join(words)}>"

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels."""
        return tuple(str(name) for name in self.raw["channel"].values)

    @property
    def conditions(self) -> tuple[str, ...]:
        """Names of the conditions, in order of the table."""
        return self._names(CONDITION)

    @property
    def experiments(self) -> tuple[str, ...]:
        """Names of the experiments, in order of the table."""
        return self._names(EXPERIMENT)

    @property
    def last(self) -> str:
        """The last dim: sector around the cell, or lag of curves."""
        return str(self.raw.dims[-1])

    @property
    def units(self) -> str:
        """Unit of the values, after normalising."""
        ratios = {"cell mean": "× cell mean", "cell total": "share of cell", "z-score": "sd"}
        own = str(self.raw.attrs.get("units", "a.u."))
        return next((ratios[name] for name in reversed(self.normalisation) if name in ratios), own)

    @property
    def compartments(self) -> tuple[str, ...]:
        """Compartment of each layer: cell, or cytoplasm and nucleus."""
        if "compartment" in self.raw.coords:
            return tuple(str(name) for name in self.raw["compartment"].values)
        return ("cell",) * self.raw.sizes["layer"]

    @property
    def excluded(self) -> pd.DataFrame:
        """Cells that the studies have and the population has not, each with the reason.

        Columns `input` (of the batch, or name of the study's folder), `source` (file of the masks), `frame`,
        `label` and `reason`; frame and label are empty for a file as a whole.
        """
        return excluded_cells(self.cells.attrs)

    @property
    def values(self) -> xr.DataArray:
        """Values of all cells, normalised and turned: (cell, channel, layer, sector), float64."""
        found = np.empty(self.raw.shape)
        for rows, block in self.blocks():
            found[rows] = block
        return self.raw.copy(data=found).assign_attrs(units=self.units)

    def blocks(self, channels: Sequence[str] | None = None) -> Iterator[tuple[slice, FloatArray]]:
        """Values of some cells at a time, normalised and turned, in order.

        Parameters
        ----------
        channels : sequence of str, optional
            By default all.

        Yields
        ------
        rows : slice
        values : ndarray of shape (cells, channels, layers, sectors) and dtype float64
        """
        at = slice(None) if channels is None else [self.channel_number(name) for name in channels]
        raw, scaling = self.raw.values, self.scaling
        step = max(1, BLOCK_VALUES // max(1, int(np.prod(self.raw.shape[1:]))))
        for start in range(0, len(self), step):
            rows = slice(start, min(start + step, len(self)))
            block = raw[rows][:, at].astype(np.float64)
            level = scaling.background[rows][:, at] + scaling.centre[rows][:, at]
            if level.any():
                block -= level[:, :, None, None]
            block *= scaling.factor[rows][:, at, None, None]
            yield rows, rolled(block, scaling.shift[rows])

    def channel_number(self, name: str) -> int:
        """Place of a channel.

        Raises
        ------
        PopulationError
            There is no such channel.
        """
        if name not in self.channels:
            raise PopulationError(
                f"channel {name!r} is not in the population: it has {', '.join(self.channels) or 'none'}"
            )
        return self.channels.index(name)

    def levels(self) -> Iterator[tuple[slice, FloatArray, FloatArray]]:
        """Values without background, not normalised and not turned, and weights of windows; as `blocks`."""
        plain = self.changed(scaling=self.scaling.background_only)
        for rows, block in plain.blocks():
            yield rows, block, self.weights(rows)

    def weights(self, rows: slice) -> FloatArray:
        """Areas of windows (cells, layers, last) as they came, not turned; all 1 if they are not known."""
        if self.areas is None:
            return np.ones((1, self.raw.shape[2], self.raw.shape[3]))
        return np.asarray(self.areas.values[rows], dtype=np.float64)

    def select(self, rows: BoolArray | pd.Series[bool]) -> Self:
        """The population of some of the cells.

        Parameters
        ----------
        rows : ndarray or Series of shape (cells,) and dtype bool

        Returns
        -------
        Population

        Raises
        ------
        PopulationError
            They are no truths, or not one for each cell.
        """
        mask = np.asarray(rows)
        if mask.dtype != np.bool_ or mask.shape != (len(self),):
            raise PopulationError(
                f"rows must be {len(self)} values of True and False, one a cell, got {mask.dtype} of shape "
                f"{mask.shape}: write a condition, such as pop.cells['area'] > 100"
            )
        chosen = np.flatnonzero(mask)
        return self.changed(
            cells=self.cells.iloc[chosen].reset_index(drop=True),
            raw=self.raw.isel(cell=chosen),
            areas=None if self.areas is None else self.areas.isel(cell=chosen),
            scaling=self.scaling.of(chosen),
            alignment=self.alignment.iloc[chosen].reset_index(drop=True),
            level_status=self.level_status[chosen],
        )

    def with_cells(self, cells: pd.DataFrame) -> Self:
        """The same values with another table, row for row.

        Parameters
        ----------
        cells : DataFrame

        Returns
        -------
        Population

        Raises
        ------
        PopulationError
            It has another number of rows.
        """
        if len(cells) != len(self):
            raise PopulationError(f"cells has {len(cells)} rows for a population of {len(self)} cells")
        check_table(cells)
        checked_scalars(self.scalars, cells)
        return self.changed(cells=cells.reset_index(drop=True))

    def changed(self, **fields: Any) -> Self:
        """The same with other fields; nothing is checked again."""
        new = object.__new__(type(self))
        new.__dict__.update(self.__dict__ | fields)
        return new

    def _names(self, column: str) -> tuple[str, ...]:
        if column not in self.cells:
            return ()
        return tuple(dict.fromkeys(names_in(self.cells, column).dropna()))
