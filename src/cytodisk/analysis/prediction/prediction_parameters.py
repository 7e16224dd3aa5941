"""Parameters of `predict`."""

from typing import Literal, TypeAlias

from cytodisk.analysis.correlation.correlation_parameters import MOST_SURROGATES
from cytodisk.parameters import MOST_SEED, Parameters, parameter

Criterion: TypeAlias = Literal["aic", "bic"]

MOST_ORDER = 50  # frames of past; a model of more has more coefficients than movies have frames


class OrderParameters(Parameters):
    """How many frames of the past a model holds."""

    max_order: int = parameter(
        8,
        "Longest past that is tried. The first frames of a movie, as many, are past alone.",
        least=1,
        most=MOST_ORDER,
        unit="frames",
    )
    order: int | None = parameter(
        None,
        "Frames of the target's own past, and of its neighbours'; without it, the criterion chooses.",
        least=1,
        most=MOST_ORDER,
    )
    source_order: int | None = parameter(
        None,
        "Frames of the source's past; without it, the criterion chooses, in every surrogate anew.",
        least=1,
        most=MOST_ORDER,
    )
    given_order: int | None = parameter(
        None,
        "Frames of the past of each signal that is given; without it, the criterion chooses.",
        least=1,
        most=MOST_ORDER,
    )
    criterion: Criterion = parameter(
        "bic",
        'What chooses: "bic" takes shorter pasts, "aic" longer ones.',
    )


class HeldParameters(OrderParameters):
    """What is held against the source, and what chance would give."""

    neighbours: bool = parameter(
        True, "Also hold against the source what the past of both neighbours along the edge predicts."
    )
    surrogates: int = parameter(
        999,
        "Number of shifted sources to compare with; 0 for none. A short movie of few sectors has fewer.",
        least=0,
        most=MOST_SURROGATES,
    )
    seed: int = parameter(0, "Seed of the shifts.", least=0, most=MOST_SEED)


class PredictionParameters(HeldParameters):
    """How one signal predicts another."""

    edge_sectors: int | None = parameter(
        None,
        "Number of sectors of the whole edge, where only some are passed: its last one is the neighbour of "
        "sector 0. Without it, sectors numbered from 0 without a gap are the whole edge.",
        least=1,
        most=100_000,
        unit="sectors",
    )
