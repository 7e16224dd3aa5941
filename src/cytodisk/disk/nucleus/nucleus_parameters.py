"""Parameters of maps with a nucleus."""

from typing import Any, Literal, TypeAlias

from pydantic import field_validator

from cytodisk.checks import is_number
from cytodisk.geometry.nucleus_report import SeveralPolicy
from cytodisk.parameters import Parameters, parameter

NucleusRadius: TypeAlias = float | Literal["area"]

LEAST_RADIUS, MOST_RADIUS = 0.05, 0.95


class SeveralParameters(Parameters):
    """What is done with cells with several nuclei."""

    several: SeveralPolicy = parameter(
        "refuse",
        'Cells with several nuclei: "refuse" them, map them with the "largest", or "join" their nuclei along '
        "the shortest way inside the cell. A piece of less than a tenth of the largest is no nucleus.",
    )


class NucleusParameters(SeveralParameters):
    """How a nucleus is mapped with its cell."""

    nucleus_radius: NucleusRadius = parameter(
        0.5,
        "Where a nucleus is given, the radius of its circle in the disk, the same for all cells, so that "
        'windows can be compared between them. "area": in each cell the radius that gives the nucleus its '
        "own share of the area.",
        words=f"'area' or a number from {LEAST_RADIUS} to {MOST_RADIUS}",
    )

    @field_validator("nucleus_radius", mode="before")
    @classmethod
    def _in_range(cls, radius: Any) -> Any:
        if radius == "area" or (is_number(radius) and LEAST_RADIUS <= radius <= MOST_RADIUS):
            return radius
        raise ValueError(f"must be 'area' or a number from {LEAST_RADIUS} to {MOST_RADIUS}")
