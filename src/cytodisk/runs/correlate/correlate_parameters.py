"""Parameters of `cytodisk correlate`."""

from typing import Literal

from pydantic import field_validator

from cytodisk.analysis.correlation.correlation_parameters import (
    CLUSTERS,
    FEWEST_SURROGATES,
    MOST_SURROGATES,
    PairCorrelationParameters,
    PeakParameters,
    SkipLagsParameters,
    enough_surrogates,
)
from cytodisk.parameters import parameter
from cytodisk.runs.used_series.used_parameters import UsedSeriesParameters


class CorrelateParameters(
    UsedSeriesParameters, PeakParameters, SkipLagsParameters, PairCorrelationParameters
):
    """What decides the result of `cytodisk correlate`, beside the study and its two signals."""

    max_lag: int | None = parameter(
        None,
        "Longest lag; without it a quarter of the movie, at most 20, or what leaves enough pairs of frames.",
        least=0,
        most=1_000_000,
        unit="frames",
    )
    against: Literal["window", "edge"] = parameter(
        "window",
        'What a window of one signal is compared with: "window" is the same window of the other signal, '
        '"edge" the outermost window of the sector.',
    )
    surrogates: int = parameter(
        1999,
        f"Number of surrogate series to compare with; 0 for none, else at least {FEWEST_SURROGATES}, as p "
        "could not reach 0.05 with fewer.",
        least=0,
        most=MOST_SURROGATES,
    )
    geometry: bool = parameter(
        True,
        "Also correlate what is left without what geometry alone would give: the movie's mean in the lab and "
        "its mean by depth. It reads the maps and the signal again.",
    )
    control: tuple[str, ...] = parameter(
        (),
        "Channels that are regressed out too, window by window, such as a volume marker.",
        words="names of channels with commas between",
    )
    clusters: bool = parameter(True, CLUSTERS)
    pairs: bool = parameter(
        False, "Also correlate every window of one signal with every window of the other, by distance."
    )

    @field_validator("surrogates")
    @classmethod
    def _enough(cls, surrogates: int) -> int:
        return enough_surrogates(surrogates)
