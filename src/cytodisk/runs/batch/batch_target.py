"""Where the results of a batch go, and which run they belong to."""

from __future__ import annotations

from pathlib import Path
from uuid import uuid4

from cytodisk.errors import CytodiskError
from cytodisk.store.targets import FolderStore, Store
from cytodisk.store.url_store import UrlStore, is_url

RUN = ".cytodisk.run"
"""File with the name of the run that began last."""


def open_store(target: str) -> Store:
    """The place that results are written to.

    Parameters
    ----------
    target : str
        A folder, or the URL of an object store.

    Returns
    -------
    Store

    Raises
    ------
    MissingPartError, StudyError
        As for `UrlStore`.
    """
    return UrlStore(target) if is_url(target) else FolderStore(target)


def begin_run(target: str) -> str:
    """Take a folder or URL over: workers of an earlier run that are still at it publish nothing any more.

    Parameters
    ----------
    target : str

    Returns
    -------
    str
        The name of the run, which stands in the target now.

    Raises
    ------
    StudyError
        The target cannot be written.
    """
    run = uuid4().hex
    open_store(target).write_text(RUN, run)
    return run


def is_latest(run: str, store: Store) -> bool:
    """Whether no other run has begun since; a run without a name is not looked at."""
    there = store.read_text(RUN) if run else None
    return there is None or there == run


def what_is_hidden(target: str, run: str, *files: str) -> str:
    """What a worker, which this runs on, does not see; in words, empty if it sees all.

    Parameters
    ----------
    target : str
    run : str
        As `begin_run` returns it.
    *files : str
        Some of the inputs.

    Returns
    -------
    str
    """
    try:
        found = open_store(target).read_text(RUN)
    except CytodiskError as error:
        return f"does not reach the results: {error}"
    if found != run:
        return (
            f"does not see the results in {target}: pass a folder that is shared by all workers, under the "
            "same name everywhere, or the URL of an object store"
        )
    for file in files:
        if not Path(file).exists():
            return f"does not see input {file}: inputs must be on a folder that is shared by all workers"
    return ""
