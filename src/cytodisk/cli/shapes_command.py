"""`cytodisk shapes`."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cytodisk.cli.console import console_for, count, fail, progress_bar, say_losses
from cytodisk.cli.first_start import say_compiling
from cytodisk.cli.map_command import say_inputs
from cytodisk.cli.options import (
    Given,
    GroupsFile,
    MaskFiles,
    OutFolder,
    Quiet,
    with_parameters,
)
from cytodisk.runs.run_options import FigureOptions, RunOptions
from cytodisk.runs.shapes.shape_parameters import ShapeParameters
from cytodisk.runs.told.map_words import reason_lines
from cytodisk.runs.told.mask_sizes import scale_words

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

    from cytodisk.runs.cells.cell_inputs import CellInputs

_LEAST_SHARE = 0.65  # of the plane's variance along the axis, below which the axis says little
_FAR_FROM_LINE = (
    "look at figures/complexity.png: the shapes do not lie along one axis, so the score says little"
)


@with_parameters(ShapeParameters, RunOptions, FigureOptions, groups=GroupsFile)
def shapes_command(
    masks: MaskFiles,
    out: OutFolder,
    given: Given,
    quiet: Quiet = False,
) -> None:
    from cytodisk.runs.shapes.shape_study import open_shape_inputs, shape_study

    settings, options = given.of(ShapeParameters), given.options(RunOptions)
    formats = given.formats(1)
    console = console_for(quiet)
    inputs = open_shape_inputs(masks, settings, given.groups)
    say_inputs(console, inputs)
    say_compiling(quiet, "shapes")
    with progress_bar(quiet, "cells") as progress:
        table = shape_study(inputs, out, settings, progress=progress, **dict(options))
    _draw(inputs, table, out, formats)
    for line in scale_words(table.loc[table["status"] == "ok", "equivalent_diameter"], inputs.scale):
        console.print(line)
    _say(console, table, out)


def _draw(inputs: "CellInputs", table: "pd.DataFrame", out: Path, formats: Sequence[str]) -> None:
    from cytodisk.pages.shape_pages import cells_to_draw, write_shape_figures
    from cytodisk.runs.shapes.shape_study import cleaned_masks
    from cytodisk.store.figures_folder import drawing

    if table["complexity"].notna().any():
        masks = cleaned_masks(inputs, cells_to_draw(table))
        names = [f"{name}.{kind}" for name in ("complexity", "extremes") for kind in formats]
        with drawing(out, *names) as folder:
            write_shape_figures(folder, table, masks, inputs.scale, formats=formats)


def _say(console: "Console", table: "pd.DataFrame", out: Path) -> None:
    """Say what came out; exit code 2 if that is nothing, or an input is damaged."""
    from cytodisk.analysis.shape.complexity import why_unscored

    measured, lost = table[table["status"] == "ok"], table[table["status"] != "ok"]
    status = table["status"].value_counts()
    refused = [f"{status['refused']} refused"] if "refused" in status else []
    files, cells = count(table["source"].nunique(), "file"), int((table["label"] != 0).sum())
    console.print(f"{files}, {count(cells)}: " + "; ".join([f"{len(measured)} measured", *refused]))
    if cells < len(table):
        console.print(f"files or images without a cell: {len(table) - cells}")
    border = int(measured["touches_border"].sum())
    console.print(f"on the image border, so measured in part: {count(border)}")
    _say_qc_flags(console, measured)
    say_losses(reason_lines(zip(lost["cell"], lost["source"], lost["status"], lost["reason"], strict=True)))
    if measured["complexity"].notna().any():
        _say_complexity(console, measured)
    elif len(measured):
        console.print(f"no complexity: {why_unscored(table)}")
    console.print(f"results: {out}")
    if measured.empty:
        fail(f"no cell could be measured: {lost['reason'].iloc[0]}")
    if "unreadable" in status:
        fail(f"damaged files or frames of the input: {status['unreadable']}; all others are in {out}")


def _say_qc_flags(console: "Console", measured: "pd.DataFrame") -> None:
    from cytodisk.analysis.shape.curvature_features import RESOLVED_PX
    from cytodisk.analysis.shape.features import split_qc_flags

    small, others = split_qc_flags(measured["qc_flags"])
    if flagged := int((others != "").sum()):
        console.print(f"perhaps not one whole cell: {flagged}, column 'qc_flags' of shapes.parquet")
    if small.any():
        console.print(
            f"equivalent diameter below {RESOLVED_PX:.0f} px: {small.sum()} of {count(len(measured))}; their "
            "curvature and roughness depend on the resolution: compare them with cells of the same size only"
        )


def _say_complexity(console: "Console", measured: "pd.DataFrame") -> None:
    from cytodisk.analysis.shape.complexity import principal_axis

    _, share = principal_axis(measured[["umap_1", "umap_2"]].to_numpy())
    ranked = measured.sort_values("complexity", kind="stable")
    least, most = (
        ", ".join(f"{cell} ({source})" for cell, source in zip(some["cell"], some["source"], strict=True))
        for some in (ranked.head(3), ranked.tail(3)[::-1])
    )
    console.print(f"complexity: {share:.0%} of the plane's variance lies along its axis")
    console.print(f"least complex cells: {least}")
    console.print(f"most complex cells: {most}")
    if share < _LEAST_SHARE:
        console.print(_FAR_FROM_LINE)
