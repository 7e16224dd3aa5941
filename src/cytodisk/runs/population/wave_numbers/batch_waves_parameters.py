"""Parameters of `cytodisk waves` on a batch folder."""

from cytodisk.runs.population.pooling.pool_parameters import PoolParameters
from cytodisk.runs.waves.wave_run_parameters import WavesParameters


class BatchWavesParameters(WavesParameters, PoolParameters):
    """What decides the result of `cytodisk waves` on a batch folder."""
