"""Parameters of simulated series."""

from cytodisk.parameters import Parameters, parameter


class NeighbourParameters(Parameters):
    """How windows hang together with those beside them."""

    correlation_length: float = parameter(
        1.0,
        "Windows over which the correlation between neighbours falls to exp(-1/2), along the edge, where the "
        "last sector is the first one's neighbour, and inwards; 0: windows are independent.",
        least=0,
        unit="windows",
    )


class CouplingParameters(NeighbourParameters):
    """How activity follows velocity."""

    strength: float = parameter(
        0.5, "Correlation of the activity with the velocity that it follows.", least=-1, most=1
    )
