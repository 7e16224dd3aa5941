"""Parameters of `cytodisk map`."""

from typing import ClassVar

from cytodisk.disk.mapping_parameters import MethodParameters
from cytodisk.disk.nucleus.nucleus_parameters import NucleusParameters
from cytodisk.images.nuclei.nuclei_parameters import NucleiFileParameters
from cytodisk.runs.cells.cell_parameters import CellParameters, PlainCellParameters
from cytodisk.windows.grid_parameters import PolarGridParameters


class WindowsOfMapsParameters(
    PolarGridParameters, MethodParameters, NucleusParameters, NucleiFileParameters, CellParameters
):
    """How cells are mapped and divided, one by one or in movies."""

    exclusive: ClassVar[tuple[tuple[str, str], ...]] = PolarGridParameters.exclusive


class MapParameters(WindowsOfMapsParameters, PlainCellParameters):
    """What decides the result of `cytodisk map`, beside the input files."""

    exclusive: ClassVar[tuple[tuple[str, str], ...]] = WindowsOfMapsParameters.exclusive
