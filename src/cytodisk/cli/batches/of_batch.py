"""Flags that are for the folder of a batch alone, or not for it."""

from pathlib import Path
from typing import Annotated

import typer

from cytodisk.cli.options import Given
from cytodisk.parameters import Parameters

GroupsOfBatch = Annotated[
    Path | None,
    typer.Option(
        metavar="PATH", help="Of a batch: table of groups, with the condition and experiment of cells."
    ),
]


def refuse_of_batch(study: Path, given: Given, *models: type[Parameters]) -> None:
    """Refuse what is for a batch alone, where a study is given.

    Parameters
    ----------
    study : Path
    given : Given
    *models : type of Parameters
        Those that a study has.
    """
    from cytodisk.errors import ParameterError

    of_batch = given.beyond(*models)
    of_batch += ["--groups"] * (given.groups is not None)
    if of_batch:
        raise ParameterError(
            f"{', '.join(of_batch)}: only for the folder of a batch, and {study} is none: leave it out"
        )


def refuse_cells(batch: Path, cells: list[int] | None) -> None:
    """Refuse --cell where a batch is given."""
    from cytodisk.errors import ParameterError

    if cells:
        raise ParameterError(f"{batch} is a batch, whose cells all count: leave --cell out")
