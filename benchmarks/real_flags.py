"""Which QC flags come on real movies, a line each, for a person to judge.

    benchmarks/real_flags.py [--data FOLDER]

How rare flags are where nothing is wrong is the block `flags` of `honest.py`.
"""

import argparse
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

import cytodisk as cd
from cytodisk.runs.told.flag_words import places_words

GRID = cd.MovieParameters(layers=5, sectors=24)


def real_movies(data: Path) -> Iterator[tuple[str, cd.Study]]:
    """Real movies, each with its study."""
    pairs = [
        ("melanoma_vasp_lpd/mask.tif", "melanoma_vasp_lpd/signal.ome.tif"),
        ("dictyostelium_rac1/mask.tif", "dictyostelium_rac1/rac1.tif"),
        *((str(path.relative_to(data)), None) for path in sorted(data.glob("tracked_cells/*.tif"))),
    ]
    for masks, signal in pairs:
        with tempfile.TemporaryDirectory() as folder:
            image = None if signal is None else data / signal
            yield masks, cd.run_movie(data / masks, Path(folder) / "out", signal=image, parameters=GRID)


def main() -> None:
    """Print the flags of each movie."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, default=Path(os.environ.get("CYTODISK_DATA", "../shared/data")))
    for name, study in real_movies(parser.parse_args().data):
        for flag in cd.qc_flags(study):
            print(f"{name}: {flag.name}: {flag.what} ({places_words(flag.places, {})})", flush=True)


if __name__ == "__main__":
    main()
