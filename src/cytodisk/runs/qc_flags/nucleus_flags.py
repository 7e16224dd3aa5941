"""QC flags of nuclei: cut at the cell's edge, several in one cell, or none."""

from collections.abc import Iterator

from cytodisk.runs.qc_flags.column_flags import ColumnRule, said
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.store.study import Study

nucleus_clipped = ColumnRule(
    "nucleus clipped",
    "the nucleus was clipped at the cell's edge in {frames}",
    "The nucleus as it came touched the cell's edge, or lay partly outside: one of the two masks is wrong "
    "there, and the cytoplasm between them is thinner than it is.",
    "Look at both masks over the image; correct the one that is wrong.",
    "nucleus_clipped_share",
    lambda column, scale: column > 0,
    lambda value, row, scale: f"{value:.0%} of its outline, {_lost(row):.0f} px",
)
several_nuclei = ColumnRule(
    "several nuclei",
    "there are several nuclei in {frames}",
    "The cell was mapped with the largest of them, or with all joined: it may be several cells in one mask, "
    "a cell with two nuclei, or a nucleus in fragments.",
    "Look at the cell; split the mask, or complete the nucleus.",
    "n_nuclei",
    lambda column, scale: column > 1,
    lambda value, row, scale: f"{value:.0f} nuclei",
    unless="nucleus_held",
)
_MAPPED_WITHOUT = ColumnRule(
    "nucleus missing",
    "there is no nucleus in {frames}, mapped without",
    "Layers of such a map go from the cell's edge to its middle, and are no layers of cytoplasm or nucleus: "
    "they do not go with those of the other cells.",
    "Complete the nuclei, or leave these rows out (nucleus_status is none).",
    "nucleus_status",
    lambda column, scale: column == "none",
    lambda value, row, scale: "",
)
nucleus_held = ColumnRule(
    "nucleus held",
    "the nucleus of the frame before stands in {frames}",
    "There was none that could be used; the last one was moved as the cell moved. What the nucleus itself "
    "did there is not known.",
    "Complete the nuclei; if these frames matter, leave them out (nucleus_held says why).",
    "nucleus_held",
    said,
    lambda value, row, scale: str(value),
)
nucleus_restarted = ColumnRule(
    "nucleus followed anew",
    "following the nucleus starts anew in {frames}",
    "Its outline is too far from the one before to be followed; places at and in the nucleus do not go with "
    "those before.",
    "Look at the nucleus before and after; compare it within each stretch alone.",
    "nucleus_restarted",
    said,
    lambda value, row, scale: str(value),
)


def nucleus_missing(study: Study) -> Iterator[QCFlag]:
    """Cells mapped without a nucleus in a study of cells with nuclei; in movies there are none."""
    if not study.is_movie:
        yield from _MAPPED_WITHOUT(study)


def _lost(row: dict[str, float]) -> float:
    return row["nucleus_clipped_px"] + row["nucleus_outside_px"]
