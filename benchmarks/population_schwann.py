"""Signals of Schwann cells by layer, wells as experiments: what three wells can show, and what they cannot.

    benchmarks/population_schwann.py [--quick] [--out FOLDER] [--layers 6] [--sectors 24]

Takes the fields of touching cells with nuclei in `schwann_nuclei/` of the folder in CYTODISK_DATA, one a
well (B7, D6, D7), cut around their nuclei by a watershed, without cells at the border of the image. Goes the
way of a user: label images in folders, `run_map`, `open_population` with a table of groups. What was done to
the wells is not recorded: rows of the plate stand for conditions, as an example. Values are without the
background of the field and over the cell's mean; cells are turned by the nucleus. Prints

* the level of each channel by layer and well, and the share of the variance between cells that lies between
  wells, estimated from one-way sums of squares;
* what the comparison of row D with row B says: the smallest p first, its warnings, and the scalars that
  differ most;
* in how many windows and scalars a test by cells finds a difference, between these rows and between the two
  wells of one row.

Writes a picture into FOLDER. Ends with status 1 if 1 + 2 wells gave a p below 0.05.
"""

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import tifffile
from matplotlib.figure import Figure
from scipy import ndimage

import cytodisk as cd
from real_masks import DATA
from schwann_nuclei import schwann_cases

CHANNELS = ("DAPI", "GFP", "RFP")
NUCLEUS_LAYERS, PERMUTATIONS, LEVEL = 2, 999, 0.05
_QUICK = 4  # one cell in so many
_FAR_PX = 20  # from all cells, where the background is taken
_WIDTH_IN = 170 / 25.4


def write_inputs(data: Path, out: Path, every: int = 1) -> Path:
    """Label images of cells and of nuclei and the signals, a folder each, and the table of groups."""
    for name in ("cells", "nuclei", "signal"):
        (out / name).mkdir(parents=True, exist_ok=True)
    cells: dict[str, np.ndarray] = {}
    nuclei: dict[str, np.ndarray] = {}
    rows = []
    for place, case in enumerate(schwann_cases(data)):
        well, number = case.name.split()
        if well not in cells:
            signal = tifffile.imread(data / "schwann_nuclei" / f"{well}_signal.tif")
            merged = tifffile.imread(data / "schwann_nuclei" / f"{well}_cells.tif") > 0
            cells[well], nuclei[well] = (np.zeros(merged.shape, np.uint16) for _ in range(2))
            tifffile.imwrite(out / "signal" / f"{well}.tif", signal, photometric="minisblack")
            far = signal[:, ndimage.distance_transform_edt(~merged) >= _FAR_PX]
            background = zip(CHANNELS, np.median(far, axis=1).tolist(), strict=True)
            rows.append(
                {"file": f"{well}.tif", "condition": f"row {well[0]}", "experiment": well}
                | {f"background_{channel}": level for channel, level in background}
            )
        places = tuple(np.argwhere(case.mask).T + np.array(case.corner)[:, None])
        if place % every or any(
            at.min() == 0 or at.max() == size - 1 for at, size in zip(places, cells[well].shape, strict=True)
        ):
            continue
        cells[well][places] = int(number)
        nuclei[well][tuple(np.argwhere(case.nucleus).T + np.array(case.corner)[:, None])] = int(number)
    for well in cells:
        tifffile.imwrite(out / "cells" / f"{well}.tif", cells[well])
        tifffile.imwrite(out / "nuclei" / f"{well}.tif", nuclei[well])
    groups = out / "groups.csv"
    pd.DataFrame(rows).to_csv(groups, index=False)
    return groups


def opened(out: Path, groups: Path, layers: int, sectors: int) -> cd.Population:
    """The mapped cells as a population, without background, over their mean, turned by the nucleus."""
    cd.run_map(
        out / "cells",
        out / "maps",
        signal=out / "signal",
        nuclei=out / "nuclei",
        channels=list(CHANNELS),
        layers=layers,
        sectors=sectors,
        nucleus_layers=NUCLEUS_LAYERS,
        overwrite=True,
    )
    pop = cd.open_population(out / "maps", groups=groups)
    return pop.normalise("background").normalise("cell mean").align("nucleus")


def layer_table(pop: cd.Population) -> pd.DataFrame:
    """Level over the cell's mean: a row for each cell, channel and layer."""
    scalars = pop.scalar_table()
    inside = [name == "nucleus" for name in pop.compartments]
    parts = [
        pop.cells[["condition", "experiment"]].assign(
            channel=channel, layer=layer, value=scalars[f"layer_{layer}_{channel}"], in_nucleus=in_nucleus
        )
        for channel in pop.channels
        for layer, in_nucleus in enumerate(inside)
    ]
    return pd.concat(parts, ignore_index=True)


