"""Parameters of commands that pool the movies of a batch."""

from cytodisk.parameters import parameter
from cytodisk.population.comparison_parameters import PermutationParameters
from cytodisk.runs.run_options import TableOptions


class PoolParameters(PermutationParameters):
    """How numbers of many cells are pooled and tested."""

    compare: tuple[str, ...] = parameter(
        (),
        "Conditions that are compared, the control first. Without it all are, with the one called control, "
        "or else the first of the batch file.",
        words="names of conditions with commas between",
    )


class PoolOptions(TableOptions):
    """How the studies of a batch are gone through."""

    resume: bool = parameter(
        False, "Keep the results of movies that are there with the same settings, and do the others."
    )
