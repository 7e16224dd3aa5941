"""Parameters of `cytodisk predict` on a batch folder."""

from cytodisk.runs.population.pooling.pool_parameters import PoolParameters
from cytodisk.runs.predict.predict_parameters import PredictParameters


class BatchPredictParameters(PredictParameters, PoolParameters):
    """What decides the result of `cytodisk predict` on a batch folder."""
