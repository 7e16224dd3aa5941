"""Parameters of images of simulated populations."""

import re
from typing import Self

from pydantic import field_validator, model_validator

from cytodisk.parameters import parameter
from cytodisk.simulate.populations.simulated_population_parameters import DesignParameters


class PopulationImageParameters(DesignParameters):
    """How images of a population are made: one image for each condition in each experiment."""

    experiments: int | tuple[int, ...] = parameter(
        3,
        "Experiments of each condition, one number for all or one for each; for `paired` in all.",
        words="a whole number of at least 1, or one for each condition",
    )
    cells: int = parameter(4, "Cells in each image, on average.", least=1, most=1000)
    channels: tuple[str, ...] = parameter(
        ("Rac1", "RhoA"),
        "Names of the channels; the region is raised in the first one.",
        words="one or more different names",
    )
    effect: float | tuple[float, ...] = parameter(
        0.5,
        "Share by which the region is brighter than the cell: one number for all conditions but the first, "
        "or one for each.",
        words="a number, or one for each condition",
    )
    nuclei: bool = parameter(
        False,
        "Whether cells have nuclei, out of the middle; then the region lies on the side away from "
        "the nucleus.",
    )
    arms: float = parameter(0.4, "Share of the cells that have arms; the others are round.", least=0, most=1)
    radius_px: float = parameter(18.0, "Radius of a round cell.", least=12, most=200, unit="px")
    deviation: float = parameter(
        0.15, "Standard deviation of the logarithm of a cell's brightness.", least=0, most=2
    )
    between_experiments: float = parameter(
        0.1, "Share of the variance of brightness that the cells of one experiment share.", least=0, most=1
    )
    pixel_size_um: float = parameter(0.3, "Side of a pixel, stored with the images.", above=0, unit="µm")

    @field_validator("conditions")
    @classmethod
    def _file_names(cls, conditions: tuple[str, ...]) -> tuple[str, ...]:
        if not all(re.fullmatch(r"\w[\w .+-]*", name) for name in conditions):
            raise ValueError("must be names that files can have, of letters, digits, spaces and _ . + -")
        return conditions

    @field_validator("channels")
    @classmethod
    def _names(cls, channels: tuple[str, ...]) -> tuple[str, ...]:
        if not channels or len(set(channels)) < len(channels) or not all(channels):
            raise ValueError("must be one or more different names")
        return channels

    @model_validator(mode="after")
    def _one_for_each(self) -> Self:
        effects = (self.effect,) if isinstance(self.effect, float) else self.effect
        if not isinstance(self.effect, float) and len(effects) != len(self.conditions):
            raise ValueError(
                f"effect must be one number or one for each of the {len(self.conditions)} conditions, got "
                f"{len(effects)}"
            )
        if min(effects) < -1.0:
            raise ValueError(f"effect must be at least -1, which leaves nothing, got {min(effects):g}")
        return self

    @property
    def effect_of(self) -> tuple[float, ...]:
        """Effect on each condition."""
        if isinstance(self.effect, float):
            return (0.0, *(self.effect,) * (len(self.conditions) - 1))
        return self.effect
