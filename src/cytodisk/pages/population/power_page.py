"""Page of how often an effect is found."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from cytodisk.pages.drawn_correlation import broken_lines
from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.figure_formats import chosen_formats, save_in_formats
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.population.power_curves import draw_power
from cytodisk.plot.style import SINGLE_COLUMN_MM, paper_style

_TALL, _LEFT, _RIGHT, _LINE = 48.0, 14.5, 14.0, 3.6  # mm


def write_power_figure(
    folder: Path,
    power: pd.DataFrame,
    *,
    notes: Sequence[str] = (),
    label: str = "experiments of each condition",
    effect: str = "effect size\n(sd of cells)",
    formats: Sequence[str] = ("png",),
) -> list[Path]:
    """Write the share of studies that find an effect against the number of experiments.

    Parameters
    ----------
    folder : Path
        Exists; gets `power.<format>`, 85 mm wide.
    power : DataFrame
        experiments, effect_size and detection, a share from 0 to 1.
    notes : sequence of str
        What was assumed, above the picture: cells of an experiment, variance between experiments, design.
    label : str
        Of the axis of experiments.
    effect : str
        What the numbers at the ends of the lines are.
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
    write_population_figures : Pictures of what was found.

    Examples
    --------
    >>> from pathlib import Path
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> power = pd.DataFrame({"experiments": [4, 8], "effect_size": 1.0, "detection": [0.3, 0.7]})
    >>> [path.name for path in cd.pages.write_power_figure(Path("."), power)]
    ['power.png']
    """
    chosen = chosen_formats(formats)
    room = SINGLE_COLUMN_MM - 2 * LEFT_MM
    lines = broken_lines(list(notes), " · ", room) if notes else []
    top = 7.0 + _LINE * len(lines) + 9.0
    with paper_style():
        sheet = Sheet(top + _TALL + 11.0, SINGLE_COLUMN_MM)
        sheet.text(LEFT_MM, 4.5, "How many experiments does it take?", fontsize=8, weight="bold")
        for number, words in enumerate(lines):
            sheet.text(LEFT_MM, 8.3 + _LINE * number, words, color="0.3")
        ax = sheet.axes(_LEFT, top, SINGLE_COLUMN_MM - _LEFT - _RIGHT, _TALL)
        draw_power(ax, power, label=label, effect=effect)
        return save_in_formats(sheet, Path(folder), "power", chosen)
