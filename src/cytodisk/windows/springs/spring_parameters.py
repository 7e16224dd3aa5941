"""Parameters of edge-based windows whose sides are springs."""

from cytodisk.geometry.mask_parameters import HoleParameters
from cytodisk.parameters import Parameters, parameter
from cytodisk.windows.grid_parameters import EdgeGridParameters

EVENNESS = 4.0


class EvennessParameters(Parameters):
    """How strong the springs are."""

    evenness: float = parameter(
        EVENNESS,
        "Over how many neighbouring windows of a layer the springs even out widths; 0: sides follow the "
        "gradient of the distance from the edge alone.",
        least=0,
        most=1_000_000,
        unit="windows",
    )


class SpringGridParameters(EvennessParameters, EdgeGridParameters):
    """How a cell is divided by distance from its edge, with sides that are springs."""


class SpringWindowParameters(HoleParameters, SpringGridParameters):
    """What `spring_windows` takes."""


class LineTensionParameters(Parameters):
    """How the edge is followed from frame to frame by springs along it."""

    line_tension: float = parameter(
        0.5,
        "Over how many neighbouring sectors springs along the edge even out their lengths in each step; 0: "
        "points go to the nearest edge of the next frame.",
        least=0,
        most=1_000_000,
        unit="windows",
    )
