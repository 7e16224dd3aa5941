"""Lists of names in messages, which may be long."""

from __future__ import annotations

from collections.abc import Sequence


def shortened(names: Sequence[str], shown: int = 3) -> str:
    """The first of some names, and how many more there are.

    Parameters
    ----------
    names : sequence of str
    shown : int
        How many are named.

    Examples
    --------
    >>> from cytodisk.images.short_lists import shortened
    >>> shortened(["t1.tif", "t2.tif", "t3.tif", "t4.tif"])
    't1.tif, t2.tif, t3.tif and 1 more'
    """
    listed = ", ".join(names[:shown])
    return f"{listed} and {len(names) - shown} more" if len(names) > shown else listed
