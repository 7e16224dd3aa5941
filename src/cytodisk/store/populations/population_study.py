"""`PopulationStudy`: what `cytodisk population` wrote, read back."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd
import xarray as xr

from cytodisk.errors import ReadError
from cytodisk.scale import Scale
from cytodisk.store.populations.population_columns import population_tables
from cytodisk.store.populations.window_arrays import window_arrays
from cytodisk.store.provenance_file import PROVENANCE, read_complete
from cytodisk.store.table_file import REMEDY, check_heads, read_checked, units_in

RUN = "population"
CURVES, CONTROL, CONDITIONS, SENTENCES = "curves", "control", "conditions", "sentences"  # of the provenance
SCALARS = "scalars compared"
_PLACE = ("frame", "label")  # which a file as a whole has not


class StudyWarning(NamedTuple):
    """A reason to doubt a result of a population.

    Attributes
    ----------
    condition, control : str
        The comparison that it is about; both empty where it is about all.
    name : str
        As "too few experiments".
    finding, consequence, remedy : str
        Sentences: what was found, what it means for the result, what to do.
    """

    condition: str
    control: str
    name: str
    finding: str
    consequence: str
    remedy: str


@dataclass(frozen=True)
class PopulationStudy:
    """The reading side of a population's study.

    Attributes
    ----------
    path : Path
    provenance : dict
        Versions, inputs with their hashes, parameters, times.

    See Also
    --------
    open_population_study : Opens one.

    Examples
    --------
    >>> import cytodisk as cd
    >>> made = cd.simulate.population_images("images", experiments=3, cells=2)
    >>> settings = {"groups": made.groups, "layers": 3, "sectors": 6}
    >>> _ = cd.run_map(made.masks, "maps", signal=made.images, **settings)
    >>> _ = cd.run_population("maps", "atlas", channel=["Rac1"])  # or: cytodisk population maps -o atlas …
    >>> study = cd.open_population_study("atlas")
    >>> study
    <PopulationStudy atlas: 12 cells, control, drug>
    >>> study.window_arrays("drug")["p_fwer"].sizes
    Frozen({'channel': 1, 'layer': 3, 'sector': 6})
    """

    path: Path
    provenance: dict[str, Any]

    def __repr__(self) -> str:
        return f"<PopulationStudy {self.path}: {len(self.cells)} cells, {', '.join(self.conditions)}>"

    @property
    def is_curves(self) -> bool:
        """Whether curves over lags are compared, not the windows of a disk."""
        return bool(self.provenance.get(CURVES, False))

    @property
    def conditions(self) -> tuple[str, ...]:
        """All conditions, the control first."""
        return tuple(self.provenance.get(CONDITIONS, ()))

    @property
    def control(self) -> str:
        """The condition that others are compared with; empty if nothing is compared."""
        return str(self.provenance.get(CONTROL, ""))

    @property
    def compared(self) -> tuple[str, ...]:
        """The conditions that are compared with the control."""
        return tuple(self.comparisons["condition"])

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels; one empty name where there is no channel."""
        return tuple(dict.fromkeys(self.atlas["channel"]))

    @property
    def parameters(self) -> dict[str, Any]:
        """What the run was asked for, see `PopulationParameters`."""
        return dict(self.provenance["parameters"])

    @property
    def scale(self) -> Scale:
        """µm per pixel and seconds per frame of the cells; None where unknown, or where they differ."""
        return Scale(self.provenance.get("pixel_size_um"), self.provenance.get("frame_interval_s"))

    @property
    def sentences(self) -> tuple[str, ...]:
        """What the run said: what this number of experiments can reach first, then design and findings."""
        return tuple(self.provenance.get(SENTENCES, ()))

    @property
    def scalar_names(self) -> tuple[str, ...]:
        """Columns of `cells` that are compared as scalars."""
        return tuple(self.provenance.get(SCALARS, ()))

    @property
    def warnings(self) -> tuple[StudyWarning, ...]:
        """Reasons to doubt the results, each with its name, what was found, what it means, what to do."""
        columns = list(StudyWarning._fields)
        return tuple(StudyWarning(*row) for row in self._table("warnings")[columns].itertuples(index=False))

    @cached_property
    def cells(self) -> pd.DataFrame:
        """One row a cell: condition, experiment, the user's columns, its alignment and its scalars."""
        return self._table("cells")

    @cached_property
    def atlas(self) -> pd.DataFrame:
        """One row a condition and window: mean, sd, sem and counts; see `atlas_arrays`."""
        return self._table("atlas")

    @cached_property
    def windows(self) -> pd.DataFrame:
        """One row a comparison and window: difference, effect size, probabilities; see `window_arrays`."""
        return self._table("windows")

    @cached_property
    def clusters(self) -> pd.DataFrame:
        """One row a comparison and cluster of windows that differ together."""
        return self._table("clusters")

    @cached_property
    def scalars(self) -> pd.DataFrame:
        """One row a comparison and scalar, as the edge-to-centre ratio of a channel."""
        return self._table("scalars")

    @cached_property
    def profiles(self) -> pd.DataFrame:
        """One row a condition, experiment, channel and layer: the profile by depth."""
        return self._table("profiles")

    @cached_property
    def experiments(self) -> pd.DataFrame:
        """One row a condition and experiment: how many cells, and whether it is in the tests."""
        return self._table("experiments")

    @cached_property
    def left_out(self) -> pd.DataFrame:
        """One row a comparison, experiment that is left out, and result: what is left of it."""
        return self._table("left_out")

    @cached_property
    def comparisons(self) -> pd.DataFrame:
        """One row a comparison: its design, smallest_p, what was found, in numbers and in a sentence."""
        return self._table("comparisons")

    @cached_property
    def trends(self) -> pd.DataFrame:
        """One row a window: how it follows the dose; no rows without --dose."""
        return self._table("trends")

    @cached_property
    def scalar_trends(self) -> pd.DataFrame:
        """One row a scalar: how it follows the dose; no rows without --dose."""
        return self._table("scalar_trends")

    @cached_property
    def gallery(self) -> pd.DataFrame:
        """One row a window of the cells nearest to the mean of their condition, and farthest from it."""
        return self._table("gallery")

    @cached_property
    def excluded(self) -> pd.DataFrame:
        """One row a cell, or file, of the studies that is not among `cells`, with the reason."""
        return self._table("excluded", _PLACE).astype(dict.fromkeys(_PLACE, "Int64"))

    @cached_property
    def atlas_arrays(self) -> xr.Dataset:
        """`atlas` as arrays with dims (condition, channel, layer, sector), or lag in the place of sector."""
        return window_arrays(self.atlas, "condition").reindex(condition=list(self.conditions))

    def window_arrays(self, condition: str) -> xr.Dataset:
        """The comparison of one condition with the control as arrays.

        Parameters
        ----------
        condition : str
            One of `compared`.

        Returns
        -------
        Dataset with dims (channel, layer, sector), or lag in the place of sector

        Raises
        ------
        ReadError
            There is no such comparison.
        """
        rows = self.windows[self.windows["condition"] == condition]
        if rows.empty:
            there = ", ".join(map(repr, self.compared)) or "none"
            raise ReadError(f"population {self.path} has no comparison of {condition!r}: it has {there}")
        return window_arrays(rows)

    def _table(self, name: str, may_be_empty: Sequence[str] = ()) -> pd.DataFrame:
        columns = population_tables(self.is_curves)[name]
        path = self.path / f"{name}.parquet"
        units = units_in(self.provenance)
        return read_checked(path, columns, units=units, finite=False, may_be_empty=may_be_empty)


