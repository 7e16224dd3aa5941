"""Windows of the melanoma cell in a few frames, ours and edge-based: Fig. S3 of the paper."""

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import tifffile

import cytodisk as cd
from cytodisk.plot.cell.window_labels import draw_label_image
from cytodisk.plot.style import DPI, PAPER
from cytodisk.runs.compare_windows.compare_parameters import TITLES
from cytodisk.windows.edge_windows import EdgeGrid
from remeasured.movies import LAYERS, MOVIES, SECTORS

FRAMES = (0, 13, 26, 39)


def measure(data: Path) -> list[dict[str, Any]]:
    """The cell's mask and the labels of both kinds of windows in each frame."""
    masks, _, more = MOVIES["melanoma"]
    movie = cd.map_movie(tifffile.imread(data / masks))
    grids = {"newton": cd.polar_windows(LAYERS, SECTORS), "edge": EdgeGrid(LAYERS, SECTORS, more["depth_px"])}
    found = []
    for time in FRAMES:
        labels = {name: grid.on(movie[time]).labels for name, grid in grids.items()}
        found.append({"mask": movie[time].mask} | labels)
    return found


def write(found: dict[str, Any], files: Path) -> dict[str, Any]:
    """The picture, `frames.png`."""
    frames = found["frames"]
    together = np.logical_or.reduce([frame["mask"] for frame in frames])
    rows, columns = (slice(side.min(), side.max() + 1) for side in np.nonzero(together))
    with plt.rc_context(PAPER):
        figure, axes = plt.subplots(2, len(FRAMES), figsize=(7.1, 4.0), layout="constrained")
        for column, (time, frame) in enumerate(zip(FRAMES, frames, strict=True)):
            axes[0, column].set_title(f"frame {time}")
            for row, method in enumerate(("newton", "edge")):
                labels = frame[method][rows, columns]
                ax, mask = axes[row, column], frame["mask"][rows, columns]
                draw_label_image(ax, labels, mask, (LAYERS, SECTORS))
                ax.set_axis_off()
        for row, method in enumerate(("newton", "edge")):
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
