"""Draw the picture and write the table of the page "How fine a grid your cells bear".

    benchmarks/reproducibility.py --csv ROWS.csv
    docs/draw_how_fine.py ROWS.csv

Means over the cells of a class, with the default method. Writes into `docs/source/guides/how_fine_a_grid`.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.files import replacing
from cytodisk.plot.style import MM_PER_INCH, SINGLE_COLUMN_MM, paper_style

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "benchmarks"))
from cell_outlines import Shape, judges, others  # noqa: E402

TARGET = HERE / "source" / "guides" / "how_fine_a_grid"
HEIGHT_MM, DPI = 92.0, 300
GRIDS = {"5x30": "5 × 30", "10x60": "10 × 60", "20x120": "20 × 120"}
LOOKS = {"5x30": ("#0072B2", "o"), "10x60": ("#E69F00", "s"), "20x120": ("0.15", "^")}
CLASSES = {  # words, and the shape that stands for the class
    "round": ("round or oval", "ellipse 2:1"),
    "lobed": ("lobed, amoeboid", "blob"),
    "angular": ("with a corner", "L"),
    "star": ("broad or thin arms", "star"),
    "neck": ("two parts, a neck", "dumbbell"),
    "branched": ("branched", "branched cell"),
    "comb": ("row of arms", "comb"),
    "spiral": ("wound up", "spiral"),
    "elongated": ("long and thin", "ellipse 20:1"),
    "spiky": ("many thin spikes", "spiky"),
    "osteosarcoma": ("osteosarcoma (real)", ""),  # in the table alone
}
ENOUGH = 2.0 / 3.0  # of the points in the same window


def by_class(rows: pd.DataFrame) -> pd.DataFrame:
    """A row a class: means over cells and seeds, the class that bears most first."""
    chosen = rows[rows["method"] == MappingParameters().method]
    noisy = chosen[chosen["change"] == "noise"].groupby("family").mean(numeric_only=True)
    cells = chosen.groupby("family")["shape"].nunique()
    table = noisy.assign(cells=cells).loc[[name for name in CLASSES if name in noisy.index]]
    return table.sort_values("same_10x60", ascending=False)


def finest(row: pd.Series) -> str:
    """The finest of the grids that keeps enough points in their window, in words."""
    enough = [words for name, words in GRIDS.items() if row[f"same_{name}"] >= ENOUGH]
    return enough[-1] if enough else "coarser than 5 × 30"


def words_of(table: pd.DataFrame) -> pd.DataFrame:
    """The table as the page shows it."""
    columns = {
        "cells": [CLASSES[name][0] for name in table.index],
        "moved by noise, px": table["shift_px"].map("{:.1f}".format),
        "% of the diameter": table["shift_percent"].map("{:.1f}".format),
    }
    columns |= {
        words: (100.0 * table[f"same_{name}"]).map("{:.0f} %".format) for name, words in GRIDS.items()
    }
    return pd.DataFrame(columns | {"finest grid with two of three": table.apply(finest, axis=1)})


def draw(figure: Figure, table: pd.DataFrame) -> None:
    """Share of points in the same window, by class and grid, beside a cell of the class."""
    shapes = {shape.name: shape for shape in (*judges(), *others())}
    table = table[[CLASSES[name][1] in shapes for name in table.index]]
    axes = figure.add_axes((0.45, 0.13, 0.5, 0.77))
    places = np.arange(len(table))[::-1]
    for name, words in GRIDS.items():
        colour, marker = LOOKS[name]
        axes.plot(
            100.0 * table[f"same_{name}"],
            places,
            marker,
            color=colour,
            markersize=4.0,
            label=words,
            clip_on=False,
        )
    axes.axvline(100.0 * ENOUGH, color="0.6", linewidth=0.6, linestyle="--")
    axes.text(100.0 * ENOUGH - 2.0, -0.35, "two of three", color="0.4", ha="right", va="center")
    axes.set(xlim=(0, 100), ylim=(-0.6, len(table) - 0.4), xlabel="points in the same window (%)")
    axes.set_yticks(places, [CLASSES[name][0] for name in table.index])
    axes.tick_params(axis="y", length=0, pad=24)
    axes.grid(axis="y", color="0.92", linewidth=0.5)
    axes.set_axisbelow(True)
    figure.legend(
        *axes.get_legend_handles_labels(),
        title="layers × sectors",
        title_fontsize=7.0,
        ncols=len(GRIDS),
        loc="upper center",
        bbox_to_anchor=(0.5, 1.0),
        frameon=False,
        handletextpad=0.0,
        columnspacing=1.2,
    )
    for place, name in zip(places, table.index, strict=True):
        draw_icon(axes, shapes[CLASSES[name][1]], axes.transLimits.transform((0, place))[1])


def draw_icon(axes: Axes, shape: Shape, height: float) -> None:
    """A cell left of the axes, at a height from 0 to 1."""
    position = axes.get_position()
    span = 0.9 * position.height / 10
    width = span * HEIGHT_MM / SINGLE_COLUMN_MM
    left = position.x0 - width - 0.012
    low = position.y0 + position.height * height - 0.5 * span
    icon = axes.figure.add_axes((left, low, width, span))
    reach = 0.55 * shape.diameter
    middle = 0.5 * (shape.outline_yx.min(axis=0) + shape.outline_yx.max(axis=0))
    icon.add_patch(Polygon((shape.outline_yx - middle)[:, ::-1], facecolor="0.55", edgecolor="none"))
    icon.set(xlim=(-reach, reach), ylim=(reach, -reach), aspect="equal")
    icon.axis("off")


def main() -> None:
    """Draw the picture and write the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("rows", type=Path, metavar="ROWS.csv", help="what reproducibility.py --csv wrote")
    table = by_class(pd.read_csv(parser.parse_args().rows))
    words_of(table).to_csv(TARGET / "classes.csv", index=False)
    with paper_style():
        figure = Figure(figsize=(SINGLE_COLUMN_MM / MM_PER_INCH, HEIGHT_MM / MM_PER_INCH))
        draw(figure, table)
        with replacing(TARGET / "classes.png") as temporary:
            figure.savefig(temporary, dpi=DPI, pil_kwargs={"optimize": True})
    print(words_of(table).to_string(index=False))


if __name__ == "__main__":
    main()
