"""Parameters of `prepare_series`, `cross_correlate`, `correlate_pairs` and `peak_correlation`."""

from typing import Literal, TypeAlias

from cytodisk.parameters import MOST_SEED, Parameters, parameter

Detrend: TypeAlias = Literal["none", "linear", "median"]
Statistic: TypeAlias = Literal["pearson", "spearman"]
Null: TypeAlias = Literal["phase", "shift"]
Rule: TypeAlias = Literal["nearest", "largest"]

MOST_SURROGATES = 100_000  # p-values down to 0.00001; each takes as long as the correlation itself
FEWEST_SURROGATES = 19  # with fewer, no p-value is as small as 0.05


def enough_surrogates(surrogates: int) -> int:
    """The number of surrogates; raises ValueError if there are some, but too few for any p to reach 0.05."""
    if 0 < surrogates < FEWEST_SURROGATES:
        raise ValueError(f"must be 0, or at least {FEWEST_SURROGATES} for any p to reach 0.05")
    return surrogates


class DetrendParameters(Parameters):
    """How slow changes are taken out of series."""

    detrend: Detrend = parameter(
        "none", 'Slow change to take out: "linear" is a straight line, "median" the moving median.'
    )
    detrend_frames: int | None = parameter(
        None,
        "Length of the moving median; without it 4 × max_lag + 1.",
        least=3,
        most=1_000_000,
        unit="frames",
    )
    difference: bool = parameter(False, "Use the changes from frame to frame in place of the values.")


class PrepareParameters(DetrendParameters):
    """How series are prepared for correlation."""

    zscore: bool = parameter(
        False,
        "Subtract the mean of each series and divide by its standard deviation. It changes no correlation.",
    )


class StatisticParameters(Parameters):
    """Which correlation is computed."""

    statistic: Statistic = parameter(
        "pearson",
        '"pearson" correlates values, "spearman" their ranks: a pulse, or an episode in which both vary '
        "more, then counts for little more than other frames.",
    )


class NullParameters(Parameters):
    """What chance would give."""

    min_pairs: int = parameter(
        10,
        "Fewest frames that must have both values at a lag; lags with fewer are NaN.",
        least=3,
        most=1_000_000,
    )
    surrogates: int = parameter(
        0,
        "Number of surrogate series to compare with; 0 for none. 999 give p-values down to 0.001.",
        least=0,
        most=MOST_SURROGATES,
    )
    null: Null = parameter(
        "phase",
        'How surrogates are made: "phase" draws random phases, "shift" shifts series in a circle. Shifts '
        "that share no lag are few: at most frames / (2 × max_lag + 1).",
    )
    seed: int = parameter(0, "Seed of the surrogates.", least=0, most=MOST_SEED)


class PairCorrelationParameters(NullParameters, StatisticParameters, DetrendParameters):
    """What `cross_correlate` and `correlate_pairs` both take."""


class PairParameters(PairCorrelationParameters):
    """What `correlate_pairs` takes."""

    bins: int = parameter(
        20,
        "Number of bins of distances above 0. One more, at 0, holds windows paired with themselves, and "
        "along the edge all windows of one sector.",
        least=1,
        most=10_000,
    )


class SkipLagsParameters(Parameters):
    """Which lags are left out."""

    skip_lags: tuple[int, ...] = parameter(
        (),
        "Lags that are left out, such as -1 and 0 where masks jitter.",
        words="whole numbers, such as -1,0",
        unit="frames",
    )


CLUSTERS = (
    "Also find clusters: neighbouring windows that agree at a lag. They need surrogates, of which 499 at "
    "most are used."
)


class ClusterParameters(Parameters):
    """Whether neighbouring windows are tested together."""

    clusters: bool = parameter(False, CLUSTERS)


class CrossCorrelationParameters(
    ClusterParameters, SkipLagsParameters, NullParameters, StatisticParameters, PrepareParameters
):
    """How series are correlated."""

    edge_sectors: int | None = parameter(
        None,
        "Number of sectors of the whole edge, where only some are passed: its last one is the neighbour of "
        "sector 0. Without it, sectors numbered from 0 without a gap are the whole edge.",
        least=1,
        most=100_000,
        unit="sectors",
    )


class PeakParameters(Parameters):
    """Which lag of a correlation is its peak."""

    rule: Rule = parameter(
        "nearest",
        '"nearest": the significant peak closest to lag 0. "largest": the peak of largest magnitude.',
    )
