"""How much the past of one signal predicts another in a movie's cell, as `cytodisk predict` found it."""

from __future__ import annotations

import shlex
from collections.abc import Sequence

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.errors import NoValuesError, PopulationError
from cytodisk.runs.population.movies.cell_layers import as_windows, reason_of
from cytodisk.runs.population.movies.normal_score import normal_score
from cytodisk.store.predictions.prediction_store import Prediction
from cytodisk.store.study import Study

ARROW = " → "
"""Between the names of a link, as "Rac1 → velocity"."""


def link_name(source: str, target: str) -> str:
    """Name of a link as a channel of a population."""
    return f"{source}{ARROW}{target}"


def with_link_names(links: pd.DataFrame) -> pd.DataFrame:
    """A table of links with their names in a column channel."""
    return links.assign(channel=links["source"] + ARROW + links["target"])


def gains(study: Study, cell: int, summary: str, channels: Sequence[str] | None) -> xr.DataArray:
    """Gain beyond chance of each link by layer, or the score of its p.

    Parameters
    ----------
    study : Study
    cell : int
    summary : {"gain", "gain_score"}
    channels : sequence of str or None
        Names of links, as "Rac1 → velocity"; all that were tested by default.

    Returns
    -------
    DataArray with dims (channel, layer, sector)
        The same in all sectors of a layer, as a link is tested over them together.

    Raises
    ------
    PopulationError
        No link was tested, or not that one, or without surrogates.
    NoValuesError
        The cell was refused by `cytodisk predict`.
    """
    tested = _tested(study)
    names = list(tested) if channels is None else list(channels)
    if missing := [name for name in names if name not in tested]:
        raise PopulationError(
            f"link {missing[0]!r} was not tested in study {study.path}: it has "
            f"{', '.join(map(repr, tested))}; to test another, type cytodisk predict "
            f"{shlex.quote(str(study.path))} --source SOURCE --target TARGET"
        )
    parts = [_of_link(tested[name], cell, name, summary) for name in names]
    joined = pd.concat(parts, axis=1, keys=names)
    values = xr.DataArray(
        joined.to_numpy(np.float64).T,
        dims=("channel", "layer"),
        coords={"channel": names, "layer": joined.index.to_numpy()},
        attrs={"units": "nat" if summary == "gain" else "1"},
        name=summary,
    )
    return as_windows(values, study.activity(cell))


def _of_link(found: Prediction, cell: int, name: str, summary: str) -> pd.Series:
    """Values of a link by layer."""
    links = with_link_names(found.links)
    own = links[(links["cell"] == cell) & (links["channel"] == name)].set_index("layer")
    if own.empty:
        what = f"not tested for prediction: {reason_of(found.cells, cell)}"
        raise NoValuesError(what)
    if own["gain"].notna().any() and own["p"].isna().all():
        raise PopulationError(
            f"the prediction in {found.path} has no p and no gain beyond chance: type cytodisk predict again "
            "without --surrogates 0"
        )
    if summary == "gain":
        return own["gain_excess"].astype(np.float64)
    return scores_of(own, found.cells)


def scores_of(links: pd.DataFrame, cells: pd.DataFrame) -> pd.Series:
    """Normal scores of the p of links, see `normal_score`.

    Parameters
    ----------
    links : DataFrame
        cell and p.
    cells : DataFrame
        cell and the number of its surrogates.
    """
    surrogates = links["cell"].map(cells.set_index("cell")["surrogates"])
    scores = normal_score(links["p"].to_numpy(np.float64), surrogates.to_numpy(np.float64, na_value=np.nan))
    return pd.Series(scores, index=links.index)


def _tested(study: Study) -> dict[str, Prediction]:
    """By link the prediction that it is read from: a pair's if there are some, else the network's."""
    names = [names for names in study.predictions if len(names) < 3]  # no variants
    pairs = [one for one in names if len(one) == 2]
    found: dict[str, Prediction] = {}
    for one in pairs or names:
        prediction = study.prediction(*one)
        found |= dict.fromkeys(with_link_names(prediction.links)["channel"].unique(), prediction)
    if not found:
        raise PopulationError(
            f"study {study.path} has no prediction: type cytodisk predict {shlex.quote(str(study.path))}"
        )
    return found
