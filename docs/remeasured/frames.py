"""Windows of the melanoma cell in a few frames, by each method: Fig. S3 of the paper."""

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import tifffile

import cytodisk as cd
from cytodisk.files import replacing
from cytodisk.plot.cell.window_labels import draw_label_image
from cytodisk.plot.style import DPI, PAPER
from cytodisk.runs.compare_windows.compare_parameters import TITLES
from cytodisk.runs.compare_windows.laid_frames import lay_frames
from cytodisk.windows.edge_windows import EdgeGrid
from cytodisk.windows.springs.spring_windows import SpringGrid
from remeasured.movies import LAYERS, MOVIES, SECTORS

FRAMES = (0, 13, 26, 39)
METHODS = ("newton", "edge", "springs", "registered")


def measure(data: Path, work: Path) -> list[dict[str, Any]]:
    """The cell's mask and the labels of each kind of windows in each frame; kept in a file."""
    kept = work / "frames.npz"
    if not kept.exists():
        arrays = {
            f"{time}/{name}": labels
            for time, found in zip(FRAMES, _lay(data), strict=True)
            for name, labels in found.items()
        }
        with replacing(kept) as temporary:
            np.savez_compressed(temporary, **arrays)
    with np.load(kept) as arrays:
        return [{name: arrays[f"{time}/{name}"] for name in ("mask", *METHODS)} for time in FRAMES]


def _lay(data: Path) -> list[dict[str, Any]]:
    masks, _, more = MOVIES["melanoma"]
    movie = cd.map_movie(tifffile.imread(data / masks))
    polar, deep = cd.polar_windows(LAYERS, SECTORS), (LAYERS, SECTORS, more["depth_px"])
    grids = {"newton": polar, "edge": EdgeGrid(*deep), "springs": SpringGrid(*deep), "registered": polar}
    found: dict[int, dict[str, Any]] = {time: {"mask": movie[time].mask} for time in FRAMES}
    for method, grid in grids.items():
        for laid in lay_frames(method, movie, grid):
            if laid.frame in FRAMES:
                found[laid.frame][method] = laid.windows.labels
    return list(found.values())


def write(found: dict[str, Any], files: Path) -> dict[str, Any]:
    """The picture, `frames.png`."""
    frames = found["frames"]
    together = np.logical_or.reduce([frame["mask"] for frame in frames])
    rows, columns = (slice(side.min(), side.max() + 1) for side in np.nonzero(together))
    with plt.rc_context(PAPER):
        figure, axes = plt.subplots(len(METHODS), len(FRAMES), figsize=(4.68, 5.2), layout="constrained")
        for column, (time, frame) in enumerate(zip(FRAMES, frames, strict=True)):
            axes[0, column].set_title(f"frame {time}")
            for row, method in enumerate(METHODS):
                labels = frame[method][rows, columns]
                ax, mask = axes[row, column], frame["mask"][rows, columns]
                draw_label_image(ax, labels, mask, (LAYERS, SECTORS))
                ax.set_axis_off()
        for row, method in enumerate(METHODS):
            axes[row, 0].text(
                -0.06,
                0.5,
                TITLES[method],
                rotation=90,
                va="center",
                ha="right",
                transform=axes[row, 0].transAxes,
            )
        figure.savefig(files / "frames.png", dpi=DPI)
        plt.close(figure)
    return {}
