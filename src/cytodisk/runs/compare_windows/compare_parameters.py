"""Parameters of a comparison of windows, and the methods it knows."""

from __future__ import annotations

from typing import ClassVar, Literal, Self, TypeAlias

from pydantic import field_validator

from cytodisk.disk.mapping_parameters import MeshParameters
from cytodisk.errors import CytodiskError, ParameterError
from cytodisk.images.file_parameters import KindParameters
from cytodisk.parameters import parameter
from cytodisk.runs.movie.movie_parameters import FollowedCellParameters
from cytodisk.scale import Scale
from cytodisk.scale_parameters import PixelSizeParameters
from cytodisk.windows.grid_parameters import EdgeGridParameters, GridParameters

WindowMethod: TypeAlias = Literal["newton", "newton-triangles", "harmonic", "advection", "edge", "rings"]

OURS = "newton"
ON_A_MAP = ("newton", "newton-triangles", "harmonic", "advection")
TITLES = {
    "newton": "cytodisk (default)",
    "newton-triangles": "cytodisk, areas by triangle",
    "harmonic": "harmonic map",
    "advection": "u-Unwrap's relaxation",
    "edge": "edge-based",
    "rings": "rings and wedges",
}
"""Names of the methods in figures and on the console."""

_METHODS = (
    "Kinds of windows that are compared: on cytodisk's map (newton), with areas by triangle "
    "(newton-triangles), on the map before relaxation (harmonic), on the paper's map (advection), by "
    "distance from the edge (edge), around the deepest point (rings)."
)
_WORDS = f"several of {', '.join(TITLES)}"


class ComparedParameters(EdgeGridParameters):
    """What comparisons of cells and of movies share."""

    fault: ClassVar[type[CytodiskError]] = ParameterError

    exclusive: ClassVar[tuple[tuple[str, str], ...]] = (("depth_px", "depth_um"),)

    depth_um: float | None = parameter(
        None,
        "Thickness of a layer by distance from the edge, in place of one in pixels; needs the pixel size.",
        above=0,
        most=1_000_000,
        unit="µm",
    )

    @field_validator("methods", check_fields=False)
    @classmethod
    def _once_each(cls, methods: tuple[WindowMethod, ...]) -> tuple[WindowMethod, ...]:
        if not methods or len(set(methods)) < len(methods):
            raise ValueError("name at least one method, and each once")
        return methods

    def in_pixels(self, scale: Scale) -> Self:
        """The same with `depth_px` for a `depth_um`.

        Raises
        ------
        ParameterError
            There is a depth in µm, and no pixel size.
        """
        if self.depth_um is None:
            return self
        if scale.pixel_size_um is None:
            raise ParameterError("depth_um needs a pixel size: pass it as --pixel-size, or pass --depth-px")
        return self.changed(depth_px=self.depth_um / scale.pixel_size_um, depth_um=None)


class CompareWindowsParameters(
    ComparedParameters, MeshParameters, GridParameters, PixelSizeParameters, KindParameters
):
    """What decides the result of `cytodisk compare-windows`, beside the input files."""

    methods: tuple[WindowMethod, ...] = parameter(
        ("newton", "harmonic", "advection", "edge"), _METHODS, words=_WORDS
    )


class CompareMovieParameters(ComparedParameters, FollowedCellParameters):
    """What decides the result of `cytodisk compare-windows --movie`, beside the input files."""

    methods: tuple[WindowMethod, ...] = parameter(("newton", "harmonic", "edge"), _METHODS, words=_WORDS)
