"""Parameters of `map_to_disk`."""

from typing import Literal, TypeAlias

from cytodisk.disk.nucleus.nucleus_parameters import NucleusParameters
from cytodisk.geometry.mask_parameters import HoleParameters
from cytodisk.parameters import Parameters, parameter
from cytodisk.scale_parameters import PixelSizeParameters

Method: TypeAlias = Literal["newton", "newton-triangles", "harmonic", "advection"]
Align: TypeAlias = Literal["upright", "nucleus"] | tuple[float, float] | float

NEWTON_METHODS: tuple[Method, ...] = ("newton", "newton-triangles")
"""Methods that relax by Newton's method, so that a movie's frames can start from the frame before."""

MAPS_VERSION = 2
"""Of what the methods give. In version 1, "newton" relaxed as "newton-triangles" does now; all methods had
another mesh and other lengths along the edge.
"""

EDGE_LENGTH_PX, ADVECTION_EDGE_LENGTH_PX = 0.7, 0.9


class MethodParameters(Parameters):
    """How a cell is mapped."""

    method: Method = parameter(
        "newton",
        '"newton": windows of equal area, as nearly as the edge allows. "newton-triangles": the same with an '
        "area for each triangle; areas are a little more equal, but a slightly other mask of the same cell "
        'moves places more. "harmonic": the paper\'s map before relaxation; it keeps angles and shrinks '
        'protrusions. "advection": the paper\'s relaxation, for comparison; it can turn triangles over, and '
        "the certificate says which.",
    )


class MeshParameters(HoleParameters):
    """How a cell is meshed, relaxed and turned, whatever the method."""

    shape_weight: float = parameter(
        0.003,
        'For methods "newton" and "newton-triangles": how much shape counts against area. Near 0 windows '
        "have equal areas; larger values keep shapes.",
        above=0,
        most=1_000_000,
    )
    edge_length: float | None = parameter(
        None,
        'Distance between mesh vertices at the edge of the cell; with method "advection" everywhere. By '
        f'default {EDGE_LENGTH_PX}, with "advection" {ADVECTION_EDGE_LENGTH_PX}: fewer triangles turn over.',
        least=0.25,
        most=10,
        unit="px",
    )
    align: Align = parameter(
        "upright",
        'How the disk is turned. "upright": the disk looks like the cell. "nucleus": the direction from the '
        "centroid of the nucleus to that of the cell is at angle 0. A point (row, column), such as "
        "30,40: the part of the edge nearest to it is at angle 0. A number: the upright disk turned by so "
        "many degrees from +u towards +v.",
        words="'upright', 'nucleus', a point (row, column) or an angle in degrees",
    )


class MappingParameters(MeshParameters, MethodParameters):
    """How a cell is mapped onto the disk."""

    @property
    def spacing_px(self) -> float:
        """Distance between mesh vertices at the edge, as given or by method."""
        if self.edge_length is not None:
            return self.edge_length
        return ADVECTION_EDGE_LENGTH_PX if self.method == "advection" else EDGE_LENGTH_PX


class MapToDiskParameters(NucleusParameters, MappingParameters, PixelSizeParameters):
    """What `map_to_disk` takes."""
