"""`cytodisk export`."""

from pathlib import Path
from typing import Annotated

import typer

from cytodisk.cli.console import console_for, count, progress_bar
from cytodisk.cli.options import Given, Quiet, with_parameters
from cytodisk.runs.run_options import ExportOptions
from cytodisk.store.spatial.place_parameters import SpatialParameters


@with_parameters(SpatialParameters, ExportOptions, file=False)
def export_command(
    given: Given,
    study: Annotated[
        Path,
        typer.Argument(metavar="STUDY", help="Folder of a study of map or movie.", show_default=False),
    ],
    out: Annotated[
        Path,
        typer.Option("--out", "-o", metavar="FOLDER", help="Folder for the files.", show_default=False),
    ],
    formats: Annotated[
        str,
        typer.Option(
            "--to",
            metavar="A,B,…",
            help="roi (ImageJ and Fiji), geojson (QuPath), spatialdata (scverse), or several.",
            show_default=False,
        ),
    ],
    quiet: Quiet = False,
) -> None:
    from cytodisk.cli.report.report_command import opened
    from cytodisk.runs.export.run_export import run_export
    from cytodisk.store.spatial.study_places import left_out_words

    console = console_for(quiet)
    parameters = given.of(SpatialParameters)
    there = opened(console, study)
    kinds = [word.strip() for word in formats.split(",") if word.strip()]
    with progress_bar(quiet, "images", stopped="Stopped in the middle of a file.") as bar:
        files = run_export(
            study, out, kinds, progress=bar, **dict(parameters), **dict(given.options(ExportOptions))
        )
    lost = left_out_words(there, parameters)
    if lost:
        console.print(f"without a map, so left out: {count(len(lost))}; the first: {lost[0]}")
    for file in files:
        console.print(f"written: {file}")
