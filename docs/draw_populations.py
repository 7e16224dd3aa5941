"""Measure and draw what the page "Is it different?" shows: an example, dishes, false positives, planning.

    docs/draw_populations.py [--studies 400] [--workers 2] [--only PART …]

Writes into `docs/source/guides/is_it_different`:

* example: `atlas.png` and `said.txt`, a picture and the sentences of a run on simulated images;
* null: `dishes.png` and `null.csv`, how often a test finds a difference where there is none, in studies of
  `benchmarks/population_null.py`, which measures more cases;
* plan: `smallest_p.csv` and `power.csv`, what `cytodisk population --power` prints.
"""

import argparse
import os
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory
from textwrap import fill

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

import cytodisk as cd
from cytodisk.files import replacing

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "benchmarks"))
from population_cases import ALPHA, LAYERS, SECTORS, Case, attainable  # noqa: E402
from population_null import count  # noqa: E402

TARGET = REPOSITORY / "docs" / "source" / "guides" / "is_it_different"
SHARES, PERMUTATIONS = (0.0, 0.1, 0.3), 999
EXPERIMENTS, SHOWN = 5, 4  # in the table of false positives, and in the picture
SIZES, EFFECTS = range(3, 9), (0.5, 1.0, 1.5, 2.0)
WRAP = 96  # characters of a line on the page
PARTS = ("example", "null", "plan")
COLOURS = {"control": "0.45", "drug": "#0072B2", "cells": "#E69F00", "experiments": "#009E73"}
WIDTH_MM, HEIGHT_MM, DPI, PALETTE = 150.0, 62.0, 220, 128


def main() -> None:
    """Write the pictures and the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--studies", type=int, default=400, help="of each null case (default 400)")
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=PARTS)
    chosen = parser.parse_args()
    os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    TARGET.mkdir(parents=True, exist_ok=True)
    if "example" in chosen.only:
        example()
    if "null" in chosen.only:
        with ProcessPoolExecutor(chosen.workers) as pool:
            null = false_positives(pool, chosen.studies)
        write(null, "null.csv")
        draw(null)
    if "plan" in chosen.only:
        write(smallest_p(), "smallest_p.csv")
        write(power(), "power.csv")


def example() -> None:
    """From images to the atlas, as the page's commands do it."""
    with TemporaryDirectory() as place:
        here = Path(place)
        made = cd.simulate.population_images(
            here / "plate", seed=1, experiments=6, cells=5, paired=True, effect=0.4, nuclei=True
        )
        days = made.groups.read_text(encoding="utf-8").replace("experiment ", "day ")
        made.groups.write_text(days, encoding="utf-8")
        grid = {"layers": 4, "sectors": 12, "nucleus_layers": 1}
        images = {"signal": made.images, "nuclei": made.nuclei, "groups": made.groups}
        cd.run_map(made.masks, here / "maps", **images, **grid)
        asked = {"compare": ("control", "drug"), "channel": ("Rac1",), "normalise": "cell mean"}
        study = cd.run_population(here / "maps", here / "atlas", align="nucleus", **asked)
        drawn = {path.name: path for path in cd.pages.write_population_figures(study)}
        copyfile(drawn["atlas_on_cell_Rac1.png"], TARGET / "atlas.png")
        lines = [*study.sentences, *(f"{warning.name}: {warning.finding}" for warning in study.warnings)]
        said = "\n".join(fill(line, WRAP, subsequent_indent="  ") for line in lines)
    (TARGET / "said.txt").write_text(f"{said}\n", encoding="utf-8")
    print(said)


def shrink(picture: Path, target: Path) -> None:
    """A picture with few colours, which takes little space."""
    with Image.open(picture) as drawn:
        small = drawn.convert("RGB").quantize(PALETTE, dither=Image.Dither.NONE)
    with replacing(target) as temporary:
        small.save(temporary, "png", optimize=True)


def write(table: pd.DataFrame, name: str) -> None:
    """A table as the docs read it, and on the screen."""
    table.to_csv(TARGET / name, index=False)
    print(f"{name}\n{table.to_string(index=False)}\n")


def false_positives(pool: ProcessPoolExecutor, studies: int) -> pd.DataFrame:
    """Percent of null studies in which a window is called different, by what is exchanged."""
    rows = []
    for share in SHARES:
        row = {"Variance between experiments": f"{100 * share:.0f} %"}
        for unit, words in (("cell", "Cells exchanged"), ("experiment", "Experiments exchanged")):
            case = Case(share, "unpaired", EXPERIMENTS, unit=unit)
            work = partial(count, number=1, case=case, permutations=PERMUTATIONS)
            found = sum(one["windows"] for one in pool.map(work, range(studies), chunksize=20))
            row[words] = f"{100 * found / studies:.0f} %"
        level = attainable(Case(share, "unpaired", EXPERIMENTS), PERMUTATIONS)
        rows.append(row | {"Largest level ≤ 5 % that can be attained": f"{100 * level:.1f} %"})
    return pd.DataFrame(rows)


