"""Whether the score of order tells cells with a pattern from cells without, as the cells' authors saw them.

    CYTODISK_DATA=FOLDER benchmarks/waves_patterns.py [--seconds 250] [--surrogates 99] [--draws 2000]

Reads `dictyostelium_patterns` in the folder: Rac1 along the edge of *Dictyostelium* cells, half of which
their authors called rotating or oscillating, stationary, or random. All cells are cut to the same number of
seconds from their start. Prints the score of each cell, and the area under the curve (AUC, 0.5 is chance)
of the score for rotating or oscillating cells against random and against stationary ones, each with its 95
% bootstrap interval over cells; the same uncut; and that of the movie's length alone, which uncut movies
differ in. Nothing was set on these cells.
"""

import argparse
import os
import sys
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.stats import mannwhitneyu

import cytodisk as cd

PATTERN, OTHERS = "rotating_or_oscillating", ("random", "stationary")


def scored(folder: Path, seconds: float | None, surrogates: int) -> pd.DataFrame:
    """Score of order, kind and p of each cell with a label."""
    cells = pd.read_csv(folder / "cells.csv", dtype={"pattern": "string"})
    cells = cells[cells["pattern"].notna()]
    edges, rows = np.load(folder / "edges.npz"), []
    for cell in cells.itertuples():
        interval = float(cell.frame_interval_s)
        values = edges[f"cell_{cell.cell:02d}_rac1"].astype(float)
        outline = edges[f"cell_{cell.cell:02d}_outline_yx"].astype(float)
        frames = len(values) if seconds is None else min(round(seconds / interval), len(values))
        lengths = place_lengths(outline[:frames])
        found = cd.edge_waves(values[:frames], interval, lengths, surrogates=surrogates)
        names = ("kind", "mode", "period_s", "direction", "order", "p")
        row = {name: found[name].item() for name in names}
        rows.append({"cell": cell.cell, "pattern": cell.pattern, "seconds": frames * interval} | row)
    return pd.DataFrame(rows)


def place_lengths(outline: NDArray[np.float64]) -> NDArray[np.float64]:
    """Length of edge that belongs to each place (time, place): half of the way to either neighbour, in px."""
    ahead = np.hypot(*np.moveaxis(np.roll(outline, -1, axis=1) - outline, -1, 0))
    half = 0.5 * (ahead + np.roll(ahead, 1, axis=1))
    return np.asarray(np.where(half > 0, half, np.finfo(float).eps))


def area(higher: NDArray[np.float64], lower: NDArray[np.float64]) -> float:
    """Chance that a cell of the first has the larger value."""
    return float(mannwhitneyu(higher, lower).statistic / (len(higher) * len(lower)))


def interval(higher: NDArray[np.float64], lower: NDArray[np.float64], draws: int) -> tuple[float, float]:
    """95 % bootstrap interval of the area over cells."""
    random = np.random.default_rng(0)
    areas = [area(random.choice(higher, len(higher)), random.choice(lower, len(lower))) for _ in range(draws)]
    low, high = np.quantile(areas, [0.025, 0.975])
    return float(low), float(high)


def lines(cells: pd.DataFrame, column: str, what: str, draws: int) -> list[str]:
    """Rows of the table."""
    found = []
    for other in OTHERS:
        higher, lower = (cells.loc[cells["pattern"] == name, column].to_numpy() for name in (PATTERN, other))
        low, high = interval(higher, lower, draws)
        counts = f"{len(higher)} against {len(lower)}"
        found.append(f"| {what} | {other} | {counts} | {area(higher, lower):.2f} | {low:.2f} to {high:.2f} |")
    return found


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=250.0, help="of each cell (default 250)")
    parser.add_argument("--surrogates", type=int, default=99, help="of each cell (default 99)")
    parser.add_argument("--draws", type=int, default=2000, help="of the bootstrap (default 2000)")
    chosen = parser.parse_args()
    folder = Path(os.environ.get("CYTODISK_DATA", "")) / "dictyostelium_patterns"
    if not (folder / "cells.csv").exists():
        raise SystemExit("set CYTODISK_DATA to the folder that holds dictyostelium_patterns")
    head = "\n| what | rotating or oscillating against | cells | AUC | 95 % interval |\n|---|---|---|---|---|"
    cut = scored(folder, chosen.seconds, chosen.surrogates)
    print(cut.round(3).to_string(index=False))
    kinds = cut.groupby("pattern")["kind"].value_counts().unstack(fill_value=0)
    print(f"\nKinds that edge_waves finds, cut:\n{kinds.to_string()}")
    print(
        "\n".join([head, *lines(cut, "order", f"order, cut to {chosen.seconds:g} s", chosen.draws)]),
        flush=True,
    )
    whole = scored(folder, None, chosen.surrogates)
    print("\n".join(lines(whole, "order", "order, uncut", chosen.draws)))
    print("\n".join(lines(whole, "seconds", "seconds of the uncut movie alone", chosen.draws)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
