"""Shapes of osteosarcoma cells by treatment, and what cannot be concluded: nobody knows the experiments.

    benchmarks/population_osteosarcoma.py [--quick] [--out FOLDER] [--features 10]

Reads `osteosarcoma/` (outlines of two cell lines: control, cytochalasin D, jasplakinolide) in the folder of
CYTODISK_DATA and goes the way of a user: `run_shapes`, then `open_population` with a table of groups. The
source does not say which cells were in one dish. So a comparison over experiments must be refused, and is;
what is left is a description: effect sizes by cell (Hedges' g with its interval) of the complexity and of
the features with the largest ones, in each line by itself. Prints them without p, writes a picture and the
results of `run_population` into FOLDER, and ends with status 1 if a test was made all the same.
"""

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.errors import PopulationError
from real_masks import DATA

TREATMENTS = {"control": "control", "cytd": "cytochalasin D", "jasp": "jasplakinolide"}
LINES = {"dlm8": "DLM8", "dunn": "DUNN"}
COLOURS = {"cytochalasin D": "#D55E00", "jasplakinolide": "#0072B2"}
SCORE = "complexity"
_QUICK = 8  # one cell in so many
_WIDTH_IN = 170 / 25.4


def write_groups(folder: Path, target: Path, every: int = 1) -> pd.DataFrame:
    """The table of groups that a user writes: by place in the stack, the treatment and the line."""
    words = {
        name: (folder / f"{name}.txt").read_text(encoding="utf-8").split()
        for name in ("treatments", "cell_lines")
    }
    groups = pd.DataFrame(
        {
            "frame": np.arange(len(words["treatments"])),
            "condition": [TREATMENTS[word] for word in words["treatments"]],
            "line": [LINES[word] for word in words["cell_lines"]],
        }
    )[::every]
    groups.to_csv(target, index=False)
    return groups


def measured(folder: Path, out: Path, every: int = 1) -> cd.Population:
    """Shapes of all cells, with their groups, as a population."""
    write_groups(folder, out / "groups.csv", every)
    cd.run_shapes(folder / "masks.tif", out / "shapes", overwrite=True)
    return cd.open_population(out / "shapes", groups=out / "groups.csv")


def refusal(pop: cd.Population) -> str:
    """What the test over experiments says; empty if it was made."""
    try:
        cd.compare_conditions(pop, "control", "cytochalasin D")
    except PopulationError as error:
        return str(error)
    return ""


def effects(pop: cd.Population) -> pd.DataFrame:
    """Effect sizes by cell of each scalar, in each line and treatment; no p is taken from it."""
    parts = []
    for line in LINES.values():
        cells = pop.select(pop.cells["line"] == line)
        for treatment in COLOURS:
            found = cd.compare_conditions(cells, "control", treatment, unit="cell", permutations=99)
            table = found.scalars[["scalar", "control", "treated", "effect_size", "low", "high"]]
            parts.append(table.assign(line=line, treatment=treatment, warning=found.warnings[0].name))
    return pd.concat(parts, ignore_index=True)


def largest(table: pd.DataFrame, count: int) -> list[str]:
    """The complexity, and the features with the largest effect in the line where it is smaller."""
    sizes = table.assign(size=table["effect_size"].abs())
    both = sizes.pivot_table(index=["scalar", "treatment"], columns="line", values="size").min(axis=1)
    ranked = both.groupby("scalar").max().sort_values(ascending=False)
    return [SCORE, *[name for name in ranked.index if name != SCORE]][: count + 1]


def print_effects(table: pd.DataFrame, names: Sequence[str]) -> None:
    """A row for each feature, a column for each line and treatment."""
    columns = [(line, treatment) for line in LINES.values() for treatment in COLOURS]
    print(f"{'':<28}" + "".join(f"{line + ' ' + treatment:>26}" for line, treatment in columns))
    for name in names:
        own = table[table["scalar"] == name].set_index(["line", "treatment"])
        rows = [own.loc[column, ["effect_size", "low", "high"]] for column in columns]
        words = [f"{size:+.2f} ({low:+.2f} to {high:+.2f})" for size, low, high in rows]
        print(f"{name:<28}" + "".join(f"{word:>26}" for word in words))