def between_share(values: pd.Series, wells: pd.Series) -> float:
    """Share of the variance between cells that lies between wells: at least 0."""
    groups = [own.to_numpy() for _, own in values.dropna().groupby(wells)]
    sizes = np.array([len(own) for own in groups], dtype=float)
    total, count = sizes.sum(), len(groups)
    within = sum(((own - own.mean()) ** 2).sum() for own in groups) / (total - count)
    between = sum(len(own) * (own.mean() - values.mean()) ** 2 for own in groups) / (count - 1)
    each = (total - (sizes**2).sum() / total) / (count - 1)
    of_wells = max((between - within) / each, 0.0)
    return of_wells / (of_wells + within)


def print_layers(table: pd.DataFrame) -> None:
    """The level by layer and well, and the share between wells."""
    for channel, own in table.groupby("channel", sort=False):
        means = own.pivot_table(index="layer", columns="experiment", values="value")
        shares = [between_share(rows["value"], rows["experiment"]) for _, rows in own.groupby("layer")]
        means["between wells"] = [f"{share:.0%}" for share in shares]
        print(f"\n{channel}, over the cell's mean\n{means.round(2).to_string()}")


def print_comparison(found: cd.ConditionComparison) -> None:
    """Sentences, warnings and the largest effects."""
    print("", *found.sentences, sep="\n")
    print("", *(f"WARNING {warning}" for warning in found.warnings), sep="\n")
    columns = ["scalar", "control", "treated", "difference", "effect_size", "p"]
    order = found.scalars.eval("difference / control").abs().sort_values(ascending=False).index
    print(f"\n{found.scalars.loc[order, columns].head(8).round(2).to_string(index=False)}")
    print("no effect size: one well has no spread")


def found_by_cells(pop: cd.Population, column: str, pair: Sequence[str]) -> str:
    """What a test by cells calls different: it knows nothing of wells."""
    renamed = pop.with_cells(pop.cells.assign(condition=pop.cells[column]))
    test = cd.compare_conditions(renamed, *pair, unit="cell", permutations=PERMUTATIONS)
    p = test.windows["p_fwer"].to_numpy()
    scalars = int((test.scalars["p_fwer"] <= LEVEL).sum())
    return (
        f"{pair[1]} against {pair[0]}, by cells: {int((p <= LEVEL).sum())} of {p.size} windows, "
        f"{scalars} of {len(test.scalars)} scalars 'differ'"
    )


def draw(table: pd.DataFrame, pop: cd.Population, path: Path) -> None:
    """GFP and RFP by layer with each well as a line, and a ratio by cell and well."""
    with cd.plot.paper_style():
        figure = Figure(figsize=(_WIDTH_IN, 2.9), layout="constrained")
        inside = [str(layer) for layer, name in enumerate(pop.compartments) if name == "nucleus"]
        nucleus = ", ".join(inside)
        parts = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 0.8))
        for ax, channel in zip(parts[:2], ("GFP", "RFP"), strict=True):
            lines = cd.plot.draw_condition_profiles(
                ax, table[table["channel"] == channel], label=f"{channel} / mean of the cell"
            )
            ax.set_xlabel(f"layer: 0 membrane, {nucleus} in the nucleus")
        ratio = "nucleus_to_cytoplasm_GFP"
        cells = pop.cells[["condition", "experiment"]].assign(**{ratio: pop.scalar_table()[ratio]})
        cd.plot.draw_super_plot(parts[2], cells, ratio, label="GFP, nucleus / cytoplasm")
        figure.legend(
            handles=cd.plot.condition_key(lines), loc="outside lower center", ncols=4, frameon=False
        )
        figure.savefig(path, dpi=250)


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help=f"one cell in {_QUICK}")
    parser.add_argument("--out", type=Path, help="folder for inputs, maps and the picture")
    parser.add_argument("--layers", type=int, default=6)
    parser.add_argument("--sectors", type=int, default=24)
    parser.add_argument("--data", type=Path, default=DATA)
    chosen = parser.parse_args()
    if not (chosen.data / "schwann_nuclei").is_dir():
        print(f"{chosen.data / 'schwann_nuclei'} does not exist: set CYTODISK_DATA or pass --data")
        return 1
    out = chosen.out or Path(tempfile.mkdtemp(prefix="population_schwann_"))
    groups = write_inputs(chosen.data, out, _QUICK if chosen.quick else 1)
    pop = opened(out, groups, chosen.layers, chosen.sectors)
    print(pop, pop.cells.groupby(["condition", "experiment"]).size().to_string(), sep="\n")
    table = layer_table(pop)
    print_layers(table)
    found = cd.compare_conditions(pop, "row B", "row D", permutations=PERMUTATIONS)
    print_comparison(found)
    print()
    print(found_by_cells(pop, "condition", ("row B", "row D")))
    print(found_by_cells(pop, "experiment", ("D6", "D7")))
    draw(table, pop, out / "schwann.png")
    print(f"\npicture: {out / 'schwann.png'}")
    return int(found.smallest_p <= LEVEL)


if __name__ == "__main__":
    sys.exit(main())
