"""The activity of a movie as pictures: sectors downwards, time to the right, one slice a layer of windows."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.top_speed import top_speed
from cytodisk.errors import ReadError
from cytodisk.napari.given.layer_kinds import MARK
from cytodisk.napari.study_layers.layers_of_study import LayerData
from cytodisk.napari.study_layers.study_in_viewer import ShownStudy
from cytodisk.plot.style import DIVERGING_COLOURS, SIGNAL_COLOURS, signal_limits
from cytodisk.runs.channel_names import shown_name
from cytodisk.store.activity_store import open_activity
from cytodisk.store.study import open_study

_GAP = 6  # rows between pictures


def activity_layers(
    path: Path, cell: int | None = None, *, shown: ShownStudy | None = None, left: float = 0.0
) -> list[LayerData]:
    """Means of each channel and velocity of the edge by sector and frame.

    Parameters
    ----------
    path : Path
        The activity of a study.
    cell : int, optional
        By default the first one of the study.
    shown : ShownStudy, optional
        That they are the layers of, where the study has no maps.
    left : float
        Where their left side is, beside what is open.

    Returns
    -------
    list of (data, settings, kind)
        Each picture has the axes layer, sector and frame, velocity sector and frame. They lie below each
        other.

    Raises
    ------
    ReadError
        The file is damaged, or holds no such cell.
    """
    activity, number = _activity(path, cell)
    mark = {"study": str(path.parent), "cell": number} | ({} if shown is None else {"shown": shown})
    return list(_pictures(activity, mark, left))


def _activity(path: Path, cell: int | None) -> tuple[xr.Dataset, int]:
    try:
        study = open_study(path.parent)
    except ReadError:
        number = 0 if cell is None else cell  # the store has been moved, or its study is damaged
        return open_activity(path, number), number
    number = int(study.cells["cell"].iloc[0]) if cell is None else cell
    return study.activity(number), number


def _pictures(activity: xr.Dataset, of_study: dict[str, Any], left: float) -> Iterator[LayerData]:
    frames, sectors = activity.sizes["time"], activity.sizes["sector"]
    first = int(activity["frame"].to_numpy()[0])
    interval = activity.attrs.get("frame_interval_s")
    time = "frame" if interval is None else f"frame, {interval:g} s each"
    wide = max(1.0, round(sectors / frames, 2))  # a short movie is stretched, so that it can be seen

    def settings(role: str, name: str, row: int, **more: Any) -> dict[str, Any]:
        mark = {MARK: of_study | {"role": role}}
        place = {"scale": (1.0, wide), "translate": (row * (sectors + _GAP), left + first * wide)}
        axes = {"axis_labels": ("sector", time), "units": ("pixel", "pixel")}
        return {"name": f"{name}, cell {of_study['cell']}", "metadata": mark} | place | axes | more

    velocity = np.asarray(activity["velocity"].transpose("sector", "time"))
    top, unit = top_speed(velocity), activity["velocity"].attrs.get("units", "")
    look = {"colormap": DIVERGING_COLOURS, "contrast_limits": (-top, top)}
    yield velocity, settings("activity: velocity", f"velocity of the edge ({unit})", 0, **look), "image"
    if "mean" not in activity:
        return
    means = np.asarray(activity["mean"].transpose("channel", "layer", "sector", "time"))
    for row, name in enumerate(activity["channel"].to_numpy(), start=1):
        values = means[row - 1]
        told = settings(f"activity: {name}", f"mean of {shown_name(str(name))} by layer", row)
        told["scale"], told["translate"] = (1.0, *told["scale"]), (0.0, *told["translate"])
        told["axis_labels"], told["units"] = ("layer", *told["axis_labels"]), ("pixel",) * 3
        look = {"colormap": SIGNAL_COLOURS, "contrast_limits": signal_limits(values)}
        yield values, told | look, "image"
