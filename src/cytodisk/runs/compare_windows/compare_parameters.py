"""Parameters of a comparison of windows, and the methods it knows."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BaseModel, Field, field_validator

from cytodisk.runs.parameters import MapParameters, MovieParameters

WindowMethod: TypeAlias = Literal["newton", "harmonic", "advection", "edge", "rings"]

OURS = "newton"
ON_A_MAP = ("newton", "harmonic", "advection")
TITLES = {
    "newton": "cytodisk (default)",
    "harmonic": "harmonic map",
    "advection": "u-Unwrap's relaxation",
    "edge": "edge-based",
    "rings": "rings and wedges",
}
"""Names of the methods in figures and on the console."""


class _Compared(BaseModel):
    methods: tuple[WindowMethod, ...] = ()
    depth_px: Annotated[float, Field(gt=0)] | None = None
    method: Any = Field(default="newton", exclude=True)

    @field_validator("method")
    @classmethod
    def _in_the_plural(cls, method: Any) -> Any:
        raise ValueError("a comparison has several: pass methods")

    @field_validator("methods")
    @classmethod
    def _once_each(cls, methods: tuple[WindowMethod, ...]) -> tuple[WindowMethod, ...]:
        if not methods or len(set(methods)) < len(methods):
            raise ValueError("name at least one method, and each once")
        return methods


class CompareParameters(_Compared, MapParameters):
    """What decides the result of `cytodisk compare`, beside the input files.

    `methods`: "newton", "harmonic" and "advection" are polar windows on the disk map of this name, see
    `map_to_disk`; "edge" see `edge_windows`, "rings" see `ring_windows`. `depth_px` is the thickness of a
    layer of edge-based windows; by default a cell's greatest depth over the layers. The others are those of
    `cytodisk map`.
    """

    methods: tuple[WindowMethod, ...] = ("newton", "harmonic", "advection", "edge")


class CompareMovieParameters(_Compared, MovieParameters):
    """What decides the result of `cytodisk compare --movie`, beside the input files.

    As `CompareParameters`; by default `depth_px` is the greatest depth of a cell's first frame over the
    layers. The others are those of `cytodisk movie`.
    """

    methods: tuple[WindowMethod, ...] = ("newton", "harmonic", "edge")
    depth_um: Any = Field(default=None, exclude=True)

    @field_validator("depth_um")
    @classmethod
    def _of_a_movie(cls, depth_um: Any) -> Any:
        raise ValueError("a comparison has the same number of layers for all: pass layers, and depth_px")