def draw(pop: cd.Population, table: pd.DataFrame, names: Sequence[str], path: Path) -> None:
    """The complexity of all cells by line and treatment, and the effect sizes beside it."""
    with cd.plot.paper_style():
        figure = Figure(figsize=(_WIDTH_IN, 3.4), layout="constrained")
        parts = figure.subplots(1, 3, width_ratios=(0.8, 0.8, 1.4))
        parts[1].sharey(parts[0])
        for ax, line in zip(parts[:2], LINES.values(), strict=True):
            draw_cells(ax, pop.cells[pop.cells["line"] == line])
            ax.set_title(line)
        parts[0].set_ylabel("complexity score")
        draw_effects(parts[2], table, names)
        figure.suptitle("Described by cell; not tested: experiments are unknown", fontsize="medium")
        figure.savefig(path, dpi=250)


def draw_cells(ax: Axes, cells: pd.DataFrame) -> None:
    """A dot a cell, a bar the median."""
    rng = np.random.default_rng(0)
    for place, treatment in enumerate(TREATMENTS.values()):
        values = cells.loc[cells["condition"] == treatment, SCORE].dropna().to_numpy()
        colour = COLOURS.get(treatment, "0.4")
        ax.plot(
            place + rng.uniform(-0.25, 0.25, len(values)), values, ".", color=colour, markersize=3, alpha=0.6
        )
        ax.hlines(np.median(values), place - 0.35, place + 0.35, color="0.1", linewidth=1.5)
    ax.set_xticks(range(3), ["control", "cyto. D", "jasp."])


def draw_effects(ax: Axes, table: pd.DataFrame, names: Sequence[str]) -> None:
    """Effect sizes with their intervals: treatments in two colours, lines in two shapes."""
    marks = dict(zip(LINES.values(), ("o", "s"), strict=True))
    steps = np.linspace(-0.27, 0.27, 4)
    cases = [(treatment, line) for treatment in COLOURS for line in LINES.values()]
    for step, (treatment, line) in zip(steps, cases, strict=True):
        rows = table[(table["treatment"] == treatment) & (table["line"] == line)].set_index("scalar")
        rows = rows.loc[list(names)]
        ends = np.abs(rows[["low", "high"]].to_numpy().T - rows["effect_size"].to_numpy())
        style = {"fmt": marks[line], "color": COLOURS[treatment], "markersize": 3, "elinewidth": 0.7}
        places = np.arange(len(names)) + step
        ax.errorbar(rows["effect_size"], places, xerr=ends, label=f"{treatment}, {line}", **style)
    ax.axvline(0, color="0.3", linewidth=0.6)
    ax.set_yticks(range(len(names)), [name.replace("_", " ") for name in names])
    ax.invert_yaxis()
    ax.set(xlabel="Hedges' g by cell, 95 % interval")
    handles, labels = ax.get_legend_handles_labels()
    ax.figure.legend(handles, labels, loc="outside lower right", ncols=4, frameon=False, fontsize="small")


def run(groups: pd.DataFrame, out: Path, line: str) -> list[str]:
    """The way of the command for one line, in a folder of its own, and what it says."""
    own = out / f"groups_{line}.csv"
    groups[groups["line"] == line].to_csv(own, index=False)
    asked = {"compare": ("control", *COLOURS), "overwrite": True}
    study = cd.run_population(out / "shapes", out / line, groups=own, **asked)
    cd.pages.write_population_figures(study)
    warnings = (f"WARNING {warning.name}: {warning.consequence}" for warning in study.warnings)
    return [*study.sentences, *warnings]


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help=f"one cell in {_QUICK}")
    parser.add_argument("--out", type=Path, help="folder for results and the picture")
    parser.add_argument("--features", type=int, default=10, help="how many are shown (default 10)")
    parser.add_argument("--data", type=Path, default=DATA)
    chosen = parser.parse_args()
    folder = chosen.data / "osteosarcoma"
    if not folder.is_dir():
        print(f"{folder} does not exist: set CYTODISK_DATA or pass --data")
        return 1
    out = chosen.out or Path(tempfile.mkdtemp(prefix="population_osteosarcoma_"))
    out.mkdir(parents=True, exist_ok=True)
    pop = measured(folder, out, _QUICK if chosen.quick else 1)
    print(pop.cells.groupby(["line", "condition"], sort=False).size().to_string())
    refused = refusal(pop)
    print(f"\nover experiments: {refused or 'TESTED, although experiments are unknown'}")
    table = effects(pop)
    print(f"\nby cell, as a description (the test warns: {table['warning'].iloc[0]!r}); g, 95 % interval\n")
    names = largest(table, chosen.features)
    print_effects(table, names)
    draw(pop, table, names, out / "osteosarcoma.png")
    groups = pop.cells[["frame", "condition", "line"]]
    for line in LINES.values():
        print(f"\ncytodisk population, {line}", *run(groups, out, line), sep="\n")
    print(f"\nresults: {out}")
    return int(not refused)


if __name__ == "__main__":
    sys.exit(main())
