"""The links of a cell that a picture shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd

from cytodisk.plot.prediction.link_looks import ALPHA, lost_in, of_pair, pairs_in, rows_of

LINK_COLUMNS = {"gain", "q", "effect"}


@dataclass(frozen=True)
class DrawnLink:
    """An arrow.

    Attributes
    ----------
    pair : (str, str)
    layers : tuple of int
        In which q < 0.05 and nothing speaks against it; all significant ones of a doubtful link.
    gain, effect : float
        In the strongest of these layers.
    doubtful : bool
        Whether geometry, or noise of measurement alone, may have made it in all layers.
    """

    pair: tuple[str, str]
    layers: tuple[int, ...]
    gain: float
    effect: float
    doubtful: bool


def drawn_links(links: pd.DataFrame, *, cell: int = 0) -> list[DrawnLink]:
    """The links of a cell that are beyond chance.

    Parameters
    ----------
    links : DataFrame
        `links` of a study's prediction: cell, source, target, layer, gain, q and effect; geometry and weaker
        where they are known.
    cell : int

    Returns
    -------
    list of DrawnLink
        In the order of the table.
    """
    rows = rows_of(links, cell, LINK_COLUMNS, "links")
    found = []
    for pair in pairs_in(rows):
        some = of_pair(rows, pair)
        some = some[some["q"] < ALPHA]
        kept = some[~lost_in(some)]
        shown = kept if len(kept) else some
        if len(shown):
            best = max(shown.to_dict("records"), key=lambda row: float(row["gain"]))
            layers = tuple(int(layer) for layer in shown["layer"])
            found.append(DrawnLink(pair, layers, float(best["gain"]), float(best["effect"]), kept.empty))
    return found


def layers_words(layers: Sequence[int]) -> str:
    """As "layer 0", "layers 0–2" or "layers 0–2, 7"."""
    ends = [layer for layer in layers if layer + 1 not in layers]
    starts = [layer for layer in layers if layer - 1 not in layers]
    ranges = [f"{a}–{b}" if b > a else f"{a}" for a, b in zip(starts, ends, strict=True)]
    return f"layer{'s' * (len(layers) > 1)} {', '.join(ranges)}"
