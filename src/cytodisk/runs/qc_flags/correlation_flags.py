"""QC flags of a study's correlations: marks of jitter, drift, cells that were left out."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from cytodisk.analysis.correlation.jitter_mark import JITTERING_SHARE
from cytodisk.analysis.correlation.prepared_series import DRIFTING_SHARE
from cytodisk.number_words import counted
from cytodisk.runs.channel_names import correlation_name
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag
from cytodisk.runs.qc_flags.remedy import correlate_again
from cytodisk.store.study import Study


def jitter(study: Study) -> Iterator[QCFlag]:
    """Correlations with velocity that jitter of the masks made part of."""
    found = [(names, row) for names, row in _rows(study) if abs(row.jitter) > 0]
    places = [
        Place(int(row.cell), None, f"{correlation_name(names)}: {_step(row)}{_jitters(row)}")
        for names, row in found
    ]
    if places:
        names = found[0][0]
        lags = (-2, -1, 0, 1) if study.correlation(*names).settings.get("difference") else (-1, 0)
        again = correlate_again(study, names, "without_jitter", skip_lags=lags)
        yield QCFlag(
            "jitter",
            f"masks that jitter show in {counted(len(places), 'correlation')} with velocity",
            "Noise of the outline moves edge and windows at once: it correlates by itself, at lags −1 and 0, "
            "with opposite signs.",
            f"Look at the other lags: {again}",
            tuple(places),
        )


def _step(row: pd.Series[float]) -> str:
    return f"{row.jitter:+.2f} at lag 0".replace("-", "−")


def _jitters(row: pd.Series[float]) -> str:
    """How much of velocity is jitter, where that is known and not little."""
    share = row.get("velocity_jitter", 0.0)
    return f", {share:.0%} of velocity's variance" if share >= JITTERING_SHARE else ""


def drifting_series(study: Study) -> Iterator[QCFlag]:
    """Correlations of series whose level drifts."""
    places, drifting = [], []
    for names, row in _rows(study):
        share = max(row.drifting_signal, row.drifting_with)
        if share > DRIFTING_SHARE:
            drifting.append(names)
            places.append(Place(int(row.cell), None, f"{correlation_name(names)}: {share:.0%} of the series"))
    if places:
        yield QCFlag(
            "drifting series",
            f"the level of many series drifts in {counted(len(places), 'correlation')}",
            "Two trends correlate whatever they come from, bleaching too.",
            _without_trend(study, drifting[0]),
            tuple(places),
        )


def _without_trend(study: Study, names: tuple[str, ...]) -> str:
    """What takes a trend out that is still there."""
    settings = study.correlation(*names).settings
    if settings.get("difference"):
        return "Steps from frame to frame drift, too: compare cells, or correlate a calm part with --frames."
    if settings.get("detrend", "none") == "none":
        again = correlate_again(study, names, "without_trend", detrend="linear")
        return f"See whether this says the same: {again}"
    return f"See whether steps say the same: {correlate_again(study, names, 'steps', difference=True)}"


def left_out(study: Study) -> Iterator[QCFlag]:
    """Cells that could not be correlated."""
    places = []
    for names in study.correlations:
        cells = study.correlation(*names).cells
        refused = cells[cells["status"] != "ok"]
        places += [
            Place(int(cell), None, f"{correlation_name(names)}: {reason}")
            for cell, reason in zip(refused["cell"], refused["reason"], strict=True)
        ]
    if places:
        yield QCFlag(
            "not correlated",
            f"{counted(len(places), 'cell')} could not be correlated",
            "They are in the tables of windows, but not in those of correlations.",
            "Pass a smaller --max-lag, or --min-pairs, if the cells are there for few frames.",
            tuple(places),
        )


def _rows(study: Study) -> Iterator[tuple[tuple[str, ...], pd.Series[float]]]:
    """Correlated cells of all correlations, with the names of what was correlated."""
    for names in study.correlations:
        cells = study.correlation(*names).cells
        for _, row in cells[cells["status"] == "ok"].iterrows():
            yield names, row
