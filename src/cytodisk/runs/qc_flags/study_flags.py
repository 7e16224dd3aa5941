"""`qc_flags`: what in a study deserves a second look before its numbers are believed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from cytodisk.number_words import counted
from cytodisk.runs.qc_flags import (
    area_jumps,
    column_flags,
    compartment_flags,
    correlation_flags,
    geometry_flags,
    input_flags,
    interior_flags,
    motion_flags,
    nucleus_flags,
    nucleus_jumps,
    prediction_flags,
    stress_flags,
    wave_flags,
    window_flags,
)
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.store.study import Study


def qc_flags(study: Study) -> list[QCFlag]:
    """Look for faults in a study's tables, over all of its cells.

    Parameters
    ----------
    study : Study
        Study of a movie or of single masks. Pixels are not read.

    Returns
    -------
    list of QCFlag
        The gravest first; empty if there are none. A frame may stand in several.

    See Also
    --------
    write_report : The page shows them first.

    Notes
    -----
    A frame is compared with the other frames of its own cell where cells differ by nature (area, velocity),
    by the median of absolute values, so that the faults themselves do not raise the bar; the thresholds are
    the constants of the modules beside this one.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=5, radius_px=12.0)
    >>> tifffile.imwrite("masks.tif", truth.masks.astype("uint8"), metadata={"axes": "TYX"})
    >>> study = cd.run_movie("masks.tif", "out", layers=2, sectors=6)
    >>> cd.qc_flags(study)  # nothing to doubt
    []
    """
    found = [
        *run_flags(study),
        *correlation_flags_of(study),
        *prediction_flags_of(study),
        *wave_flags_of(study),
    ]
    return [*found, *_other_warnings(study, found)]


def run_flags(study: Study) -> list[QCFlag]:
    """Those of the run itself: masks, maps, motion, windows, signals."""
    return [flag for rule in _RUN_RULES for flag in rule(study)]


def correlation_flags_of(study: Study) -> list[QCFlag]:
    """Those of the study's correlations."""
    return [flag for rule in _CORRELATION_RULES for flag in rule(study)]


def prediction_flags_of(study: Study) -> list[QCFlag]:
    """Those of the study's predictions."""
    return [flag for rule in prediction_flags.PREDICTION_RULES for flag in rule(study)]


def wave_flags_of(study: Study) -> list[QCFlag]:
    """Those of the study's waves."""
    return [flag for rule in _WAVE_RULES for flag in rule(study)]


def _other_warnings(study: Study, found: Sequence[QCFlag]) -> Iterator[QCFlag]:
    """Warnings of the run that no other flag tells already."""
    told = {(place.cell, place.frame) for flag in found for place in flag.places}
    heads = tuple(head for cell, frame in told for head in _heads(study, cell, frame))
    warnings = [str(words) for words in study.provenance.get("warnings", [])]
    other = [words for words in warnings if not words.startswith(heads)]
    if other:
        yield QCFlag(
            "warnings",
            f"{counted(len(other), 'warning')} of the run: " + "; ".join(other[:5]),
            "The run went on, but something was out of the ordinary.",
            "Read them all in provenance.json.",
        )


def _heads(study: Study, cell: int, frame: int | None) -> Iterator[str]:
    """How a run's warning about a cell may start."""
    if study.is_movie:
        yield f"cell {cell}, frame {frame}:"
        return
    yield f"cell {cell}:"
    if "source" in study.cells:
        (source,) = study.cells.loc[study.cells["cell"] == cell, "source"]
        yield f"cell {cell} of {source}:"
        yield f"{source}:"  # a file without a cell


_RUN_RULES: tuple[Callable[[Study], Iterator[QCFlag]], ...] = (
    column_flags.without_map,
    column_flags.flagged_masks,
    nucleus_flags.nucleus_missing,
    nucleus_flags.nucleus_held,
    nucleus_flags.nucleus_restarted,
    nucleus_jumps.nucleus_jumps,
    nucleus_flags.several_nuclei,
    nucleus_flags.nucleus_clipped,
    compartment_flags.nucleus_in_the_middle,
    compartment_flags.no_ratio,
    area_jumps.area_jumps,
    input_flags.implausible_scale,
    input_flags.clipped_signal,
    input_flags.saturated_signal,
    input_flags.coarse_outline,
    motion_flags.fast_edge,
    motion_flags.edge_mismatch,
    column_flags.tracking_residual,
    column_flags.order_violations,
    column_flags.tracking_restarts,
    interior_flags.interior_restarts,
    interior_flags.small_still_windows,
    column_flags.image_border,
    motion_flags.drift,
    window_flags.small_windows,
    interior_flags.distortion,
    column_flags.nan_pixels,
    compartment_flags.background,
)

_CORRELATION_RULES: tuple[Callable[[Study], Iterator[QCFlag]], ...] = (
    geometry_flags.geometry,
    correlation_flags.jitter,
    *stress_flags.STRESS_RULES,
    correlation_flags.drifting_series,
    geometry_flags.geometry_not_tested,
    correlation_flags.left_out,
)

_WAVE_RULES: tuple[Callable[[Study], Iterator[QCFlag]], ...] = (
    wave_flags.wave_doubt_flags,
    wave_flags.without_waves,
)
