"""Parameters of `cytodisk correlate` on a batch folder."""

from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.population.pooling.pool_parameters import PoolParameters


class BatchCorrelateParameters(CorrelateParameters, PoolParameters):
    """What decides the result of `cytodisk correlate` on a batch folder."""
