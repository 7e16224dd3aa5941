"""Into how many sectors the disk is divided."""

from typing import ClassVar

from cytodisk.errors import CytodiskError, WindowError
from cytodisk.parameters import Parameters, parameter

SECTORS = 60
MOST = 100_000  # layers or sectors: beyond any image, and still within memory


class SectorParameters(Parameters):
    """How many sectors there are."""

    fault: ClassVar[type[CytodiskError]] = WindowError

    sectors: int = parameter(SECTORS, "Number of sectors around the cell.", least=1, most=MOST)
