"""Parameters of `edge_waves` and `disk_waves`."""

from cytodisk.parameters import MOST_SEED, Parameters, parameter


class WaveSearchParameters(Parameters):
    """How waves are looked for."""

    max_mode: int = parameter(
        8,
        "Most waves around the cell that are looked for; never more than half of the sectors can show.",
        least=0,
        most=200,
    )
    frames_per_period: float = parameter(
        8.0,
        "Shortest period that is looked for.",
        least=4.0,
        most=1000.0,
        unit="frames",
    )
    periods: float = parameter(
        1.5,
        "Fewest periods that the movie must show: the longest period is its duration divided by this.",
        least=1.5,
        most=100.0,
    )
    surrogates: int = parameter(
        199,
        "Number of surrogate movies to compare with. 199 give p-values down to 0.005.",
        least=19,
        most=100_000,
    )
    seed: int = parameter(0, "Seed of the surrogates.", least=0, most=MOST_SEED)
