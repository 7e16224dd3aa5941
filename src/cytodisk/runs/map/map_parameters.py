"""Parameters of `cytodisk map`."""

from cytodisk.disk.mapping_parameters import MethodParameters
from cytodisk.runs.cells.cell_parameters import CellParameters


class MapParameters(MethodParameters, CellParameters):
    """What decides the result of `cytodisk map`, beside the input files."""
