"""Lines on the layers of a correlation: the mean over sectors of each, and what is left of it."""

import math
from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

    from cytodisk.store.correlation_store import Correlation
    from cytodisk.store.study import Study

JITTER = "jitter makes this lag: do not believe it yet"


def compartment_words(study: "Study") -> str:
    """Which layers are in the nucleus, as " (0–3 cytoplasm, 4–6 nucleus)"; empty for cells without."""
    from cytodisk.windows.study_grid import polar_grid_of

    names = polar_grid_of(study.provenance).compartments.tolist()
    if "nucleus" not in names:
        return ""
    first, last = names.index("nucleus"), len(names) - 1
    return f" ({_range(0, first - 1)} cytoplasm, {_range(first, last)} nucleus)"


def _range(first: int, last: int) -> str:
    return str(first) if first == last else f"{first}–{last}"


def layer_lines(found: "Correlation", study: "Study", cell: int, without: str) -> Iterator[str]:
    """A line for each layer; neighbours in which nothing was found share one.

    Parameters
    ----------
    found : Correlation
    study : Study
    cell : int
    without : str
        What was regressed out, as "without geometry".
    """
    from cytodisk.runs.correlate.verdict import jittered_rows
    from cytodisk.runs.depth_layers import layer_borders
    from cytodisk.windows.study_grid import polar_grid_of

    borders = layer_borders(polar_grid_of(study.provenance))
    interval = study.scale.frame_interval_s or math.nan
    rows = found.layers[found.layers["cell"] == cell]
    windows = found.windows[found.windows["cell"] == cell]
    rows = rows.assign(jittered=jittered_rows(found, rows))
    parts = [(row, windows[windows["layer"] == row.layer]) for row in rows.itertuples()]
    for kind, some in groupby(parts, key=lambda part: _nothing(*part)):
        group = list(some)
        if kind:
            yield f"  {_together([row for row, _ in group], borders)}: {_why_nothing(kind, group, without)}"
            continue
        for row, of_layer in group:
            name = _named(int(str(row.layer)), borders)
            yield f"  {name}: {_layer_words(row, of_layer, without, interval)}"


def signed(value: float) -> str:
    """A correlation with its sign and a true minus."""
    return f"{value:+.2f}".replace("-", "−")


def _nothing(row: Any, windows: "pd.DataFrame") -> str:
    """Why a layer needs no line of its own; empty if it does."""
    if not math.isfinite(row.correlation):
        return "no correlation"
    if "q" in windows and row.q >= 0.05 and not (windows["q"] < 0.05).any():
        return "nothing"
    return ""


def _why_nothing(kind: str, group: list[Any], without: str) -> str:
    if kind != "nothing":
        return f"{kind}: too few frames, or a signal that does not vary"
    least = min(row.q for row, _ in group)
    words = f"nothing, q = {least:.2g}" if len(group) == 1 else f"nothing, all q ≥ {least:.2g}"
    if without and not any(math.isfinite(row.correlation_partial) for row, _ in group):
        words += f"; {without} not known: too few frames"
    return words


def _together(rows: list[Any], borders: list[str]) -> str:
    first, last = rows[0].layer, rows[-1].layer
    return _named(first, borders) if first == last else f"layers {first}–{last}"


def _named(layer: int, borders: list[str]) -> str:
    return ", ".join(filter(None, [f"layer {layer}", borders[layer]]))


def _layer_words(row: Any, windows: "pd.DataFrame", without: str, interval_s: float) -> str:
    from cytodisk.runs.correlate.lag_words import lag_words

    words = f"mean of the layer {signed(row.correlation)} at {lag_words(row.lag, row.lag * interval_s)}"
    if "q" in windows:
        number = int((windows["q"] < 0.05).sum())
        words += f", q = {row.q:.2g}; single windows significant: {number} of {len(windows)}"
        if without:
            words += f"; {without} {_left(row, windows, interval_s)}"
    return f"{words}; {JITTER}" if row.jittered else words


def _left(row: Any, windows: "pd.DataFrame", interval_s: float) -> str:
    """What is left of a layer once the controls are regressed out."""
    from cytodisk.runs.correlate.lag_words import lag_words

    if not math.isfinite(row.correlation_partial):
        return "not known: too few frames"
    lag = lag_words(row.lag_partial, row.lag_partial * interval_s)
    words, q = f"{signed(row.correlation_partial)} at {lag}", f"q = {row.q_partial:.2g}"
    if row.geometry:
        words += (
            f", no longer significant ({q})" if row.q_partial >= 0.05 else f", less than half is left, {q}"
        )
    else:
        words += f", {q}"
    return f"{words}, {int((windows['q_partial'] < 0.05).sum())} of {len(windows)}"
