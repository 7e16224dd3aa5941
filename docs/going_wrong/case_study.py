"""Files and runs of a case: a simulated movie becomes a study, and its QC flags become lines."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import tifffile
from matplotlib.axes import Axes
from skimage.measure import find_contours

import cytodisk as cd
from cytodisk.runs.told.flag_words import flag_lines

INTERVAL_S, PIXEL_UM = 5.0, 0.16
NOTHING = "no QC flags"


def study_of(
    folder: Path, masks: Any, signals: Mapping[str, Any] | None = None, **parameters: Any
) -> cd.Study:
    """Run a movie as `cytodisk movie` does; it has a scale if it has a signal."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "masks.tif"
    tifffile.imwrite(path, np.asarray(masks).astype(np.uint8), metadata={"axes": "TYX"}, compression="zlib")
    signal = None
    if signals:
        signal = folder / "signal.ome.tif"
        metadata = {
            "axes": "TCYX",
            "Channel": {"Name": list(signals)},
            "PhysicalSizeX": PIXEL_UM,
            "PhysicalSizeY": PIXEL_UM,
            "TimeIncrement": INTERVAL_S,
            "TimeIncrementUnit": "s",
        }
        image = np.stack([np.asarray(values) for values in signals.values()], axis=1)
        tifffile.imwrite(
            signal, image.astype(np.float32), metadata=metadata, photometric="minisblack", ome=True
        )
    return cd.run_movie(
        path, folder / "out", signal=signal, overwrite=True, **({"layers": 5, "sectors": 24} | parameters)
    )


def correlated(study: cd.Study, signal: str, **parameters: Any) -> cd.Study:
    """The study with a correlation of a signal with velocity."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        cd.run_correlate(study, signal, "velocity", **({"max_lag": 10, "surrogates": 499} | parameters))
    return cd.open_study(study.path)


def flags_said(study: cd.Study, *names: str) -> list[str]:
    """The lines that the command prints of these flags, or of all; a flag that does not come is an error."""
    flags = cd.qc_flags(study)
    missing = set(names) - {flag.name for flag in flags}
    if missing:
        raise ValueError(f"the run raised no flag {', '.join(sorted(missing))}, only {flags}")
    chosen = [flag for flag in flags if not names or flag.name in names]
    return list(flag_lines(chosen, "", {}))


def draw_outline(axes: Axes, mask: Any, **look: Any) -> None:
    """The outline of a mask, on axes with pixels as units."""
    for outline in find_contours(np.pad(np.asarray(mask, dtype=float), 1), 0.5):
        axes.plot(outline[:, 1] - 1, outline[:, 0] - 1, **({"linewidth": 0.8} | look))


def cell_axes(axes: Axes, title: str) -> None:
    """Axes of a picture: pixels are square, rows go down, no ticks."""
    axes.set_aspect("equal")
    axes.invert_yaxis()
    axes.set_xticks([])
    axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.set_title(title)
