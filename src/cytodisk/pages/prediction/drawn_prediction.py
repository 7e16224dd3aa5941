"""A cell with its prediction, opened for drawing, and the heading of its pages."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from cytodisk.pages.drawn_correlation import Heading
from cytodisk.pages.drawn_movie import LEFT_MM, DrawnMovie
from cytodisk.pages.grid_words import grid_words
from cytodisk.pages.settings_words import detrending, scope_words
from cytodisk.pages.sheet import BOLD_MM, broken_lines
from cytodisk.plot.layer_looks import layer_word, shown_layers
from cytodisk.plot.prediction.link_looks import lost_in, pairs_in
from cytodisk.runs.channel_names import VELOCITIES, shortened, shown_name
from cytodisk.runs.link_words import signal_words
from cytodisk.store.predictions.prediction_store import Prediction

_LONGEST_NAME = 14


@dataclass(frozen=True, eq=False)
class DrawnPrediction:
    """A cell with its prediction, opened for drawing.

    Attributes
    ----------
    movie : DrawnMovie
    prediction : Prediction
    """

    movie: DrawnMovie
    prediction: Prediction

    @property
    def cell(self) -> int:
        """Number of the cell."""
        return self.movie.cell

    @cached_property
    def names(self) -> dict[str, str]:
        """What signals are called in pictures."""
        links = self.prediction.links
        known = {*self.prediction.signals, *links["source"], *links["target"]}
        words = {name: signal_words(name) if name in VELOCITIES else shown_name(name) for name in known}
        return {name: shortened(shown, _LONGEST_NAME) for name, shown in words.items()}

    @cached_property
    def links(self) -> pd.DataFrame:
        """Rows of the cell in the table of links."""
        return self.rows(self.prediction.links)

    @property
    def pairs(self) -> list[tuple[tuple[str, str], tuple[str, str]]]:
        """Two signals each, both directions, in the order of the table."""
        return [(pair, pair[::-1]) for pair in pairs_in(self.links) if self._first(pair)]

    @property
    def partial_words(self) -> str:
        """What the partial gain is; empty if there is none of this cell."""
        return "without geometry" if self.links["gain_partial"].notna().any() else ""

    @property
    def lost(self) -> bool:
        """Whether there are links that do not count."""
        return bool(lost_in(self.links).any())

    @property
    def shown_layers(self) -> list[int]:
        """Numbers of the layers that pages of several layers show."""
        layers = sorted(int(layer) for layer in self.links["layer"].unique())
        return [layers[place] for place in shown_layers(len(layers), self.movie.cytoplasm_layers)]

    def layer_name(self, layer: int) -> str:
        """A layer with what it is, as "layer 0 (edge)"."""
        return layer_word(layer, int(self.links["layer"].nunique()), self.movie.cytoplasm_layers)

    def rows(self, table: pd.DataFrame) -> pd.DataFrame:
        """Rows of the cell in a table."""
        found: pd.DataFrame = table[table["cell"] == self.cell]
        return found

    def heading(self, width_mm: float, what: str) -> Heading:
        """What a page shows, and of which cell and how it was made.

        Parameters
        ----------
        width_mm : float
            Width of the page: long lines are broken.
        what : str
        """
        settings = self.prediction.settings
        facts = [f"cell {self.cell}", grid_words(self.movie.grid), f"{self.movie.frames} frames"]
        facts += [f"“{settings['name']}”"] if settings.get("name") else []
        facts += [*detrending(settings), *scope_words(settings), self._given]
        if settings.get("geometry") is False:
            facts.append("geometry was not tested")
        made = settings.get("surrogates", 0)
        facts.append(f"{made} shifted sources" if made else "not compared with chance")
        title = broken_lines(what.split(" "), " ", width_mm - 2 * LEFT_MM, BOLD_MM)
        return Heading(title, broken_lines(facts, " · ", width_mm - 2 * LEFT_MM))

    @property
    def _given(self) -> str:
        """What was given, in words."""
        asked = self.prediction.settings.get("given")
        if asked is None and self.prediction.is_network and len(self.prediction.signals) > 2:
            return "all others given"
        return f"given {', '.join(signal_words(name) for name in asked)}" if asked else "nothing given"

    def _first(self, pair: tuple[str, str]) -> bool:
        known = pairs_in(self.links)
        return pair[::-1] not in known or known.index(pair) < known.index(pair[::-1])
