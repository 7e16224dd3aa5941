"""Parameters of `cytodisk movie`."""

from typing import ClassVar

from cytodisk.images.file_parameters import MovieKindParameters
from cytodisk.motion.tracking_parameters import FollowingParameters, HeldNucleusParameters, InteriorParameters
from cytodisk.runs.cells.cell_parameters import CellParameters
from cytodisk.runs.map.map_parameters import WindowsOfMapsParameters
from cytodisk.scale_parameters import ScaleParameters


class FollowedCellParameters(MovieKindParameters, FollowingParameters, ScaleParameters, CellParameters):
    """What all runs over movies have, whatever the method of the map."""


class MovieParameters(
    FollowedCellParameters, InteriorParameters, HeldNucleusParameters, WindowsOfMapsParameters
):
    """What decides the result of `cytodisk movie`, beside the input files."""

    exclusive: ClassVar[tuple[tuple[str, str], ...]] = WindowsOfMapsParameters.exclusive
