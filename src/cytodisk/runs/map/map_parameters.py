"""Parameters of `cytodisk map`."""

from typing import ClassVar, Literal

from cytodisk.disk.mapping_parameters import MethodParameters
from cytodisk.disk.nucleus.nucleus_parameters import NucleusParameters
from cytodisk.images.nuclei.nuclei_parameters import NucleiFileParameters
from cytodisk.parameters import Parameters, parameter
from cytodisk.runs.cells.cell_parameters import CellParameters
from cytodisk.windows.grid_parameters import PolarGridParameters


class WindowsOfMapsParameters(
    PolarGridParameters, MethodParameters, NucleusParameters, NucleiFileParameters, CellParameters
):
    """How cells are mapped and divided, one by one or in movies."""

    exclusive: ClassVar[tuple[tuple[str, str], ...]] = PolarGridParameters.exclusive


class PlainCellParameters(Parameters):
    """What is done with cells without a nucleus."""

    missing: Literal["refuse", "plain"] = parameter(
        "refuse",
        'Cells without a nucleus, where nuclei are given: "refuse" them, or map them without, as "plain" '
        "cells, whose layers do not go with those of the others.",
    )


class MapParameters(WindowsOfMapsParameters, PlainCellParameters):
    """What decides the result of `cytodisk map`, beside the input files."""

    exclusive: ClassVar[tuple[tuple[str, str], ...]] = WindowsOfMapsParameters.exclusive
