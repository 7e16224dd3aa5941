"""Parameters of `cytodisk population`."""

from typing import Literal, Self, TypeAlias

from pydantic import field_validator, model_validator

from cytodisk.parameters import parameter
from cytodisk.population.comparison_parameters import (
    ComparisonParameters,
    DoseParameters,
    Normalisation,
    Scale,
)
from cytodisk.runs.population.movies.summary_names import MovieSummary

Alignment: TypeAlias = Literal["none", "nucleus", "front", "motion", "axis"]


class PopulationParameters(ComparisonParameters):
    """What decides the result of `cytodisk population`, beside the studies and the table of groups."""

    compare: tuple[str, ...] = parameter(
        (),
        "Conditions to compare, the control first; without it all that are there.",
        words="names of conditions with commas between, the control first",
    )
    channel: tuple[str, ...] = parameter(
        (),
        "Channels to compare; without it all that all studies have. Channels are corrected together.",
        words="names of channels with commas between",
    )
    summary: MovieSummary = parameter(
        "mean",
        "What a cell of a movie contributes: mean, sd, velocity, peak_correlation, lag, around_events, gain, "
        "gain_score or waves; a cell of an image contributes its windows as they are. Conditions are "
        "compared; whether gains or waves are above 0 is tested by cytodisk predict BATCH and waves BATCH.",
    )
    normalise: Normalisation = parameter(
        "none", "What each cell's values are divided by, or relative to, before cells are compared."
    )
    align: Alignment | str = parameter(
        "none",
        "Where sector 0 of each cell begins: on the side away from the nucleus, at the front, in the "
        "direction of motion, of the long axis, or at a channel's brightest side, as signal:CHANNEL.",
        words="none, nucleus, front, motion, axis or signal:CHANNEL",
    )
    scalars: tuple[str, ...] = parameter(
        (),
        "Numbers of the tables of cells to compare beside those of the signal, such as area; without it the "
        "usual ones.",
        words="names of columns with commas between",
    )
    dose: str | None = parameter(
        None,
        "Column with the dose of each cell, a number: then a trend over it is tested and drawn, too, and "
        "conditions that --compare does not name stand in its order.",
    )

    dose_scale: Scale = parameter("rank", str(DoseParameters.model_fields["scale"].description))

    @field_validator("compare", "channel", "scalars", mode="before")
    @classmethod
    def _of_text(cls, names: object) -> object:
        """Names in a text, as on the command line."""
        return tuple(names.split(",")) if isinstance(names, str) else names

    @field_validator("compare", "channel", "scalars")
    @classmethod
    def _different(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        names = tuple(name.strip() for name in names)
        if not all(names) or len(set(names)) < len(names):
            raise ValueError("must be different names")
        return names

    @field_validator("compare")
    @classmethod
    def _at_least_two(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        if len(names) == 1:
            raise ValueError(
                "must name two conditions or more, the control first, with commas and no spaces between "
                "them, such as control,drug"
            )
        return names

    @field_validator("align")
    @classmethod
    def _known(cls, align: str) -> str:
        if align.startswith("signal:") and align != "signal:":
            return align
        if align not in ("none", "nucleus", "front", "motion", "axis"):
            raise ValueError("must be none, nucleus, front, motion, axis or signal:CHANNEL")
        return align

    @model_validator(mode="after")
    def _scale_of_a_dose(self) -> Self:
        if self.dose is None and self.dose_scale != "rank":
            raise ValueError(
                f"dose_scale is {self.dose_scale!r}, and no dose is named: pass --dose COLUMN (dose=), too"
            )
        return self
