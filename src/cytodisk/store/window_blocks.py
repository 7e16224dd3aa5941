"""Read a study's largest table block by block, so that memory does not grow with the movie."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from cytodisk.store.merging import ROWS_AT_ONCE
from cytodisk.store.study import WINDOWS, Study
from cytodisk.store.table_file import opened_table


def has_signal(study: Study) -> bool:
    """Whether the table of windows holds means of a signal."""
    if _is_read(study):
        return "mean" in study.windows
    with opened_table(study.path / WINDOWS) as file:
        return "mean" in file.schema_arrow.names


def window_blocks(study: Study, *columns: str) -> Iterator[pd.DataFrame]:
    """Some columns of `Study.windows`, a block of rows after the other.

    Parameters
    ----------
    study : Study
    *columns : str

    Yields
    ------
    DataFrame
        The whole at once where the table is in memory already.
    """
    if _is_read(study):
        yield study.windows[list(columns)]
        return
    with opened_table(study.path / WINDOWS) as file:
        for block in file.iter_batches(batch_size=ROWS_AT_ONCE, columns=list(columns)):
            yield block.to_pandas()


def _is_read(study: Study) -> bool:
    return "windows" in vars(study)
