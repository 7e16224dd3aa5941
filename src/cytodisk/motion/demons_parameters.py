"""Parameters of the paper's tracker."""

from cytodisk.parameters import Parameters, parameter

_MOST_STEPS = 10_000


class DemonsFieldParameters(Parameters):
    """Parameters of a demons registration of two masks."""

    iterations: int = parameter(
        100, "Number of iterations of the demons registration.", least=0, most=_MOST_STEPS
    )
    sigma: float = parameter(
        1.0,
        "Standard deviation of the smoothing of the displacement field after each iteration.",
        above=0,
        most=1000,
        unit="px",
    )


class DemonsParameters(DemonsFieldParameters):
    """Parameters of the tracker "demons"; the paper gives the step and the number of steps of the snake."""

    snake_step: float = parameter(1.0, "Longest step of the snake.", above=0, most=1000, unit="px")
    snake_iterations: int = parameter(100, "Number of steps of the snake.", least=0, most=_MOST_STEPS)
    gvf_mu: float = parameter(
        0.2,
        "Weight of smoothness in the gradient vector flow; the flow diverges above 0.25.",
        above=0,
        most=0.25,
    )
    gvf_iterations: int = parameter(
        100,
        "Number of steps of the flow's diffusion: how many pixels it reaches from the edge.",
        least=0,
        most=_MOST_STEPS,
    )
    snake_tension: float = parameter(
        0.01,
        "Weight of stretch in the energy of the snake. The default smooths over less than a pixel.",
        least=0,
        most=1_000_000,
        unit="px²",
    )
    snake_stiffness: float = parameter(
        0.1, "Weight of bending in that energy.", least=0, most=1_000_000, unit="px⁴"
    )
    redistribute: bool = parameter(True, "Space the points evenly along the new edge.")
