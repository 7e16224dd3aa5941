"""Time and memory of a population run from a study of many cells: read, compared, written.

    benchmarks/population_opening.py [--cells 10000 100000] [--permutations 9999]

Writes a study of cells of 10 × 72 windows (four simulated cells, mapped, whose rows are repeated with other
values), then opens it, and runs `cytodisk population` over it with 6 + 6 experiments, each in a process of
its own. Prints CPU seconds and the most memory of each. Ends with status 1 if one needs more than 2 GB.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import tifffile

import cytodisk as cd
from cytodisk.store.window_columns import WINDOW_COLUMNS

LAYERS, SECTORS, MAPPED, EXPERIMENTS = 10, 72, 4, 12
MOST_MB = 2000.0
CELLS_AT_ONCE = 68  # about as many rows as a run writes at once
_MEASURE = "import resource, sys; {}; used = resource.getrusage(resource.RUSAGE_SELF); "
_PRINT = "print(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)"
_OPEN = "import cytodisk as cd; cd.open_population(sys.argv[1], groups=sys.argv[2])"
_RUN = (
    "import cytodisk as cd; cd.run_population(sys.argv[1], sys.argv[3], groups=sys.argv[2], "
    "compare=('control', 'drug'), permutations=int(sys.argv[4]))"
)


def write_study(folder: Path, cells: int) -> Path:
    """A study of so many cells, and a table of groups beside it."""
    labels = cd.simulate.label_image(cells=MAPPED, seed=1)
    tifffile.imwrite(folder / "cells.tif", labels)
    tifffile.imwrite(folder / "signal.tif", labels.astype("float32"))
    few, many = folder / "few", folder / "many"
    cd.run_map(
        folder / "cells.tif",
        few,
        signal=folder / "signal.tif",
        channels=("Rac1",),
        layers=LAYERS,
        sectors=SECTORS,
        maps=False,
    )
    many.mkdir()
    (many / "provenance.json").write_text((few / "provenance.json").read_text())
    rows = pq.read_table(few / "cells.parquet").take(np.arange(cells) % MAPPED)
    rows = _with(_with(rows, "cell", np.arange(cells)), "label", np.arange(1, cells + 1))
    pq.write_table(rows, many / "cells.parquet")
    _write_windows(pq.read_table(few / "windows.parquet"), many / "windows.parquet", cells)
    groups = folder / "groups.csv"
    with groups.open("w") as file:
        file.write("cell,condition,experiment\n")
        for cell in range(1, cells + 1):
            experiment = cell % EXPERIMENTS
            file.write(f"{cell},{'control' if experiment < EXPERIMENTS // 2 else 'drug'},e{experiment}\n")
    return many


def _write_windows(few: pa.Table, path: Path, cells: int) -> None:
    draw, windows = np.random.default_rng(0), LAYERS * SECTORS
    texts = [column.name for column in WINDOW_COLUMNS if not pa.types.is_floating(column.kind)]
    with pq.ParquetWriter(path, few.schema, use_dictionary=texts) as file:
        for start in range(0, cells, CELLS_AT_ONCE):
            numbers = np.arange(start, min(start + CELLS_AT_ONCE, cells))
            rows = few.take((np.arange(windows) + windows * (numbers[:, None] % MAPPED)).ravel())
            rows = _with(rows, "cell", np.repeat(numbers, windows))
            file.write_table(_with(rows, "mean", draw.normal(100.0, 10.0, len(rows))))


def _with(table: pa.Table, name: str, values: np.ndarray) -> pa.Table:
    place = table.schema.get_field_index(name)
    return table.set_column(place, table.schema.field(place), pa.array(values))


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cells", type=int, nargs="+", default=[10_000, 100_000])
    parser.add_argument("--permutations", type=int, default=9999)
    chosen = parser.parse_args()
    print("| cells | what | CPU s | MB at the peak |\n|---|---|---|---|", flush=True)
    good = True
    for cells in chosen.cells:
        with tempfile.TemporaryDirectory() as name:
            study = write_study(Path(name), cells)
            words = [str(study), str(Path(name) / "groups.csv"), f"{name}/out", str(chosen.permutations)]
            for what, code in (("open_population", _OPEN), ("run_population", _RUN)):
                command = [sys.executable, "-W", "ignore", "-c", _MEASURE.format(code) + _PRINT, *words]
                ran = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
                seconds, peak = map(float, ran.stdout.split()[-2:])
                print(f"| {cells} | {what} | {seconds:.0f} | {peak:.0f} |", flush=True)
                good &= peak <= MOST_MB
    print(f"\n{'the limit is held' if good else 'the limit is NOT held'}")
    return int(not good)


if __name__ == "__main__":
    sys.exit(main())
