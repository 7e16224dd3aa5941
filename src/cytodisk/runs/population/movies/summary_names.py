"""Names of what a movie can contribute to a population."""

from typing import Literal, TypeAlias, get_args

MovieSummary: TypeAlias = Literal[
    "mean",
    "sd",
    "velocity",
    "peak_correlation",
    "lag",
    "around_events",
    "gain",
    "gain_score",
    "waves",
]
MOVIE_SUMMARIES: tuple[str, ...] = get_args(MovieSummary)
"""What a movie can contribute."""

OF_CORRELATIONS = ("peak_correlation", "lag")
OF_PREDICTIONS = ("gain", "gain_score")
OF_WAVES = ("waves",)
FROM_TABLES = (*OF_CORRELATIONS, *OF_PREDICTIONS, *OF_WAVES)
"""Summaries that read what another command wrote, of those channels, links or signals that it did."""
