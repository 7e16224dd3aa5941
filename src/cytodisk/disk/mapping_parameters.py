"""Parameters of `map_to_disk`."""

from typing import Literal, TypeAlias

from cytodisk.parameters import Parameters, parameter
from cytodisk.scale_parameters import PixelSizeParameters

Method: TypeAlias = Literal["newton", "newton-triangles", "harmonic", "advection"]
Align: TypeAlias = Literal["upright"] | tuple[float, float] | float

NEWTON_METHODS: tuple[Method, ...] = ("newton", "newton-triangles")
"""Methods that relax by Newton's method, so that a movie's frames can start from the frame before."""

MAPS_VERSION = 2
"""Of what the methods give. In version 1, "newton" gave what "newton-triangles" gives now."""


class MethodParameters(Parameters):
    """How a cell is mapped."""

    method: Method = parameter(
        "newton",
        '"newton": windows of equal area, as nearly as the edge allows. "newton-triangles": the same of an '
        "earlier version; areas are a little more equal, but a slightly other mask of the same cell moves "
        'places more. "harmonic": the paper\'s map before relaxation; it keeps angles and shrinks '
        'protrusions. "advection": the paper\'s relaxation, for comparison; it can turn triangles over, and '
        "the certificate says which.",
    )


class MeshParameters(Parameters):
    """How a cell is meshed, relaxed and turned, whatever the method."""

    shape_weight: float = parameter(
        0.003,
        'For methods "newton" and "newton-triangles": how much shape counts against area. Near 0 windows '
        "have equal areas; larger values keep shapes.",
        above=0,
    )
    edge_length: float = parameter(
        0.7,
        'Distance between mesh vertices at the edge of the cell; with method "advection" everywhere.',
        least=0.25,
        most=10,
        unit="px",
    )
    align: Align = parameter(
        "upright",
        'How the disk is turned. "upright": the disk looks like the cell. A point (row, column), such as '
        "30,40: the part of the edge nearest to it is at angle 0. A number: the upright disk turned by so "
        "many degrees from +u towards +v.",
        words="'upright', a point (row, column) or an angle in degrees",
    )


class MappingParameters(MeshParameters, MethodParameters):
    """How a cell is mapped onto the disk."""


class MapToDiskParameters(MappingParameters, PixelSizeParameters):
    """What `map_to_disk` takes."""
