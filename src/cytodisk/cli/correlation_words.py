"""What `cytodisk correlate` says: peaks by layer, what speaks against them, what they replaced."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from cytodisk.cli.console import count

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.store.correlation_store import Correlation

_MOST_CLUSTERS = 5  # of a cell that are listed


def say_correlation(console: "Console", found: "Correlation") -> None:
    """Peaks by layer, and how many windows are significant."""
    from cytodisk.runs.partial_words import not_tested, without_words

    settings = found.settings
    console.print(
        f"signal {found.signal!r} with {found.with_}, {_of_what(settings)}lags to {settings['max_lag']} "
        "frames. "
        f"Positive lag: {_what_comes(found.with_)} after the signal; negative lag: before it"
    )
    layers, windows = found.layers, found.windows
    for cell, rows in layers.groupby("cell"):
        of_cell, without = windows[windows["cell"] == cell], without_words(found, int(str(cell)))
        console.print(f"cell {cell}, mean over sectors by layer:")
        for layer in rows.itertuples():
            console.print(_layer_words(layer, of_cell[of_cell["layer"] == layer.layer], without))
        for words in _cluster_words(found, cell, without):
            console.print(words)
    for _, row in found.cells.iterrows():
        for words in _cautions(row, settings):
            console.print(f"cell {row['cell']}{words}")
    if skipped := not_tested(found):
        console.print(skipped)
    _say_power(console, found.cells, windows)
    console.print(f"{count(layers['cell'].nunique())} correlated: {found.path}")


def _what_comes(with_: str) -> str:
    from cytodisk.runs.channel_names import VELOCITIES

    return "the edge moves" if with_ in VELOCITIES else f"{with_} comes"


def _of_what(settings: dict[str, Any]) -> str:
    return "" if settings.get("statistic", "pearson") == "pearson" else "Spearman correlation of ranks, "


def say_replaced(console: "Console", before: dict[str, Any] | None, now: dict[str, Any]) -> None:
    """Say which settings the replaced correlation had, if others."""
    if before is None:
        return
    changed = [f"{name} {before[name]!r}" for name in now if name in before and before[name] != now[name]]
    if changed:
        console.print(f"this replaced the correlation with {', '.join(changed)}: --name NAME keeps both")


def _cautions(row: Any, settings: dict[str, Any]) -> Iterator[str]:
    """What speaks against a cell's correlations, beside the QC flags."""
    from cytodisk.runs.channel_names import VELOCITIES

    if row["status"] != "ok":
        yield f" left out: {row['reason']}"
        return
    if row["restarts"]:
        yield (
            f": tracking started anew {row['restarts']:.0f} times; sectors need not be the same places "
            "before and after, so correlate the stretches one by one with --frames"
        )
    if settings["with"] in VELOCITIES and not math.isfinite(row["jitter"]):
        yield ": too few frames to see whether masks jitter, which correlates by itself at lags -1 and 0"


def _say_power(console: "Console", cells: Any, windows: Any) -> None:
    """How many windows must be beyond all surrogates for any q to be below 0.05."""
    surrogates = int(cells["surrogates"].max())
    if not surrogates:
        return
    tested = int(windows["q"].notna().groupby(windows["cell"]).sum().max())
    fewest = tested * 20 // (surrogates + 1) + 1  # q = tested / (number · (surrogates + 1)) < 1 / 20
    if fewest > tested > 0:
        console.print(
            f"{surrogates} surrogates are too few for any q below 0.05: see --surrogates and --null"
        )
    elif tested and fewest > 1:
        console.print(
            f"of {tested} windows, q < 0.05 takes {fewest} beyond all {surrogates} surrogates; a smaller "
            "patch needs more --surrogates, or --sectors"
        )


def _cluster_words(found: "Correlation", cell: Any, without: str) -> Iterator[str]:
    """The clusters of a cell, the largest first."""
    if found.clusters is None:
        return
    clusters = found.clusters[found.clusters["cell"] == cell]
    if clusters.empty:
        yield f"cell {cell}, clusters of neighbouring windows: none with p <= 0.05"
        return
    yield f"cell {cell}, clusters of neighbouring windows, p <= 0.05 (their borders are not exact):"
    for one in clusters.head(_MOST_CLUSTERS).itertuples():
        yield _cluster_line(one, found.with_, without)
    if len(clusters) > _MOST_CLUSTERS:
        yield f"  and {len(clusters) - _MOST_CLUSTERS} smaller: clusters.parquet has them all"


def _cluster_line(row: Any, with_: str, without: str) -> str:
    from cytodisk.runs.correlate.cluster_words import cluster_place
    from cytodisk.runs.partial_words import region_left

    words = (
        f"  {cluster_place(row)}: {_which_first(row.lag, with_)}, "
        f"{row.correlation:+.2f} in {count(row.windows, 'window')}, p = {row.p:.2g}"
    )
    return "; ".join(filter(None, [words, region_left(row, without)]))


def _which_first(lag: int, with_: str) -> str:
    if not lag:
        return f"{_what_comes(with_)} with the signal"
    return f"{_what_comes(with_)} {'after' if lag > 0 else 'before'} the signal"


def _layer_words(row: Any, windows: Any, without: str) -> str:
    layer = f"  layer {row.layer:>2}"
    if not math.isfinite(row.correlation):
        return f"{layer}  no correlation: too few frames, deeper than the cell, or no change"
    seconds = f" ({row.lag_s:+.4g} s)" if math.isfinite(row.lag_s) else ""
    words = f"{layer}  {row.correlation:+.2f} at lag {row.lag:+.0f}{seconds}"
    if "q" not in windows:
        return words
    share = (windows["q"] < 0.05).mean()
    words = f"{words}, q = {row.q:.2g}; q < 0.05 in {share:.0%} of its windows"
    if not without:
        return words
    if not math.isfinite(row.correlation_partial):
        return f"{words}; {without} not known: too few frames"
    left = (windows["q_partial"] < 0.05).mean()
    lost = ": it does not survive" if row.geometry else ""
    return (
        f"{words}; {without} {row.correlation_partial:+.2f} at lag {row.lag_partial:+.0f}, "
        f"q = {row.q_partial:.2g}, {left:.0%} of its windows{lost}"
    )