def smallest_p() -> pd.DataFrame:
    """The smallest p of each number of experiments, as the comparison says it."""
    rows = []
    for experiments in (2, *SIZES):
        row = {"Experiments": str(experiments)}
        for paired, words in ((False, "n + n, unpaired"), (True, "n pairs")):
            cells = cd.simulate.population(
                experiments=experiments, cells=2, paired=paired, layers=1, sectors=4
            )
            pop = cd.Population(cells.values, cells.cells)
            least = cd.compare_conditions(pop, "control", "drug").smallest_p
            row[words] = f"{least:.2g}" + (" *" if least <= ALPHA else "")
        rows.append(row)
    return pd.DataFrame(rows)


def power() -> pd.DataFrame:
    """Percent of studies that find a region as a cluster, and one number by cell, by size of the effect."""
    found = cd.population_power()
    rows = []
    for (design, experiments), own in found.groupby(["design", "experiments"], sort=False):
        words = f"{experiments} pairs" if design == "paired" else f"{experiments} + {experiments}"
        shares = own.set_index("effect").loc[list(EFFECTS), ["cluster", "scalar"]]
        rows.append(
            {"Experiments": words}
            | {f"{effect:g} sd": f"{row.cluster:.0%} / {row.scalar:.0%}" for effect, row in shares.iterrows()}
        )
    return pd.DataFrame(rows)


def draw(null: pd.DataFrame) -> None:
    """Dishes of a study without any effect, and false positives."""
    with cd.plot.paper_style():
        figure = Figure(figsize=(WIDTH_MM / 25.4, HEIGHT_MM / 25.4), layout="constrained")
        dishes, bars = figure.subplots(1, 2, width_ratios=(1.2, 1.0))
        draw_dishes(dishes)
        draw_rates(bars, null)
        with TemporaryDirectory() as place:
            picture = Path(place) / "dishes.png"
            figure.savefig(picture, dpi=DPI)
            shrink(picture, TARGET / "dishes.png")


def draw_dishes(ax: Axes) -> None:
    """Cells small, means of dishes large, in one window."""
    truth = cd.simulate.population(
        7,
        effect=0.0,
        experiments=SHOWN,
        cells=30,
        between_experiments=0.3,
        layers=LAYERS,
        sectors=SECTORS,
    )
    values = truth.values.to_numpy()[:, 0, 0]
    rng = np.random.default_rng(0)
    numbers = truth.cells["experiment"].factorize()[0]
    for number in range(2 * SHOWN):
        own = values[numbers == number]
        colour = COLOURS["drug" if number >= SHOWN else "control"]
        place = number + (0.6 if number >= SHOWN else 0.0)
        ax.plot(place + rng.uniform(-0.22, 0.22, len(own)), own, ".", color=colour, markersize=2.5, alpha=0.6)
        ax.plot(place, own.mean(), "o", color=colour, markersize=6.5, markeredgecolor="0.1", zorder=3)
    middles = ((SHOWN - 1) / 2, SHOWN + 0.6 + (SHOWN - 1) / 2)
    ax.set_xticks(middles, [f"control\n{SHOWN} dishes", f"drug, no effect\n{SHOWN} dishes"])
    ax.tick_params(axis="x", length=0)
    ax.set(ylabel="signal in a window (a.u.)", title="dishes differ by themselves")


def draw_rates(ax: Axes, null: pd.DataFrame) -> None:
    """Bars of false positives, by what is exchanged."""
    names: Sequence[str] = [name for name in null if name.endswith("exchanged")]
    for step, name in zip((-0.2, 0.2), names, strict=True):
        rates = [float(words.removesuffix(" %")) for words in null[name]]
        drawn = ax.bar(
            np.arange(len(null)) + step,
            rates,
            0.38,
            color=COLOURS[name.split()[0].lower()],
            label=name.lower(),
        )
        ax.bar_label(drawn, [f"{rate:.0f}" for rate in rates], padding=1)
    ax.axhline(100 * ALPHA, color="0.2", linewidth=0.7, linestyle=(0, (3, 2)))
    ax.set_xticks(range(len(null)), null.iloc[:, 0])
    ax.set(xlabel="variance between dishes", ylabel="studies with a false positive (%)", ylim=(0, 112))
    ax.set_title("nothing is different")
    ax.legend(loc="upper left", frameon=False)


if __name__ == "__main__":
    main()
