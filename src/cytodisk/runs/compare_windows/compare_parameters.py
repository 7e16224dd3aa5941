"""Parameters of a comparison of windows, and the methods it knows."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Self, TypeAlias, TypeVar, get_args

from pydantic import field_validator

from cytodisk.disk.mapping_parameters import MeshParameters
from cytodisk.disk.nucleus.nucleus_parameters import NucleusParameters
from cytodisk.errors import CytodiskError, ParameterError
from cytodisk.images.file_parameters import KindParameters
from cytodisk.images.nuclei.nuclei_parameters import NucleiFileParameters
from cytodisk.parameters import parameter
from cytodisk.runs.movie.movie_parameters import FollowedCellParameters
from cytodisk.scale import Scale
from cytodisk.scale_parameters import PixelSizeParameters
from cytodisk.windows.grid_parameters import GridParameters
from cytodisk.windows.rings.nucleus_ring_parameters import InterpolatedRingParameters
from cytodisk.windows.springs.spring_parameters import LineTensionParameters, SpringGridParameters

WindowMethod: TypeAlias = Literal[
    "newton", "newton-triangles", "harmonic", "advection", "edge", "springs", "rings"
]
MovieMethod: TypeAlias = Literal[
    "newton", "newton-triangles", "harmonic", "advection", "edge", "springs", "registered", "rings"
]
NucleusMethod: TypeAlias = Literal["newton", "nucleus-rings", "interpolated-rings"]

Method = TypeVar("Method", bound=str)

OURS = "newton"
ON_A_MAP = ("newton", "newton-triangles", "harmonic", "advection")
TITLES = {
    "newton": "cytodisk (default)",
    "newton-triangles": "cytodisk, areas by triangle",
    "harmonic": "harmonic map",
    "advection": "u-Unwrap's relaxation",
    "edge": "edge-based",
    "springs": "edge-based with springs",
    "registered": "registered to the first frame",
    "rings": "rings and wedges",
    "nucleus-rings": "rings by distance",
    "interpolated-rings": "interpolated rings",
}
"""Names of the methods in figures and on the console."""

_METHODS = (
    "Kinds of windows that are compared: on cytodisk's map (newton), with areas by triangle "
    "(newton-triangles), on the map before relaxation (harmonic), on the paper's map (advection), by "
    "distance from the edge (edge), the same evened out by springs (springs), around the deepest point "
    "(rings)."
)
_MOVIE_METHODS = (
    f"{_METHODS.removesuffix('.')}, or those of the first frame carried to each frame by a nonrigid "
    "registration of the masks (registered; needs SimpleITK)."
)
_WORDS = f"several of {', '.join(get_args(WindowMethod))}"
_MOVIE_WORDS = f"several of {', '.join(get_args(MovieMethod))}"
_NUCLEUS_METHODS = (
    "Kinds of windows that are compared: on cytodisk's map of cell and nucleus (newton), rings by the share "
    "of the way from the edge to the nucleus (nucleus-rings), rings interpolated between both outlines "
    "(interpolated-rings)."
)


def once_each(methods: tuple[Method, ...]) -> tuple[Method, ...]:
    """The methods, if there is one, and none is named twice; or else ValueError."""
    if not methods or len(set(methods)) < len(methods):
        raise ValueError("name at least one method, and each once")
    return methods


class ComparedParameters(SpringGridParameters):
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
    def _once_each(cls, methods: tuple[MovieMethod, ...]) -> tuple[MovieMethod, ...]:
        return once_each(methods)

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

    @field_validator("methods", mode="before")
    @classmethod
    def _of_single_cells(cls, methods: Any) -> Any:
        if isinstance(methods, tuple | list) and "registered" in methods:
            raise ValueError(
                'may name "registered" for movies only, whose frames are registered to the first one: pass '
                "movie (--movie) too, or leave it out"
            )
        return methods


class CompareMovieParameters(ComparedParameters, LineTensionParameters, FollowedCellParameters):
    """What decides the result of `cytodisk compare-windows --movie`, beside the input files."""

    methods: tuple[MovieMethod, ...] = parameter(
        ("newton", "harmonic", "edge"), _MOVIE_METHODS, words=_MOVIE_WORDS
    )


class CompareNucleiParameters(
    InterpolatedRingParameters,
    NucleusParameters,
    MeshParameters,
    PixelSizeParameters,
    NucleiFileParameters,
    KindParameters,
):
    """What decides the result of `cytodisk compare-windows --nuclei`, beside the input files."""

    fault: ClassVar[type[CytodiskError]] = ParameterError

    methods: tuple[NucleusMethod, ...] = parameter(
        get_args(NucleusMethod), _NUCLEUS_METHODS, words=f"several of {', '.join(get_args(NucleusMethod))}"
    )

    @field_validator("methods")
    @classmethod
    def _once_each(cls, methods: tuple[NucleusMethod, ...]) -> tuple[NucleusMethod, ...]:
        return once_each(methods)
