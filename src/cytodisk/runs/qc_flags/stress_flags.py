"""QC flags of correlations whose p-values are too small: pulses, episodes, oscillations, heavy tails."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import pandas as pd

from cytodisk.analysis.stress.stress_marks import (
    COMMON_PULSE,
    HEAVY_TAILS,
    RESTLESS_EPISODE,
    STEADY_OSCILLATION,
    VARIANCE_CHANGE,
)
from cytodisk.number_words import counted
from cytodisk.runs.channel_names import correlation_name
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag
from cytodisk.runs.qc_flags.remedy import correlate_again
from cytodisk.store.study import Study

_TRUE_TOO = " A true signal can do this, too: the flag says that p is too small, not that nothing is there."
_SHIFTS_FOR_P = 21.0  # runs of 2 max_lag + 1 frames that leave 19 shifts, which p = 0.05 takes


@dataclass(frozen=True)
class StressRule:
    """A flag of correlations that have a stress mark.

    Attributes
    ----------
    name, meaning : str
        As of `QCFlag`.
    what : str
        With {count} where the number of correlations goes.
    advice : callable
        (study, names of the first correlation, row of its first cell).
    note : callable
        What stands beside a place: (row).
    ranks_help : bool
        Whether a correlation of ranks needs no flag.
    """

    name: str
    what: str
    meaning: str
    advice: Callable[[Study, tuple[str, ...], Any], str]
    note: Callable[[Any], str]
    ranks_help: bool = True

    def __call__(self, study: Study) -> Iterator[QCFlag]:
        found = [one for one in _rows(study) if self._raised(one[1])]
        if found:
            yield QCFlag(
                self.name,
                self.what.format(count=counted(len(found), "correlation")),
                self.meaning + _TRUE_TOO,
                self.advice(study, *found[0]),
                tuple(
                    Place(int(row["cell"]), None, f"{correlation_name(names)}: {self.note(row)}")
                    for names, row in found
                ),
            )

    def _raised(self, row: pd.Series[Any]) -> bool:
        cured = self.ranks_help and row.get("statistic") == "spearman"
        return self.name in str(row.get("stress") or "").split(", ") and not cured


def _shifted(study: Study, names: tuple[str, ...], row: Any) -> str:
    """What to do about oscillators: circular shifts keep their period whole, but take many frames."""
    lag = int((row["frames"] / _SHIFTS_FOR_P - 1.0) // 2.0)
    if lag < 1:
        return (
            "Surrogates by circular shift stand this, but need a longer movie; else compare cells: a true "
            "correlation has the same lag in all of them."
        )
    return (
        "Compare cells: a true correlation has the same lag in all of them. And see p by window of circular "
        "shifts, which keep the oscillation whole: "
        + correlate_again(study, names, "shifts", null="shift", max_lag=lag)
    )


def _ranks(study: Study, names: tuple[str, ...], row: Any) -> str:
    return f"See what ranks say: {correlate_again(study, names, 'ranks', statistic='spearman')}"


def _without_pulse(study: Study, names: tuple[str, ...], row: Any) -> str:
    earlier = study.correlation(*names).settings.get("without_frames") or ()
    frames = sorted({*earlier, *(int(frame) for frame in row["pulse_frames"].split(","))})
    again = correlate_again(study, names, "without_pulse", without_frames=frames)
    return f"See what all other frames say: {again}"


def _rows(study: Study) -> Iterator[tuple[tuple[str, ...], pd.Series[Any]]]:
    """Correlated cells of all correlations that looked for stress, with the names of what was correlated."""
    for names in study.correlations:
        cells = study.correlation(*names).cells
        if "stress" in cells:
            for _, row in cells[cells["status"] == "ok"].iterrows():
                yield names, row


common_pulse = StressRule(
    COMMON_PULSE,
    "three frames outweigh all others in {count}",
    "Both series leap in the same few frames, in many windows at once, as after a jolt, a change of focus or "
    "one fast move of the cell.",
    _without_pulse,
    lambda row: (
        f"frames {row['pulse_frames'].replace(',', ', ')} hold {row['pulse_share']:.0%} of the joint energy"
    ),
)
restless_episode = StressRule(
    RESTLESS_EPISODE,
    "both series vary most in one episode in {count}",
    "While a cell is restless, both series vary more, whatever one has to do with the other: the episode "
    "counts as a few observations, p counts all frames.",
    _ranks,
    lambda row: (
        f"frames {row['episode_frames'].replace(':', '–')} vary {row['episode_ratio']:.1f} times as much"
    ),
)
variance_change = StressRule(
    VARIANCE_CHANGE,
    "the variance of both series changes in the same direction in {count}",
    "The part of the movie with the larger variance outweighs the rest, so there are fewer observations "
    "than p counts.",
    _ranks,
    lambda row: f"variance of the second half {row['variance_ratio']:.2g} times that of the first",
)
steady_oscillation = StressRule(
    STEADY_OSCILLATION,
    "both series oscillate at one period in {count}",
    "Two oscillators of one period correlate at some lag, whether or not they have to do with each other.",
    _shifted,
    lambda row: f"{row['line_share']:.0%} of the variance at a period of {row['line_period']:.3g} frames",
    ranks_help=False,
)
heavy_tails = StressRule(
    HEAVY_TAILS,
    "single values lie far out in {count}",
    "A few extreme values in both series decide the correlation.",
    _ranks,
    lambda row: f"kurtosis {row['kurtosis']:.1f} (normal: 3)",
)

STRESS_RULES: tuple[StressRule, ...] = (
    common_pulse,
    restless_episode,
    variance_change,
    steady_oscillation,
    heavy_tails,
)
