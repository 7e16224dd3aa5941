"""The table of `cytodisk population --power` in a folder, with its picture."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cytodisk.errors import StudyError
from cytodisk.files import writing_to

if TYPE_CHECKING:
    import pandas as pd

_TABLE = "power.csv"


def refuse_kept_plan(folder: Path) -> None:
    """Raise StudyError where a plan is there already, or the folder cannot be one."""
    if folder.exists() and not folder.is_dir():
        raise StudyError(f"output {folder} is a file: pass a folder")
    if (folder / _TABLE).exists():
        raise StudyError(f"{folder / _TABLE} is there already: pass --overwrite, or another folder")


def keep_plan(folder: Path, table: "pd.DataFrame", notes: Sequence[str], formats: Sequence[str]) -> None:
    """Write the table of a plan, and its picture.

    Parameters
    ----------
    folder : Path
        Is made if need be.
    table : DataFrame
        See `population_power`.
    notes : sequence of str
        What was assumed or measured.
    formats : sequence of {"png", "pdf", "svg"}
        None for no picture.

    Raises
    ------
    StudyError
        The folder cannot be written.
    """
    from cytodisk.pages.population.power_page import write_power_figure
    from cytodisk.store.csv_tables import write_csv

    with writing_to(folder):
        folder.mkdir(parents=True, exist_ok=True)
        write_csv(table, folder / _TABLE)
    if formats:
        known, _, shares = notes[0].partition(": ")
        write_power_figure(folder, table, notes=[known, *shares.split(", ")], formats=formats)
