"""Names of what a movie can contribute to a population."""

from typing import Literal, TypeAlias, get_args

MovieSummary: TypeAlias = Literal["mean", "sd", "velocity", "peak_correlation", "lag", "around_events"]
MOVIE_SUMMARIES: tuple[str, ...] = get_args(MovieSummary)
"""What a movie can contribute."""
