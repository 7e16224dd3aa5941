"""Read a study's largest table block by block, so that memory does not grow with the movie."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd
import pyarrow.parquet as pq

from cytodisk.store.merging import ROWS_AT_ONCE
from cytodisk.store.study import WINDOWS, Study


def has_signal(study: Study) -> bool:
    """Whether the table of windows holds means of a signal."""
    return "mean" in (study.windows if _is_read(study) else pq.read_schema(study.path / WINDOWS).names)


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
    with pq.ParquetFile(study.path / WINDOWS) as file:
        for block in file.iter_batches(batch_size=ROWS_AT_ONCE, columns=list(columns)):
            yield block.to_pandas()


def _is_read(study: Study) -> bool:
    return "windows" in vars(study)
