"""QC flags of a study's predictions: geometry, jitter, what was not given, few frames, stress, drift."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeAlias

import pandas as pd

from cytodisk.analysis.correlation.prepared_series import DRIFTING_SHARE
from cytodisk.number_words import counted
from cytodisk.runs.channel_names import VELOCITIES, shown_name
from cytodisk.runs.link_words import SURE_FRAMES, jitters, less_error, prediction_name
from cytodisk.runs.partial_words import SIGNIFICANT
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag
from cytodisk.runs.qc_flags.remedy import predict_again
from cytodisk.store.predictions.prediction_store import Prediction
from cytodisk.store.study import Study

_Rows: TypeAlias = Iterator[tuple[tuple[str, ...], Prediction, Any]]


def geometry(study: Study) -> Iterator[QCFlag]:
    """Links that are significant, but not once geometry is regressed out."""
    places = []
    for names, found, row in _rows(study):
        links = _of_cell(found.links, row)
        if lost := [_lost(link) for link in links[links["geometry"].fillna(False).astype(bool)].itertuples()]:
            places.append(_place(row, names, ", ".join(lost)))
    if places:
        yield QCFlag(
            "geometry",
            f"{counted(len(places), 'prediction')} may come from the cell's motion alone",
            "A pattern that stands still under a moving cell, or a cortex that moves with the edge, makes "
            "one signal predict another without any signalling. With both regressed out, these links are not "
            "significant, or less than a quarter of their gain is left.",
            "Read gain_partial, p_partial and q_partial there, not gain, p and q.",
            tuple(places),
        )


def jitter(study: Study) -> Iterator[QCFlag]:
    """Significant links with velocity in cells whose masks jitter."""
    places = []
    for names, found, row in _rows(study):
        links = _significant(found, row)
        of_velocity = links["source"].isin(VELOCITIES) | links["target"].isin(VELOCITIES)
        if jitters(row) and of_velocity.any():
            share = row["velocity_jitter"]
            places.append(_place(row, names, f"{share:.0%} of velocity's variance" if share > 0 else ""))
    if places:
        yield QCFlag(
            "jitter",
            f"masks that jitter show in {counted(len(places), 'prediction')} with velocity",
            "Noise of the outline moves edge and windows at once, and back in the next frame: so velocity "
            "and signal predict each other by themselves, velocity the signal most.",
            "Correct the masks, or segment again with less noise, and see whether the link stays. Layers "
            "further in suffer less.",
            tuple(places),
        )


def weaker_direction(study: Study) -> Iterator[QCFlag]:
    """Significant links that noise of measurement alone would make, as the other direction is stronger."""
    places = []
    for names, found, row in _rows(study):
        links = _of_cell(found.links, row)
        weaker = links[links["weaker"].fillna(False).astype(bool)].to_dict("records")
        if weaker:
            told = [f"{_arrow(link)}, layer {link['layer']}" for link in weaker]
            places.append(_place(row, names, "; ".join(told)))
    if places:
        yield QCFlag(
            "weaker direction",
            f"the weaker direction may be noise of measurement in {counted(len(places), 'prediction')}",
            "Where the target drives the source and is measured with noise, the source holds a cleaner copy "
            "of the target's past, and predicts it a little. On reversed time such a link gains far more.",
            "Believe the stronger direction alone, unless a sharper measurement shows both.",
            tuple(places),
        )


def common_driver(study: Study) -> Iterator[QCFlag]:
    """Significant links where signals of the study were not given."""
    places: list[Place] = []
    first: tuple[tuple[str, ...], list[str]] | None = None
    for names, found, row in _rows(study):
        others = str(row.get("not_given") or "")
        if others and len(_significant(found, row)):
            first = first or (names, others.split(", "))
            places.append(_place(row, names, f"{others} not given"))
    if first is not None:
        names, missing = first
        asked = study.prediction(*names).settings.get("given") or ()
        again = predict_again(study, names, "given", given=[*asked, *missing])
        yield QCFlag(
            "common driver",
            f"signals that were not given may drive both in {counted(len(places), 'prediction')}",
            "A signal that drives source and target, the target later, makes the source predict the target "
            "without any link between the two.",
            f"See whether the link holds with them given: {again}",
            tuple(places),
        )


def few_frames(study: Study) -> Iterator[QCFlag]:
    """Predictions of few frames."""
    places = [
        _place(row, names, f"{row['frames']:.0f} frames")
        for names, _, row in _rows(study)
        if row["frames"] < SURE_FRAMES
    ]
    if places:
        yield QCFlag(
            "few frames",
            f"{counted(len(places), 'prediction')} of fewer than {SURE_FRAMES} frames",
            "With 24 sectors whose neighbours are alike, a link of r = 0.3 is found in half of the cells of "
            "45 frames, and in 9 of 10 of 90 frames: that nothing was found says little.",
            "Pool cells: cytodisk predict on a batch, or the table pooled of a study of several cells.",
            tuple(places),
        )


def stress(study: Study) -> Iterator[QCFlag]:
    """Significant links between series in which independent ones are found to predict too often."""
    places: dict[str, list[Place]] = {}
    for names, found, row in _rows(study):
        links = _significant(found, row)
        marked = {mark: links[links["stress"].fillna("").str.contains(mark)] for mark in _MARKS}
        for mark, some in marked.items():
            if len(some):
                told = dict.fromkeys(
                    f"{shown_name(a)} → {shown_name(b)}" for a, b in some[["source", "target"]].values
                )
                places.setdefault(mark, []).append(_place(row, names, ", ".join(told)))
    for mark, some_places in places.items():
        yield QCFlag(
            mark,
            f"{_MARKS[mark]} in {counted(len(some_places), 'prediction')}",
            "So few moments decide that p counts more observations than there are. A true signal can do "
            "this, too: the flag says that p is too small, not that nothing is there.",
            "Compare cells: a true link is there in most of them (table pooled), with the same sign.",
            tuple(some_places),
        )


def drifting_series(study: Study) -> Iterator[QCFlag]:
    """Predictions of series whose level drifts."""
    places, first = [], None
    for names, found, row in _rows(study):
        if row["drifting"] > DRIFTING_SHARE:
            first = first or (names, found)
            links = _of_cell(found.links, row)
            told = dict.fromkeys(
                " and ".join(sorted((shown_name(link["source"]), shown_name(link["target"]))))
                for link in links[links["drifting"] > DRIFTING_SHARE].to_dict("records")
            )
            places.append(_place(row, names, f"{row['drifting']:.0%} of the series of {', '.join(told)}"))
    if first is not None:
        names, found = first
        advice = "Use a calm part of the movie with --frames."
        if found.settings.get("detrend", "none") == "none":
            again = predict_again(study, names, "without_trend", detrend="linear")
            advice = f"See whether this says the same: {again}"
        yield QCFlag(
            "drifting series",
            f"the level of many series drifts in {counted(len(places), 'prediction')}",
            "Two trends predict each other whatever they come from, bleaching too.",
            advice,
            tuple(places),
        )


def geometry_not_tested(study: Study) -> Iterator[QCFlag]:
    """Predictions for which geometry could not be regressed out, or not where they are significant."""
    places = []
    for names, found, row in _rows(study):
        if found.settings.get("geometry") and (why := row["geometry_not_tested"] or _unknown(found, row)):
            places.append(_place(row, names, why))
    if places:
        yield QCFlag(
            "geometry not tested",
            f"what geometry alone would give is not known of {counted(len(places), 'prediction')}",
            "The signal or the maps could not be read again, or too few frames show the same places: a still "
            "pattern or a cortex that moves with the edge may have made the link.",
            "Put the signal and the maps where they were, and run cytodisk predict again.",
            tuple(places),
        )


def left_out(study: Study) -> Iterator[QCFlag]:
    """Cells in which nothing could be tested."""
    places = []
    for names in study.predictions:
        cells = study.prediction(*names).cells
        places += [_place(row, names, row["reason"]) for _, row in cells[cells["status"] != "ok"].iterrows()]
    if places:
        yield QCFlag(
            "not predicted",
            f"{counted(len(places), 'cell')} could not be tested for prediction",
            "They are in the tables of windows, but not in those of predictions.",
            "Pass a smaller --max-order if the cells are there for few frames.",
            tuple(places),
        )


PREDICTION_RULES: tuple[Callable[[Study], Iterator[QCFlag]], ...] = (
    geometry,
    weaker_direction,
    jitter,
    common_driver,
    stress,
    drifting_series,
    geometry_not_tested,
    few_frames,
    left_out,
)

_MARKS = {
    "common pulse": "three frames outweigh all others",
    "restless episode": "both series vary most in one episode",
    "variance change": "the variance of both series changes in the same direction",
    "steady oscillation": "both series oscillate at one period",
    "heavy tails": "single values lie far out",
}


def _rows(study: Study) -> _Rows:
    """Tested cells of all predictions, with the names of what was tested."""
    for names in study.predictions:
        found = study.prediction(*names)
        for _, row in found.cells[found.cells["status"] == "ok"].iterrows():
            yield names, found, row


def _place(row: Any, names: tuple[str, ...], note: str) -> Place:
    words = prediction_name(*names)
    return Place(int(row["cell"]), None, f"{words}: {note}" if note else words)


def _of_cell(table: pd.DataFrame, row: Any) -> pd.DataFrame:
    rows: pd.DataFrame = table[table["cell"] == row["cell"]]
    return rows


def _significant(found: Prediction, row: Any) -> pd.DataFrame:
    links = _of_cell(found.links, row)
    return links[links["q"] < SIGNIFICANT]


def _unknown(found: Prediction, row: Any) -> str:
    """Significant links that could not be tested without geometry, and why; empty for none."""
    links = _significant(found, row)
    unknown = links[links["gain_partial"].isna()]
    rows = unknown.to_dict("records")
    return "; ".join(f"{_arrow(one)}, layer {one['layer']}, {one['reason']}" for one in rows)


def _lost(one: Any) -> str:
    """As "Rac1 → velocity, layer 0: 4.2 % → 0.3 % less error"."""
    words = f"{shown_name(str(one.source))} → {shown_name(str(one.target))}, layer {one.layer}"
    gains = [less_error(max(gain, 0.0)) for gain in (one.gain, one.gain_partial)]
    return f"{words}: {gains[0].removesuffix(' less error')} → {gains[1]}"


def _arrow(link: Any) -> str:
    return f"{shown_name(link['source'])} → {shown_name(link['target'])}"
