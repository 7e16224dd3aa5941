"""Progress of what is done in phases, and cell by cell."""

from __future__ import annotations

from cytodisk.runs.run_options import Progress


def phases(progress: Progress | None, count: int) -> list[Progress | None]:
    """What to call with the steps done, and all steps, of each phase; they count alike.

    Parameters
    ----------
    progress : callable or None
        Called with (steps done, in all).
    count : int
        Number of phases.
    """
    if progress is None:
        return [None] * count

    def phase(place: int) -> Progress:
        return lambda done, steps: progress(place * steps + done, count * steps)

    return [phase(place) for place in range(count)]


def percents(progress: Progress | None, place: int, cells: int) -> Progress | None:
    """What to call with the steps done and all steps of one of the cells, to report percents of all.

    Parameters
    ----------
    progress : callable or None
    place : int
        Of the cell among all.
    cells : int
        Number of all cells.
    """
    if progress is None:
        return None
    return lambda done, steps: progress(100 * place + round(100 * done / steps), 100 * cells)
