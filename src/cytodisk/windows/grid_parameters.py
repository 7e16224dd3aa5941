"""Parameters of grids of windows, and of sampling in them."""

from itertools import pairwise
from typing import Any, ClassVar, Literal, Self, TypeAlias

from pydantic import field_validator, model_validator

from cytodisk.checks import is_number
from cytodisk.disk.sector_parameters import MOST, SectorParameters
from cytodisk.geometry.mask_parameters import HoleParameters
from cytodisk.parameters import Parameters, parameter

Spacing: TypeAlias = Literal["area", "radius"]
NanRule: TypeAlias = Literal["propagate", "omit"]

_DEEPEST_UM = 1e6
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


class PolarGridParameters(GridParameters):
    """How the disk is divided into windows, by shares of the disk or by depth."""

    exclusive: ClassVar[tuple[tuple[str, str], ...]] = (("layers", "depth_um"), ("spacing", "depth_um"))

    depth_um: tuple[float, ...] | None = parameter(
        None,
        "Depths of the borders between layers below the cell's edge, in place of a number of layers: in each "
        "cell and frame the circles of the disk with that median depth. What lies deeper is one more layer, "
        "with a nucleus the cytoplasm around it. Needs the pixel size.",
        unit="µm",
        words="a depth above 0 or several that increase, such as 0.5,1,2",
    )
    nucleus_layers: int | None = parameter(
        None,
        "Number of layers in the nucleus, which follow those of the cytoplasm. Needs a nucleus in each cell. "
        "Where files of nuclei are given, 3 without it.",
        least=1,
        most=MOST,
    )

    @field_validator("depth_um", mode="before")
    @classmethod
    def _several(cls, depth_um: Any) -> Any:
        if isinstance(depth_um, str):
            raise ValueError("must be a list of numbers, such as [0.5, 1, 2]")
        if isinstance(depth_um, tuple | list) and any(isinstance(depth, bool) for depth in depth_um):
            raise ValueError("must be numbers")
        return (depth_um,) if is_number(depth_um) else depth_um

    @field_validator("depth_um")
    @classmethod
    def _increasing(cls, depth_um: tuple[float, ...] | None) -> tuple[float, ...] | None:
        if depth_um is None:
            return None
        borders = (0.0, *depth_um)
        if (
            not depth_um
            or len(depth_um) >= MOST
            or any(a >= b for a, b in pairwise(borders))
            or depth_um[-1] > _DEEPEST_UM
        ):
            raise ValueError("must be a depth above 0 or several that increase, such as 0.5,1,2")
        return depth_um

    @property
    def cell_layers(self) -> int:
        """Number of layers between the cell's edge and its nucleus, or its centre."""
        return self.layers if self.depth_um is None else len(self.depth_um) + 1

    @model_validator(mode="after")
    def _not_too_many_with_nucleus(self) -> Self:
        nucleus = self.nucleus_layers or 0
        if (self.cell_layers + nucleus) * self.sectors > _MOST_WINDOWS:
            given = f"({self.cell_layers} + {nucleus}) × {self.sectors}"
            raise ValueError(
                f"(layers + nucleus_layers) × sectors must be at most {_MOST_WINDOWS}, got {given}"
            )
        return self


class EdgeGridParameters(CountParameters):
    """How a cell is divided by distance from its edge."""

    depth_px: float | None = parameter(
        None,
        "Thickness of a layer by distance from the edge; without it the greatest depth of the cell divided "
        "by the number of layers.",
        above=0,
        unit="px",
    )


class EdgeWindowParameters(HoleParameters, EdgeGridParameters):
    """What `edge_windows` takes."""


class RingGridParameters(CountParameters):
    """How a cell is divided into rings and wedges around its deepest point."""

    sectors: int = parameter(8, "Number of wedges around the deepest point.", least=1, most=MOST)


class RingWindowParameters(HoleParameters, RingGridParameters):
    """What `ring_windows` takes."""


class SampleParameters(Parameters):
    """How a signal is measured in windows."""

    nan: NanRule = parameter(
        "propagate",
        'Windows with pixels that are NaN, infinite or masked: "propagate" makes the window NaN, "omit" '
        "leaves these pixels out.",
    )
