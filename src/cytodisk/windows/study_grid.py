"""The grids of windows of a study."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from cytodisk.checks import is_number
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.grid_parameters import PolarGridParameters
from cytodisk.windows.polar_windows import PolarGrid, polar_windows


def polar_grid_of(provenance: Mapping[str, Any]) -> PolarGrid:
    """The grid of a study, from its provenance.

    In movies of earlier versions `depth_um` is one number, the wanted thickness of the first layer; their
    provenance says how many layers that gave. Where all cells have one `nucleus_radius`, the grid has it.
    """
    parameters = provenance["parameters"]
    known = {name: parameters.get(name) for name in PolarGridParameters.model_fields}
    if is_number(known["depth_um"]):
        known |= {"depth_um": None, "layers": provenance["layers"]}
    left_out = ("depth_um",) if known["depth_um"] is None else ("layers", "spacing")
    given = {name: value for name, value in known.items() if value is not None and name not in left_out}
    grid, radius = polar_windows(**given), parameters.get("nucleus_radius")
    return replace(grid, nucleus_radius=radius) if grid.nucleus_layers and is_number(radius) else grid


@dataclass(frozen=True)
class StudyGrids:
    """Grids of a study: cells that were mapped without a nucleus where others have one have their own.

    Attributes
    ----------
    provenance : mapping
    """

    provenance: Mapping[str, Any]

    @cached_property
    def usual(self) -> PolarGrid:
        """That of the study; layers by depth have radii in each cell alone."""
        return polar_grid_of(self.provenance)

    @cached_property
    def without_nucleus(self) -> PolarGrid:
        """That of cells without a nucleus."""
        parameters = self.provenance["parameters"] | {"nucleus_layers": None}
        return polar_grid_of({**self.provenance, "parameters": parameters})

    def of(self, disk: DiskMap) -> PolarGrid:
        """The grid of a cell."""
        without = disk.nucleus is None and self.usual.nucleus_layers
        return self.without_nucleus if without else self.usual
