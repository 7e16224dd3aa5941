"""`red_flags`: what in a study deserves a second look before its numbers are believed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from cytodisk.pages.report import correlation_flags, mask_flags, motion_flags
from cytodisk.pages.report.flag import Flag, counted
from cytodisk.store.study import Study


def red_flags(study: Study) -> list[Flag]:
    """Look for faults in a study's tables, over all of its cells.

    Parameters
    ----------
    study : Study
        Study of a movie or of single masks. Pixels are not read.

    Returns
    -------
    list of Flag
        The gravest first; empty if there are none. A frame may stand in several.

    Notes
    -----
    A frame is compared with the other frames of its own cell where cells differ by nature (area, velocity),
    by the median of absolute values, so that the faults themselves do not raise the bar; the thresholds are
    the constants of `mask_flags`, `motion_flags`, `drift` and `correlation_flags`.
    """
    found = [flag for rule in _RULES for flag in rule(study)]
    return [*found, *_other_warnings(study, found)]


def _other_warnings(study: Study, found: Sequence[Flag]) -> Iterator[Flag]:
    """Warnings of the run that no other flag tells already."""
    told = {(place.cell, place.time) for flag in found for place in flag.places}
    heads = tuple(f"cell {cell}, frame {time}:" for cell, time in told)
    warnings = [str(words) for words in study.provenance.get("warnings", [])]
    other = [words for words in warnings if not words.startswith(heads)]
    if other:
        yield Flag(
            "warnings",
            f"{counted(len(other), 'warning')} of the run: " + "; ".join(other[:5]),
            "The run went on, but something was out of the ordinary.",
            "Read them all in provenance.json.",
        )


_RULES: tuple[Callable[[Study], Iterator[Flag]], ...] = (
    mask_flags.without_map,
    mask_flags.doubts,
    motion_flags.area_jumps,
    motion_flags.fast_edge,
    motion_flags.residuals,
    motion_flags.order,
    motion_flags.restarts,
    mask_flags.border,
    motion_flags.drift,
    mask_flags.distortion,
    mask_flags.nan_pixels,
    correlation_flags.jitter,
    correlation_flags.drifting_series,
    correlation_flags.left_out,
)
