"""`cytodisk check`."""

from typing import TYPE_CHECKING, Annotated

import typer

from cytodisk.cli.console import console_for
from cytodisk.cli.map_command import say_inputs
from cytodisk.cli.options import Given, GroupsFile, MaskFiles, NucleiFiles, SignalFiles, with_parameters
from cytodisk.runs.cells.cell_parameters import CheckParameters

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.runs.cells.cell_inputs import CellInputs


@with_parameters(CheckParameters, file=False, groups=GroupsFile)
def check_command(
    masks: MaskFiles,
    given: Given,
    signal: SignalFiles = None,
    nuclei: NucleiFiles = None,
    every: Annotated[
        bool, typer.Option("--all", help="Print a line for every cell, or frame of a stack.")
    ] = False,
) -> None:
    from cytodisk.cli.contents_lines import say_contents
    from cytodisk.runs.cells.cell_groups import with_groups
    from cytodisk.runs.cells.cell_inputs import open_inputs
    from cytodisk.runs.map.checked_cells import check_cells
    from cytodisk.runs.told.checked_words import Checked

    console = console_for(False)
    say_contents(console, (masks, signal, nuclei))
    inputs = open_inputs(masks, signal, given.of(CheckParameters), nuclei=nuclei)
    inputs = with_groups(inputs, given.groups)
    say_inputs(console, inputs)
    _say_evidence(console, inputs)
    found = Checked(inputs)
    if every:
        print(found.header)
    for checked in check_cells(inputs):
        found.add(checked)
        if every:
            print(found.line(checked))
    for line in found.summary():
        print(line)
    raise typer.Exit(1 if found.faults else 0)


def _say_evidence(console: "Console", inputs: "CellInputs") -> None:
    """Why the files are taken for what they are, and how their axes are known; of a folder its first file."""
    source, signals = inputs.sources[0], inputs.signal_files
    look = source.look
    words = "" if look is None else look.file.evidence if look.evidence in look.file.notes else look.words
    found = [("masks", source.name, words)]  # notes were printed as warnings
    found += [("signal", file.path.name, file.evidence) for file in signals[:1]]
    found += [("nuclei", one.file.path.name, one.look.words) for one in inputs.nuclei_files[:1]]
    for role, name, words in found:
        if words:
            console.print(f"{role}: {words}" + (f" (as in {name})" if inputs.is_folder else ""))
