"""Numbers of windows by cell and frame, out of a study's tables, kept within a bound."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from threading import RLock
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.napari.study_layers.byte_cache import ByteCache
from cytodisk.store.study import EDGE, WINDOWS, Study
from cytodisk.store.table_file import opened_table
from cytodisk.store.tables import read_table
from cytodisk.store.window_blocks import row_blocks, window_blocks

VALUE_BYTES = 128 * 2**20
"""Of numbers of windows."""

_AT_ONCE = 64  # frames, as many as are stored together; or cells
_ROWS = 200_000
_MOST_SAMPLED = 1_000_000  # values from which percentiles are taken
_DIMS = ("time", "channel", "layer", "sector")
_NUMBERS = ("mean", "area", "depth", "velocity")

Numbers = Mapping[str, FloatArray]


class WindowValues:
    """What a study's tables say of windows.

    Parameters
    ----------
    study : Study
    most_bytes : int
        How much is kept.
    """

    def __init__(self, study: Study, most_bytes: int = VALUE_BYTES):
        self.study = study
        self._blocks: ByteCache[dict[int, dict[str, FloatArray]]] = ByteCache(most_bytes, _size_of)
        self._reading = RLock()  # one thread at a time reads a store

    @cached_property
    def channels(self) -> tuple[str, ...]:
        """Names of the signal's channels; empty without a signal."""
        for block in window_blocks(self.study, "channel"):
            first = block["channel"].dropna().unique()
            return tuple(str(name) for name in first)
        return ()

    @cached_property
    def units(self) -> dict[str, str]:
        """Unit of each number."""
        scale = self.study.scale
        known = {"mean": "a.u.", "area": scale.area_unit, "depth": scale.length_unit}
        return known | {"velocity": scale.velocity_unit}

    @property
    def is_full(self) -> bool:
        """Whether more frames would push others out."""
        return self._blocks.is_full

    def at(self, cell: int, frame: int) -> Numbers:
        """Numbers of the windows of a cell in a frame.

        Parameters
        ----------
        cell, frame : int
            That have a map.

        Returns
        -------
        dict of str to ndarray
            "area" and "depth" of shape (layers, sectors); "mean" of shape (channels, layers, sectors) where
            there is a signal; "velocity" of shape (sectors,) in a movie.
        """
        if not self.study.is_movie:
            first = cell - cell % _AT_ONCE
            return self._blocks.get(first, lambda: dict(self._of_cells(first)))[cell]
        place = self._place(cell, frame)
        first = place - place % _AT_ONCE
        return self._blocks.get((cell, first), lambda: self._of_frames(cell, first))[place]

    def _place(self, cell: int, frame: int) -> int:
        """Place of a frame in the activity of a cell, whose frames increase."""
        if cell not in self._known_frames:
            with self._reading:
                frames = self.study.activity(cell)["frame"].to_numpy()
            self._known_frames[cell] = frames
        return int(np.searchsorted(self._known_frames[cell], frame))

    @cached_property
    def _known_frames(self) -> dict[int, IntArray]:
        return {}

    def _of_frames(self, cell: int, first: int) -> dict[int, dict[str, FloatArray]]:
        with self._reading:
            activity = self.study.activity(cell).isel(time=slice(first, first + _AT_ONCE))
            found = {name: activity[name] for name in _NUMBERS if name in activity}
            arrays = {
                name: values.transpose(*(dim for dim in _DIMS if dim in values.dims)).to_numpy()
                for name, values in found.items()
            }
        places = range(activity.sizes["time"])
        return {first + k: {name: values[k] for name, values in arrays.items()} for k in places}

    def _of_cells(self, first: int) -> Iterator[tuple[int, dict[str, FloatArray]]]:
        with self._reading, opened_table(self.study.path / WINDOWS) as file:
            names = [name for name in ("mean", "area", "depth") if name in file.schema_arrow.names]
            blocks = []
            for batch in row_blocks(file, ["cell", "channel", "layer", "sector", *names], _ROWS):
                rows = batch.to_pandas()
                blocks.append(rows[(rows["cell"] >= first) & (rows["cell"] < first + _AT_ONCE)])
        for cell, rows in pd.concat(blocks).groupby("cell", sort=False):
            yield int(str(cell)), self._arrays(rows, names)

    def _arrays(self, rows: pd.DataFrame, names: list[str]) -> dict[str, FloatArray]:
        layers, sectors = int(rows["layer"].max()) + 1, int(rows["sector"].max()) + 1
        arrays: dict[str, Any] = {name: rows[name].to_numpy().reshape(-1, layers, sectors) for name in names}
        of_channels = {"mean": arrays["mean"]} if self.channels else {}
        return {name: values[0] for name, values in arrays.items() if name != "mean"} | of_channels

    def sampled(self, channel: str) -> FloatArray:
        """Means of a channel in windows all over the study, from which limits of colours are taken."""
        with opened_table(self.study.path / WINDOWS) as file:
            every = max(1, int(file.metadata.num_rows) // _MOST_SAMPLED)
        blocks = window_blocks(self.study, "channel", "mean")
        found = [rows.loc[rows["channel"] == channel, "mean"].to_numpy()[::every] for rows in blocks]
        return np.concatenate([np.zeros(0), *found])

    def velocities(self) -> FloatArray:
        """All velocities of the edge of a movie."""
        table = read_table(self.study.path / EDGE) if "edge" not in vars(self.study) else self.study.edge
        return np.asarray(table["velocity"].to_numpy(), dtype=np.float64)


def _size_of(block: dict[int, dict[str, FloatArray]]) -> int:
    return sum(values.nbytes for arrays in block.values() for values in arrays.values())
