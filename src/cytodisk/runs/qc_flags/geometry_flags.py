"""QC flags of correlations that the motion of the cell alone would give."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from cytodisk.number_words import counted
from cytodisk.runs.channel_names import correlation_name
from cytodisk.runs.partial_words import SIGNIFICANT, lost_rows, region_lost
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag
from cytodisk.store.correlation_store import Correlation
from cytodisk.store.study import Study


def geometry(study: Study) -> Iterator[QCFlag]:
    """Correlations of layers or clusters that are significant, but not once geometry is regressed out."""
    places = [
        Place(int(row.cell), None, f"{name}: {lost}")
        for name, found in _tested(study)
        for _, row in found.cells.iterrows()
        if row["geometry_not_tested"] == "" and (lost := _lost(found, int(row.cell)))
    ]
    if places:
        yield QCFlag(
            "geometry",
            f"{counted(len(places), 'correlation')} may come from the cell's motion alone",
            "A pattern that stands still under a moving cell, or a cortex that moves with the edge, "
            "correlates without any signalling. With both regressed out, these layers and clusters have no "
            "significant correlation left, or less than half of it at its lag.",
            "Read p_partial, q_partial and correlation_partial there, not p, q and correlation.",
            tuple(places),
        )


def geometry_not_tested(study: Study) -> Iterator[QCFlag]:
    """Correlations for which geometry could not be regressed out, or not where they are significant."""
    places = [
        Place(int(row.cell), None, f"{name}: {why}")
        for name, found in _tested(study)
        for _, row in found.cells.iterrows()
        if row["status"] == "ok" and (why := row["geometry_not_tested"] or _unknown(found, int(row.cell)))
    ]
    if places:
        yield QCFlag(
            "geometry not tested",
            f"what geometry alone would give is not known of {counted(len(places), 'correlation')}",
            "The signal or the maps could not be read again, or too few frames show the same places: a still "
            "pattern or a cortex that moves with the edge may have made the correlation.",
            _remedy(" ".join(place.note for place in places)),
            tuple(places),
        )


def _remedy(why: str) -> str:
    """What to do, by why geometry was not tested."""
    if "/maps/" in why or "\\maps\\" in why:
        return "The maps of the study are gone: run cytodisk movie again, then correlate again."
    return "Put the signal where it was and correlate again, or pass a smaller --max-lag."


def _lost(found: Correlation, cell: int) -> str:
    """Layers and clusters of a cell that do not survive, in words; empty for none."""
    layers = found.layers[(found.layers["cell"] == cell) & lost_rows(found.layers)]
    words = [_layers(layers)] if len(layers) else []
    if found.clusters is not None and "p_partial" in found.clusters:
        of_cell = found.clusters[found.clusters["cell"] == cell]
        lost = of_cell[region_lost(of_cell["p_partial"])]
        words += [f"cluster {number}" for number in lost["cluster"]]
    return ", ".join(words)


def _unknown(found: Correlation, cell: int) -> str:
    """Significant layers of a cell of which no window has enough frames, in words; empty for none."""
    layers = found.layers
    if "q" not in layers or "correlation_partial" not in layers:
        return ""
    unknown = (layers["cell"] == cell) & (layers["q"] < SIGNIFICANT) & layers["correlation_partial"].isna()
    names = ", ".join(f"layer {layer}" for layer in layers.loc[unknown, "layer"])
    return f"too few frames in {names}" if names else ""


def _layers(lost: pd.DataFrame) -> str:
    """As "layer 0 +0.41 at lag −2 → +0.02 at lag 5", the partial correlation behind the arrow."""
    words = [
        f"layer {row.layer} {row.correlation:+.2f} at lag {row.lag:.0f} → {row.correlation_partial:+.2f} "
        f"at lag {row.lag_partial:.0f}"
        for row in lost.itertuples()
    ]
    return ", ".join(words).replace("-", "−")


def _tested(study: Study) -> Iterator[tuple[str, Correlation]]:
    """Correlations that geometry was to be regressed out of, with their names."""
    for names in study.correlations:
        found = study.correlation(*names)
        if found.settings.get("geometry") and "geometry_not_tested" in found.cells:
            yield correlation_name(names), found
