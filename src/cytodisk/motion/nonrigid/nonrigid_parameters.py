"""Parameters of the registration of every frame to one reference."""

from cytodisk.parameters import Parameters, parameter


class NonrigidParameters(Parameters):
    """How each frame of a movie is registered to the first one."""

    iterations: int = parameter(
        100, "Number of iterations of the demons registration of each frame.", least=0, most=100_000
    )
    sigma: float = parameter(
        1.0,
        "Standard deviation of the smoothing of the displacement field after each iteration.",
        above=0,
        most=1000,
        unit="px",
    )
    warm_start: bool = parameter(True, "Start each frame's field from that of the frame before.")
