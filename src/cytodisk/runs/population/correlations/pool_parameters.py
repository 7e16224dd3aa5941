"""Parameters of `cytodisk correlate` on a batch folder."""

from cytodisk.parameters import parameter
from cytodisk.population.comparison_parameters import PermutationParameters
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.run_options import TableOptions


class PoolParameters(PermutationParameters):
    """How curves of many cells are pooled and tested."""

    compare: tuple[str, ...] = parameter(
        (),
        "Conditions that are compared, the control first. Without it all are, with the one called control, "
        "or else the first of the batch file.",
        words="names of conditions with commas between",
    )


class BatchCorrelateParameters(CorrelateParameters, PoolParameters):
    """What decides the result of `cytodisk correlate` on a batch folder."""


class PoolOptions(TableOptions):
    """How the studies of a batch are correlated."""

    resume: bool = parameter(
        False, "Keep the correlations that are there with the same settings, and do the others."
    )
