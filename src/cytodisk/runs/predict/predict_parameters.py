"""Parameters of `cytodisk predict`."""

from typing import Literal

from pydantic import field_validator

from cytodisk.analysis.correlation.correlation_parameters import (
    FEWEST_SURROGATES,
    MOST_SURROGATES,
    enough_surrogates,
)
from cytodisk.analysis.prediction.prediction_parameters import HeldParameters
from cytodisk.parameters import parameter
from cytodisk.runs.used_series.used_parameters import UsedSeriesParameters


class PredictParameters(UsedSeriesParameters, HeldParameters):
    """What decides the result of `cytodisk predict`, beside the study and the names of its signals."""

    given: tuple[str, ...] | None = parameter(
        None,
        "Signals that are given: what their past predicts as well does not count. Without it none is given "
        "to a pair, and all others to each pair of a network.",
        words="channels or velocity, with commas between",
    )
    geometry: bool = parameter(
        True,
        "Also predict from what is left without what geometry alone would give: the movie's mean in the lab "
        "and its mean by depth. It reads the maps and the signal again.",
    )
    detrend: Literal["none", "linear"] = parameter(
        "none", 'Slow change to take out first: "linear" is a straight line, such as bleaching.'
    )
    surrogates: int = parameter(
        999,
        f"Number of shifted sources to compare with; 0 for none, else at least {FEWEST_SURROGATES}, as p "
        "could not reach 0.05 with fewer.",
        least=0,
        most=MOST_SURROGATES,
    )

    @field_validator("surrogates")
    @classmethod
    def _enough(cls, surrogates: int) -> int:
        return enough_surrogates(surrogates)
