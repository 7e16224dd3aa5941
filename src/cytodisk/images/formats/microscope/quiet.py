"""Reading libraries without what they print and warn of: what matters of it is said in notes and errors."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def quiet(library: str) -> Iterator[None]:
    """Keep a library from warning, and from printing lines of its log.

    Parameters
    ----------
    library : str
        Name of its logger.
    """
    log = logging.getLogger(library)
    before = log.disabled
    log.disabled = True
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        log.disabled = before
