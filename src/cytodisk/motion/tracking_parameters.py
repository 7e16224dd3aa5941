"""Parameters of `map_movie`."""

from typing import Literal, TypeAlias

from cytodisk.disk.mapping_parameters import MappingParameters, MeshParameters
from cytodisk.disk.nucleus.nucleus_parameters import NucleusParameters
from cytodisk.motion.demons_parameters import DemonsParameters
from cytodisk.parameters import Parameters, parameter
from cytodisk.scale_parameters import ScaleParameters

Tracker: TypeAlias = Literal["matching", "demons"]
Interior: TypeAlias = Literal["area", "still"]
MissingNucleus: TypeAlias = Literal["refuse", "hold"]

SMOOTHNESS_PX2 = 64.0


class TrackingParameters(Parameters):
    """How the edge of a cell is followed from frame to frame."""

    tracker: Tracker = parameter(
        "matching",
        '"matching": elastic matching of the outlines, which keeps the order of points. "demons": the '
        "paper's tracker.",
    )
    tension: float = parameter(
        0.01,
        'For tracker "matching": 0 keeps each boundary point on the same piece of membrane, 1 spreads the '
        "points evenly in each frame.",
        least=0,
        most=1,
    )
    smoothness_px2: float = parameter(
        SMOOTHNESS_PX2,
        'For tracker "matching": how much neighbouring boundary points move alike.',
        above=0,
        most=1_000_000,
        unit="px²",
    )
    registration: bool = parameter(True, "Take out rigid motion of the cell before tracking.")
    renew_every: int = parameter(
        5,
        "Number of frames after which the registration takes a new reference frame.",
        least=1,
        most=1_000_000,
        unit="frames",
    )


class TrackingSettings(TrackingParameters):
    """How the edge of a cell is followed, with the paper's tracker in detail."""

    demons: DemonsParameters | None = parameter(
        None, 'Details of tracker "demons"; without them they are the paper\'s.', words="DemonsParameters"
    )


class FollowingParameters(TrackingParameters, MeshParameters):
    """How a cell is followed and mapped through time, whatever the method of the map."""

    inertia: float = parameter(
        1.0,
        "How much the inside of a frame stays where the frame before had it, against equal areas.",
        least=0,
        most=1_000_000,
    )


class InteriorParameters(Parameters):
    """What the inside of a cell does while its edge moves."""

    interior: Interior = parameter(
        "area",
        'What is assumed of the inside, methods "newton" and "newton-triangles". "area": each place keeps '
        'its share of the area on the way from the edge to the centre. "still": it keeps its place in the '
        "lab; only near the edge it moves with the edge.",
    )
    fade_um: float | None = parameter(
        None,
        'For interior "still": depth over which the motion of the edge fades, at least a pixel; without it '
        "4 px.",
        above=0,
        most=1_000_000,
        unit="µm",
    )


class HeldNucleusParameters(Parameters):
    """What is done in frames without a nucleus."""

    missing: MissingNucleus = parameter(
        "refuse",
        'Frames in which the cell has no nucleus that can be used, where nuclei are given: "refuse" them, so '
        'that they are gaps with a reason; or "hold" the nucleus of the frame before, moved as the cell '
        "moved; the frame says so.",
    )


class MovieNucleusParameters(NucleusParameters, HeldNucleusParameters):
    """How the nucleus of a moving cell is mapped with it."""


class MovieMappingParameters(
    FollowingParameters, InteriorParameters, MovieNucleusParameters, MappingParameters
):
    """How the frames of a movie are mapped."""


class MovieSettings(MovieMappingParameters, TrackingSettings):
    """How the frames of a movie are mapped, with the paper's tracker in detail."""


class MovieMapParameters(MovieSettings, ScaleParameters):
    """What `map_movie` takes."""
