"""Parameters of simulated series that predict each other."""

from typing import Annotated, Literal, Self, get_args

from pydantic import Field, field_validator, model_validator

from cytodisk.parameters import parameter
from cytodisk.simulate.series_parameters import NeighbourParameters

Coupling = Literal["one way", "both ways", "none", "common driver"]
COUPLINGS: tuple[Coupling, ...] = get_args(Coupling)


class WhoPredictsParameters(NeighbourParameters):
    """Who predicts whom, and how well."""

    coupling: Coupling = parameter(
        "one way",
        '"one way": the source predicts the target, not the other way round. "both ways": each predicts the '
        'other. "none". "common driver": a third series predicts both, the target a frame later.',
    )
    strength: Annotated[float, Field(gt=-1, lt=1)] = parameter(
        0.3,
        "Partial correlation between the target and what the source's innovations of the given lags say of "
        "it, given the target's own past; negative: more source, less target.",
    )
    lags: tuple[int, ...] = parameter(
        (1, 2, 3),
        "Lags at which the source's innovations reach the target, each with the same weight.",
        words="whole numbers from 1 to 100, such as 1,2,3",
        unit="frames",
    )
    at_once: Annotated[float, Field(gt=-1, lt=1)] = parameter(
        0.0,
        "Correlation between the innovations of source and target in the same frame, which predicts nothing.",
    )

    @field_validator("lags")
    @classmethod
    def _later(cls, lags: tuple[int, ...]) -> tuple[int, ...]:
        if not lags or len(set(lags)) < len(lags) or min(lags) < 1 or max(lags) > 100:
            raise ValueError(f"lags must be different whole numbers from 1 to 100, got {lags}")
        return lags


class PredictingParameters(WhoPredictsParameters):
    """Who predicts whom, how well, and what was measured of it."""

    layered: bool = parameter(
        False,
        "The target has layers too, and each is coupled with the source of its layer. Else the target is by "
        "sector alone, as an edge's velocity is, and coupled with the source of one layer.",
    )
    layer: int = parameter(0, "Layer of the source that is coupled with a target without layers.", least=0)
    source_noise: float = parameter(
        0.0,
        "Standard deviation of the noise with which the source is measured, over that of the source; white, "
        "and independent between windows.",
        least=0,
        most=1000,
    )
    target_noise: float = parameter(0.0, "The same for the target.", least=0, most=1000)
    jitter: float = parameter(
        0.0,
        "Standard deviation of what masks that jitter add to the target, over that of the target: the "
        "difference between the jitter of the next frame and of this one.",
        least=0,
        most=1000,
    )
    jitter_seen: float = parameter(
        0.0,
        "Standard deviation of what the same jitter takes from the source, over that of the source: a window "
        "that reaches too far out is darker.",
        least=0,
        most=1000,
    )
    every: int = parameter(1, "Every which frame is kept: 3 keeps one in three.", least=1, most=100)

    @model_validator(mode="after")
    def _has_layers(self) -> Self:
        if self.layered and self.layer:
            raise ValueError("layer is for a target without layers: leave it out, or layered")
        return self
