"""Measure what the paper measured, on the data at hand, and write the page "The paper, re-measured".

Reads reference masks, osteosarcoma cells, and two movies from the folder in CYTODISK_DATA (default:
shared/data beside the repository). Writes `docs/source/paper_remeasured.rst`, its pictures and its tables.
What takes long is kept in `--work`, so a run that was stopped goes on where it was.
"""

import argparse
import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd

sys.path.insert(0, str(Path(__file__).parent))
from remeasured import cells, claims, frames, maps, movies, shapes, times
from remeasured.page import write_page

HERE = Path(__file__).parent
PAGE, FILES = HERE / "source" / "paper_remeasured.rst", HERE / "source" / "paper_remeasured"


def main() -> None:
    """Run all measurements and write the page."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--data", type=Path, default=data_folder())
    parser.add_argument("--work", type=Path, default=HERE / "_build" / "remeasured")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument(
        "--maps",
        type=Path,
        help="comparison of maps of the same cells, made before, to take in place of a new one",
    )
    parser.add_argument(
        "--keep-times",
        action="store_true",
        help="keep the times on the page that stands, as other work shares the machine; the page says so",
    )
    chosen = parser.parse_args()
    if not (chosen.data / "osteosarcoma" / "masks.tif").exists():
        sys.exit(f"{chosen.data} has no osteosarcoma/masks.tif: set CYTODISK_DATA or pass --data")
    found: dict[str, Any] = {
        "maps": maps.measure(chosen.data / "reference_masks"),
        "free_flips": maps.free_flips(chosen.data / "reference_masks"),
        "shapes": shapes.measure(chosen.data / "osteosarcoma" / "masks.tif", chosen.work, chosen.workers),
        "cells": cells.measure(
            chosen.data / "osteosarcoma" / "masks.tif", chosen.work, chosen.workers, chosen.maps
        ),
        "movies": movies.measure(chosen.data, chosen.work),
        "frames": frames.measure(chosen.data, chosen.work),
    }
    kept = times.of_page(FILES) if chosen.keep_times else None
    shutil.rmtree(FILES, ignore_errors=True)
    FILES.mkdir(parents=True)
    numbers: dict[str, Any] = {"times": times.MEASURED}
    writers: tuple[Callable[[dict[str, Any], Path], dict[str, Any]], ...] = (
        maps.write,
        shapes.write,
        cells.write,
        movies.write,
        frames.write,
        claims.write,
    )
    for write in writers:
        numbers |= write(found, FILES)
    if kept is not None:
        numbers |= times.put(FILES, kept)
    write_page(PAGE, numbers)
    print(pd.read_csv(FILES / "claims.csv").to_string())
    print(f"written: {PAGE}")


def data_folder() -> Path:
    """Folder of the data: CYTODISK_DATA, or `shared/data` beside the repository."""
    return Path(os.environ.get("CYTODISK_DATA", HERE.parents[1] / "shared" / "data"))


if __name__ == "__main__":
    main()
