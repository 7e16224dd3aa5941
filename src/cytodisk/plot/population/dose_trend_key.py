"""What the marks of a picture of a dose trend are, and their legend."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from cytodisk.plot.population.condition_looks import EXPERIMENT_COLOURS, EXPERIMENT_MARKS, Look
from cytodisk.plot.population.experiment_key import mean_look
from cytodisk.plot.style import LINE_COLOUR

BAND_STYLE: dict[str, Any] = {"color": "0.6", "alpha": 0.35, "linewidth": 0.0}
TREND_STYLE: dict[str, Any] = {"color": LINE_COLOUR, "linewidth": 1.2}


def dose_looks(cells: pd.DataFrame, dose: str) -> dict[str, Look]:
    """How the means of each experiment are drawn: alike, unless one has several doses."""
    doses = pd.to_numeric(cells[dose].astype(object), errors="coerce")
    known = pd.DataFrame({"experiment": cells["experiment"].fillna("").astype(str), "dose": doses}).dropna()
    units = known[known["experiment"] != ""].drop_duplicates()
    names = list(dict.fromkeys(units["experiment"]))
    if not units["experiment"].duplicated().any():
        return dict.fromkeys(names, Look(EXPERIMENT_COLOURS[0], EXPERIMENT_MARKS[0]))
    return {
        name: Look(
            EXPERIMENT_COLOURS[number % len(EXPERIMENT_COLOURS)],
            EXPERIMENT_MARKS[number % len(EXPERIMENT_MARKS)],
        )
        for number, name in enumerate(names)
    }


def dose_trend_key(cells: pd.DataFrame, dose: str = "dose") -> list[Any]:
    """Handles of a legend for `draw_dose_trend`: experiments, a cell, the line of the trend and its band.

    Parameters
    ----------
    cells : DataFrame
        experiment and the dose.
    dose : str

    Returns
    -------
    list of Artist

    See Also
    --------
    draw_dose_trend : Draws the marks.

    Examples
    --------
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> cells = pd.DataFrame({"experiment": ["day 1", "day 2"], "dose": [0.0, 10.0]})
    >>> [handle.get_label() for handle in cd.plot.dose_trend_key(cells)]
    ['mean of one experiment', 'cell', 'trend', 'its 95 % band']
    """
    looks = dose_looks(cells, dose)
    if len(looks) > 1 and len(set(looks.values())) == 1:
        looks = {"mean of one experiment": next(iter(looks.values()))}
    handles: list[Any] = [
        Line2D([], [], linewidth=0, label=name, **mean_look(look, 5.0)) for name, look in looks.items()
    ]
    handles.append(Line2D([], [], linewidth=0, marker="o", markersize=2.0, color="0.6", label="cell"))
    handles.append(Line2D([], [], label="trend", **TREND_STYLE))
    handles.append(Patch(label="its 95 % band", **BAND_STYLE))
    return handles
