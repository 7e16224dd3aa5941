"""Parameters of `average_around`."""

from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from cytodisk.analysis.events import Kind
from cytodisk.parameters import MOST_SEED, Parameters, parameter

Moment: TypeAlias = Literal["onset", "peak", "end"]
Normalisation: TypeAlias = Literal["none", "mean", "sd"]


class EventAverageParameters(Parameters):
    """How a signal is averaged around events."""

    kind: Kind = parameter("protrusion", "Which events.")
    at: Moment = parameter(
        "onset",
        "The moment of delay 0. Events in which it is not known, at the ends of the movie and beside NaN, "
        "are left out; a peak is known where both ends are.",
    )
    normalise: Normalisation = parameter(
        "none",
        '"mean" subtracts from each window of each event its own mean over the delays that it has; "sd" then '
        "divides by its standard deviation, and leaves out windows that do not vary.",
    )
    bootstrap: int = parameter(
        1000, "How often patches are drawn for the band; 0 for none.", least=0, most=100_000
    )
    seed: int = parameter(0, "Seed of the draws.", least=0, most=MOST_SEED)
    confidence: Annotated[float, Field(lt=1)] = parameter(
        0.95, "Share of repeated experiments whose band is to hold the true mean, at one delay.", above=0
    )
