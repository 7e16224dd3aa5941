"""Parameters of grids of windows, and of sampling in them."""

from typing import Literal, Self, TypeAlias

from pydantic import model_validator

from cytodisk.disk.sector_parameters import MOST, SectorParameters
from cytodisk.parameters import Parameters, parameter

Spacing: TypeAlias = Literal["area", "radius"]
NanRule: TypeAlias = Literal["propagate", "omit"]

_MOST_WINDOWS = 10_000_000  # beyond any image, and still within memory


class LayerParameters(Parameters):
    """How many layers there are."""

    layers: int = parameter(10, "Number of layers; layer 0 is at the edge of the cell.", least=1, most=MOST)


class CountParameters(SectorParameters, LayerParameters):
    """How many windows there are."""

    @model_validator(mode="after")
    def _not_too_many(self) -> Self:
        if self.layers * self.sectors > _MOST_WINDOWS:
            given = f"{self.layers} × {self.sectors}"
            raise ValueError(f"layers × sectors must be at most {_MOST_WINDOWS}, got {given}")
        return self


class GridParameters(CountParameters):
    """How the disk is divided into windows."""

    spacing: Spacing = parameter(
        "area",
        '"area": all windows have the same area of disk, so nearly the same area of cell. "radius": layers '
        "of equal width on the disk, as in the paper.",
    )


class EdgeGridParameters(CountParameters):
    """How a cell is divided by distance from its edge."""

    depth_px: float | None = parameter(
        None,
        "Thickness of a layer by distance from the edge; without it the greatest depth of the cell divided "
        "by the number of layers.",
        above=0,
        unit="px",
    )


class RingGridParameters(CountParameters):
    """How a cell is divided into rings and wedges around its deepest point."""

    sectors: int = parameter(8, "Number of wedges around the deepest point.", least=1, most=MOST)


class SampleParameters(Parameters):
    """How a signal is measured in windows."""

    nan: NanRule = parameter(
        "propagate",
        'Windows with pixels that are NaN, infinite or masked: "propagate" makes the window NaN, "omit" '
        "leaves these pixels out.",
    )
