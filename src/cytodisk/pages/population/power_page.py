"""Page of how often an effect is found."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from cytodisk.errors import ParameterError
from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.figure_formats import chosen_formats, save_in_formats
from cytodisk.pages.sheet import Sheet, broken_lines
from cytodisk.plot.population.power_curves import draw_power
from cytodisk.plot.style import SINGLE_COLUMN_MM, paper_style

_FOUND = {
    "window": "a region: any of its windows (max-T)",
    "cluster": "a region: a cluster of windows",
    "scalar": "one number a cell, tested alone",
}
_DESIGNS = {"unpaired": "experiments of each condition", "paired": "pairs of experiments"}
_TALL, _LEFT, _GAP, _RIGHT, _TITLE, _BELOW, _LINE = 27.0, 14.5, 3.0, 9.0, 8.5, 9.5, 3.6  # mm


def write_power_figure(
    folder: Path, power: pd.DataFrame, *, notes: Sequence[str] = (), formats: Sequence[str] = ("png",)
) -> list[Path]:
    """Write how often an effect is found, against the number of experiments, by design and what is found.

    Parameters
    ----------
    folder : Path
        Exists; gets `power.<format>`, 85 mm wide.
    power : DataFrame
        As `population_power` returns it: design, experiments, effect and the shares window, cluster and
        scalar; each design is a column, each share that is there a row.
    notes : sequence of str
        What was assumed, above the picture: cells of an experiment, variance between experiments.
    formats : sequence of {"png", "pdf", "svg"}

    Returns
    -------
    list of Path

    Raises
    ------
    ParameterError
        A format is unknown, or the table lacks a column.
    StudyError
        The folder cannot be written.

    See Also
    --------
    population_power : Makes the table.

    Examples
    --------
    >>> from pathlib import Path
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> power = pd.DataFrame({"design": "paired", "experiments": [4, 8], "effect": 1.0, "window": [0.1, 0.7]})
    >>> [path.name for path in cd.pages.write_power_figure(Path("."), power)]
    ['power.png']
    """
    chosen = chosen_formats(formats)
    shares = [name for name in _FOUND if name in power]
    if "design" not in power or not shares:
        raise ParameterError("power has no column 'design' or no share: pass the table of population_power")
    with paper_style():
        return save_in_formats(_page(power, shares, notes), Path(folder), "power", chosen)


def _page(power: pd.DataFrame, shares: Sequence[str], notes: Sequence[str]) -> Sheet:
    designs = [name for name in _DESIGNS if (power["design"] == name).any()]
    lines = broken_lines(list(notes), " · ", SINGLE_COLUMN_MM - 2 * LEFT_MM) if notes else []
    top, step = 6.0 + _LINE * len(lines) + 1.0, _TITLE + _TALL + _BELOW
    sheet = Sheet(top + len(shares) * step, SINGLE_COLUMN_MM)
    sheet.title(LEFT_MM, 4.5, "How many experiments does it take?")
    for number, words in enumerate(lines):
        sheet.text(LEFT_MM, 8.3 + _LINE * number, words, color="0.3")
    wide = (SINGLE_COLUMN_MM - _LEFT - _RIGHT - (len(designs) - 1) * _GAP) / len(designs)
    for row, share in enumerate(shares):
        place = top + row * step + _TITLE
        sheet.text(LEFT_MM, place - 4.6, _FOUND[share], weight="bold")
        for column, design in enumerate(designs):
            ax = sheet.axes(_LEFT + column * (wide + _GAP), place, wide, _TALL)
            own, last = power[power["design"] == design], column == len(designs) - 1
            draw_power(ax, own, share, label=_DESIGNS[design], named=last)
            ax.set_title(design, loc="left", pad=2.0)
            if column:
                ax.set_ylabel("")
                ax.tick_params(labelleft=False)
        words = "effect (sd of cells)"
        sheet.text(SINGLE_COLUMN_MM - 3.0, place - 4.6, words, ha="right", color="0.3")
    return sheet