def open_population_study(path: str | os.PathLike[str]) -> PopulationStudy:
    """Read what `cytodisk population` wrote.

    Parameters
    ----------
    path : path-like
        Its folder.

    Returns
    -------
    PopulationStudy

    Raises
    ------
    ReadError
        The folder does not exist, is not a study of `cytodisk population`, is damaged, or its run is not
        complete.

    See Also
    --------
    run_population : Writes the study.
    open_study : Read what run_map or run_movie wrote.

    Examples
    --------
    >>> import cytodisk as cd
    >>> made = cd.simulate.population_images("images", experiments=3, cells=2)
    >>> settings = {"groups": made.groups, "layers": 3, "sectors": 6}
    >>> _ = cd.run_map(made.masks, "maps", signal=made.images, **settings)
    >>> _ = cd.run_population("maps", "atlas", channel=["Rac1"])  # or: cytodisk population maps -o atlas …
    >>> study = cd.open_population_study("atlas")
    >>> study.sentences[0]
    '3 + 3 experiments can give p = 0.1 at best (all 20 exchanges of labels): no difference can reach 0.05.'
    >>> study.scalars[["scalar", "difference", "p"]].shape
    (7, 3)
    """
    folder = Path(path)
    provenance = read_complete(folder, RUN)
    names = provenance.get(CONDITIONS)
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise ReadError(f"{folder / PROVENANCE}: {CONDITIONS} are missing: {REMEDY}")
    check_heads(folder / f"{name}.parquet" for name in population_tables(False))
    return PopulationStudy(folder, provenance)
