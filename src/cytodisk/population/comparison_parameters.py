"""Parameters of `compare_conditions` and of what is built like it."""

from typing import Literal, TypeAlias

from cytodisk.parameters import MOST_SEED, Parameters, parameter

Unit: TypeAlias = Literal["experiment", "cell"]
Design: TypeAlias = Literal["auto", "paired", "unpaired"]
Scale: TypeAlias = Literal["rank", "linear", "log"]
Normalisation: TypeAlias = Literal["none", "cell mean", "cell total", "z-score", "background"]

MOST_PERMUTATIONS = 1_000_000


class PermutationParameters(Parameters):
    """How chance is drawn."""

    permutations: int = parameter(
        9999,
        "Most ways to exchange labels that are tried; where there are fewer, all of them are.",
        least=99,
        most=MOST_PERMUTATIONS,
    )
    seed: int = parameter(0, "Start of the random numbers.", least=0, most=MOST_SEED)


class DoseParameters(PermutationParameters):
    """How a trend over a dose is tested."""

    scale: Scale = parameter(
        "rank",
        'How far doses lie apart. "rank": each dose is a step from the next lower one. "linear": as they '
        'are. "log": by factors of 10, for doses above 0.',
    )


class ComparisonParameters(PermutationParameters):
    """How two conditions are compared."""

    unit: Unit = parameter(
        "experiment",
        'What is exchanged between conditions. "experiment": the means of whole experiments, which are '
        'independent. "cell": single cells, as if those of a dish were independent, which they are not.',
    )
    design: Design = parameter(
        "auto",
        '"paired": experiments hold both conditions, and are compared with themselves. "unpaired": each '
        'experiment holds one condition, and equal names are different experiments. "auto": paired if '
        "experiments have the same name in both conditions, and the result says so.",
    )
