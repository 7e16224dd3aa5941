"""What a correlation tells: peaks by layer, what speaks against them, what they replaced."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from cytodisk.number_words import counted
from cytodisk.runs.told.layer_peak_words import compartment_words, layer_lines, signed

if TYPE_CHECKING:
    from cytodisk.store.correlation_store import Correlation
    from cytodisk.store.study import Study

_MOST_CLUSTERS = 5  # of a cell that are listed
_MOST_FINDINGS = 3  # cells of which sentences are told


def correlation_lines(found: "Correlation", study: "Study") -> Iterator[str]:
    """Peaks by layer, and how many windows are significant."""
    from cytodisk.runs.partial_words import not_tested, without_words

    settings = found.settings
    yield (
        f"signal {found.signal!r} with {found.with_}, {_of_what(settings)}lags to {settings['max_lag']} "
        "frames. "
        f"Positive lag: {_what_comes(found.with_)} after the signal; negative lag: before it"
    )
    layers, windows = found.layers, found.windows
    for cell in layers["cell"].unique().tolist():
        without = without_words(found, cell)
        yield f"cell {cell}, mean over sectors by layer{compartment_words(study)}:"
        yield from layer_lines(found, study, cell, without)
        yield from _cluster_words(found, cell, without)
    for _, row in found.cells.iterrows():
        for words in _cautions(row, settings):
            yield f"cell {row['cell']}{words}"
    if skipped := not_tested(found):
        yield skipped
    yield from _power_words(found.cells, windows)
    yield f"{counted(layers['cell'].nunique(), 'cell')} correlated: {found.path}"


def _what_comes(with_: str) -> str:
    from cytodisk.runs.channel_names import VELOCITIES

    return "the edge moves" if with_ in VELOCITIES else f"{with_} comes"


def _of_what(settings: dict[str, Any]) -> str:
    return "" if settings.get("statistic", "pearson") == "pearson" else "Spearman correlation of ranks, "


def verdict_lines(found: "Correlation") -> Iterator[str]:
    """The last lines, one a cell: what nothing known speaks against, and what waits for flags."""
    from cytodisk.runs.correlate.verdict import verdict_words

    for cell in found.cells["cell"].tolist():
        if words := verdict_words(found, int(cell)):
            yield f"cell {cell}. {words}"


def finding_lines(found: "Correlation", study: "Study") -> Iterator[str]:
    """What the correlation shows, in the sentences of the report, of the first cells."""
    from cytodisk.runs.findings.correlation_finding import correlation_finding
    from cytodisk.runs.findings.doubt_words import bearing_flags
    from cytodisk.runs.qc_flags.study_flags import run_flags

    flags = run_flags(study)
    cells = [int(cell) for cell in found.cells.loc[found.cells["status"] == "ok", "cell"]]
    for cell in cells[:_MOST_FINDINGS]:
        finding = correlation_finding(study, found, cell, bearing_flags(flags, cell))
        if finding is not None:
            yield f"Finding, cell {cell}: {finding.words}"
    if (more := len(cells) - _MOST_FINDINGS) > 0:
        yield f"… and those of {counted(more, 'more cell')}: they stand in the report"


def earlier_settings(study: "Study", *names: str) -> dict[str, Any] | None:
    """Settings of a correlation that the next one will replace."""
    there = {(*one, "")[:3] for one in study.correlations}
    return study.correlation(*names).settings if names in there else None


def replaced_words(before: dict[str, Any] | None, now: dict[str, Any]) -> str:
    """Which settings the correlation that will be replaced has, if others; empty if there is none."""
    if before is None:
        return ""
    usual = "max_lag" if now["max_lag"] is None else ""  # which that is, is known at the end
    told = changed_settings(before, {name: value for name, value in now.items() if name != usual})
    return f"The earlier correlation ({', '.join(told)}) will be replaced" if told else ""


def changed_settings(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Earlier settings that are others now, in words, as "--detrend none"."""
    changed = [name for name in now if name in before and not _same(before[name], now[name])]
    return [_setting_words(name, before[name]) for name in changed]


def _same(before: Any, now: Any) -> bool:
    """Whether settings are equal, of which those of a file have lists for tuples."""
    both = [list(one) if isinstance(one, tuple | list) else one for one in (before, now)]
    return bool(both[0] == both[1])


def _setting_words(name: str, value: Any) -> str:
    """A setting in words, as "all lags" or "--detrend none"."""
    flag = f"--{name.replace('_', '-')}"
    if value is None or value in ([], ()):
        whole = {"skip_lags": "all lags", "sectors": "all sectors", "frames": "all frames"}
        return (
            f"with {whole.get(name, whole['frames'])}" if name in (*whole, "without_frames") else f"no {flag}"
        )
    if isinstance(value, bool):
        return flag if value else f"--no-{flag[2:]}"
    shown = ",".join(map(str, value)) if isinstance(value, tuple | list) else value
    return f"{flag} {shown}"


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
        yield ": too few frames to see whether masks jitter, which correlates by itself at lags −1 and 0"


def _power_words(cells: Any, windows: Any) -> Iterator[str]:
    """How many windows must be beyond all surrogates for any q to be below 0.05."""
    surrogates = int(cells["surrogates"].max())
    if not surrogates:
        return
    tested = int(windows["q"].notna().groupby(windows["cell"]).sum().max())
    fewest = tested * 20 // (surrogates + 1) + 1  # q = tested / (number · (surrogates + 1)) < 1 / 20
    if fewest > tested > 0:
        yield f"{surrogates} surrogates are too few for any q below 0.05: see --surrogates and --null"
    elif tested and fewest > 1:
        yield (
            f"A patch of fewer than {fewest} windows cannot reach q < 0.05. To find one, use "
            f"--surrogates {_enough(tested, surrogates)} or fewer --sectors."
        )


def _enough(tested: int, surrogates: int) -> int:
    """More surrogates, with which one or two windows can have q below 0.05, if that is not too many."""
    number = tested * 20 // (surrogates + 1)
    made = (count for count in (999, 1999, 4999, 9999) if tested * 20 // (count + 1) < min(number, 2))
    return next(made, 5 * (surrogates + 1) - 1)


def _cluster_words(found: "Correlation", cell: Any, without: str) -> Iterator[str]:
    """The clusters of a cell, the largest first."""
    if found.clusters is None:
        return
    clusters = found.clusters[found.clusters["cell"] == cell]
    if clusters.empty:
        yield f"cell {cell}, clusters of neighbouring windows: none with p ≤ 0.05"
        return
    yield f"cell {cell}, clusters of neighbouring windows, p ≤ 0.05 (their borders are not exact):"
    for one in clusters.head(_MOST_CLUSTERS).itertuples():
        yield _cluster_line(one, found.with_, without)
    if len(clusters) > _MOST_CLUSTERS:
        yield f"  and {len(clusters) - _MOST_CLUSTERS} smaller: clusters.parquet has them all"


def _cluster_line(row: Any, with_: str, without: str) -> str:
    from cytodisk.runs.correlate.cluster_words import cluster_place
    from cytodisk.runs.partial_words import region_left

    words = (
        f"  cluster {row.cluster}, {cluster_place(row)}: {_which_first(row.lag, with_)}, "
        f"mean r {signed(row.correlation)} in {counted(row.windows, 'window')}, p = {row.p:.2g}"
    )
    return "; ".join(filter(None, [words, region_left(row, without)]))


def _which_first(lag: int, with_: str) -> str:
    if not lag:
        return f"{_what_comes(with_)} with the signal"
    return f"{_what_comes(with_)} {'after' if lag > 0 else 'before'} the signal"
