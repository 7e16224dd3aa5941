"""What speaks against the significant links of a cell, direction by direction."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pandas as pd

from cytodisk.analysis.correlation.prepared_series import DRIFTING_SHARE
from cytodisk.runs.link_words import is_of_velocity, jitters
from cytodisk.runs.partial_words import SIGNIFICANT
from cytodisk.store.predictions.prediction_store import Prediction

JITTER, GEOMETRY_UNTESTED, WEAKER = "jitter", "geometry not tested", "weaker direction"
DRIFTING, RESTARTED = "drifting series", "tracking started anew"
_TURNING = 0.25  # of the larger sum of coefficients of one sign: less of the other is not told


@dataclass(frozen=True)
class JudgedLink:
    """A layer in which one signal predicts another beyond chance.

    Attributes
    ----------
    row : dict
        Its row of the table of links.
    doubts : tuple of str
        What speaks against it, as "jitter".
    lost : bool
        Whether it is not significant without geometry.
    turns : int
        Sign of the earliest coefficient that is not 0, if a later one has the other sign; else 0.
    """

    row: dict[Any, Any]
    doubts: tuple[str, ...]
    lost: bool
    turns: int = 0

    @property
    def layer(self) -> int:
        """Number of its layer."""
        return int(self.row["layer"])

    @property
    def clear(self) -> bool:
        """Whether nothing known speaks against it."""
        return not (self.doubts or self.lost)


@dataclass(frozen=True, eq=False)
class Direction:
    """One source and target of a cell, over layers.

    Attributes
    ----------
    source, target : str
    given : str
        With commas between.
    rows : DataFrame
        Of the table of links.
    judged : tuple of JudgedLink
        Significant layers, from the edge in.
    """

    source: str
    target: str
    given: str
    rows: pd.DataFrame
    judged: tuple[JudgedLink, ...]

    @property
    def clear(self) -> list[JudgedLink]:
        """Significant layers that nothing known speaks against."""
        return [one for one in self.judged if one.clear]

    @property
    def waiting(self) -> list[JudgedLink]:
        """Those that stay without geometry, with something else against them."""
        return [one for one in self.judged if one.doubts and not one.lost]

    @property
    def lost(self) -> list[JudgedLink]:
        """Those that geometry may have made."""
        return [one for one in self.judged if one.lost]

    @property
    def least_q(self) -> float:
        """Smallest q of any layer; NaN without surrogates."""
        return float(self.rows["q"].min())


def directions(found: Prediction, cell: int) -> list[Direction]:
    """Each source and target of a cell, with what speaks against it.

    Parameters
    ----------
    found : Prediction
    cell : int
        That is not left out.

    Returns
    -------
    list of Direction
        Of a pair first source to target, then back.
    """
    row = found.cells[found.cells["cell"] == cell].iloc[0]
    links = found.links[found.links["cell"] == cell]
    parts = []
    for (source, target), rows in links.groupby(["source", "target"], sort=False):
        judged = [
            JudgedLink(link, tuple(_doubts(found, row, link)), bool(link["geometry"]), _turns(found, link))
            for link in rows[rows["q"] < SIGNIFICANT].to_dict("records")
        ]
        given = str(rows["given"].iloc[0] or "")
        parts.append(Direction(str(source), str(target), given, rows, tuple(judged)))
    return parts


def strongest(links: list[JudgedLink]) -> JudgedLink:
    """The link of largest gain, against what shifted sources have on average."""
    return max(links, key=lambda one: float(one.row["gain_excess"]))


def _turns(found: Prediction, link: dict[Any, Any]) -> int:
    """The sign at first of a link whose sign changes with the lag: coefficients whose intervals have no 0."""
    lags = found.lags
    for name in ("cell", "source", "target", "layer"):
        lags = lags[lags[name] == link[name]]
    sure = lags[lags["low"] * lags["high"] > 0].sort_values("lag")["coefficient"]
    more, less = float(sure.clip(lower=0.0).sum()), float(-sure.clip(upper=0.0).sum())
    if min(more, less) <= _TURNING * max(more, less):
        return 0
    return 1 if sure.iloc[0] > 0 else -1


def _doubts(found: Prediction, row: Any, link: dict[Any, Any]) -> Iterator[str]:
    if link["weaker"]:
        yield WEAKER
    if is_of_velocity(link) and jitters(row):
        yield JITTER
    if found.settings.get("geometry"):
        if row["geometry_not_tested"] or pd.isna(link["gain_partial"]):
            yield GEOMETRY_UNTESTED
    elif "geometry" in found.settings:
        yield GEOMETRY_UNTESTED
    yield from filter(None, str(link["stress"] or "").split(", "))
    if link["drifting"] > DRIFTING_SHARE:
        yield DRIFTING
    if row["restarts"] > 0:
        yield RESTARTED
