"""Parameters of movies of cells with their nuclei."""

from typing import Literal, TypeAlias

from cytodisk.disk.nucleus.nucleus_parameters import NucleusParameters
from cytodisk.parameters import Parameters, parameter

MissingNucleus: TypeAlias = Literal["refuse", "hold"]


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
