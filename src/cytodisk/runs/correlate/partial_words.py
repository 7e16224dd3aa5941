"""What was regressed out of a correlation, in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cytodisk.runs.channel_names import shown_name


def regressed_out(settings: Mapping[str, Any], not_tested: str = "") -> str:
    """What was regressed out of the signals.

    Parameters
    ----------
    settings : dict
        Of a study's correlation.
    not_tested : str
        Why geometry is not among it; empty if it is.

    Returns
    -------
    str
        As "geometry and volume"; empty for nothing.
    """
    names = ["geometry"] if settings.get("geometry") and not not_tested else []
    names += [shown_name(name) for name in settings.get("control") or ()]
    return " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))
