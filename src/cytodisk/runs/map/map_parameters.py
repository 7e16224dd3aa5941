"""Parameters of `cytodisk map`."""

from typing import ClassVar

from cytodisk.disk.mapping_parameters import MethodParameters
from cytodisk.runs.cells.cell_parameters import CellParameters
from cytodisk.windows.grid_parameters import PolarGridParameters


class MapParameters(PolarGridParameters, MethodParameters, CellParameters):
    """What decides the result of `cytodisk map`, beside the input files."""

    exclusive: ClassVar[tuple[tuple[str, str], ...]] = PolarGridParameters.exclusive
