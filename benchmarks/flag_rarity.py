"""How often QC flags come where nothing is wrong, and which come on real movies.

    benchmarks/flag_rarity.py [--movies 50] [--first-seed 1000]
    benchmarks/flag_rarity.py --real [--data FOLDER]

Clean movies: all simulated kinds without jitter, lost frames or long thin arms, in turn, with signals, in
windows of well over ten pixels. At most three of fifty may carry a flag of any kind. With `--correlate` the
signal "edge" is correlated with velocity too, and its flags count. With `--real`: the flags of real movies,
a line each, for a person to judge.
"""

import argparse
import os
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tifffile

import cytodisk as cd
from cytodisk.cli.flag_words import places_words
from cytodisk.runs.qc_flags.qc_flag import QCFlag

MOST_FLAGGED = 3
"""Of fifty clean movies."""
NOT_CLEAN = ("still", "dropping", "filopodium")
"""Kinds of movies whose masks jitter, or are missing in some frames, or whose windows are distorted: an arm
that becomes three radii long raises "strong distortion", and that is right."""
GRID = cd.MovieParameters(layers=5, sectors=24)
FRAMES = 40


@dataclass(frozen=True)
class Flagged:
    """A clean movie and its flags."""

    kind: str
    seed: int
    flags: list[QCFlag]


def clean_kinds() -> list[str]:
    """Kinds of simulated movies without any fault."""
    return [kind for kind in cd.simulate.MOVIE_KINDS if kind not in NOT_CLEAN]


def study_of(kind: str, seed: int, folder: Path, correlate: bool) -> cd.Study:
    """A simulated movie, run as a user does it."""
    truth = cd.simulate.movie(kind, seed=seed, frames=FRAMES)  # type: ignore[arg-type]
    masks, signal = folder / "masks.tif", folder / "signal.ome.tif"
    tifffile.imwrite(masks, truth.masks.astype(np.uint8), metadata={"axes": "TYX"}, compression="zlib")
    metadata = {
        "axes": "TCYX",
        "Channel": {"Name": ["material", "edge"]},
        "PhysicalSizeX": truth.pixel_size_um,
        "PhysicalSizeY": truth.pixel_size_um,
        "TimeIncrement": truth.frame_interval_s,
        "TimeIncrementUnit": "s",
    }
    assert truth.signal is not None
    tifffile.imwrite(signal, truth.signal.to_numpy(), metadata=metadata, photometric="minisblack", ome=True)
    study = cd.run_movie(masks, folder / "out", signal=signal, parameters=GRID)
    if correlate:
        cd.run_correlate(study, "edge", "velocity", max_lag=8, surrogates=199)
        study = cd.open_study(folder / "out")
    return study


def clean_movies(movies: int = 50, first_seed: int = 1000, correlate: bool = False) -> Iterator[Flagged]:
    """Flags of clean movies, one after the other."""
    kinds = clean_kinds()
    for number in range(movies):
        kind, seed = kinds[number % len(kinds)], first_seed + number
        with tempfile.TemporaryDirectory() as folder:
            yield Flagged(kind, seed, cd.qc_flags(study_of(kind, seed, Path(folder), correlate)))


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
    """Print flags and how many movies carry any."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--movies", type=int, default=50)
    parser.add_argument("--first-seed", type=int, default=1000)
    parser.add_argument("--correlate", action="store_true", help="correlate signal and velocity, too")
    parser.add_argument("--real", action="store_true", help="flags of real movies instead")
    parser.add_argument("--data", type=Path, default=Path(os.environ.get("CYTODISK_DATA", "../shared/data")))
    arguments = parser.parse_args()
    if arguments.real:
        for name, study in real_movies(arguments.data):
            for flag in cd.qc_flags(study):
                print(f"{name}: {flag.name}: {flag.what} ({places_words(flag.places, {})})", flush=True)
        return
    names: Counter[str] = Counter()
    flagged = 0
    for movie in clean_movies(arguments.movies, arguments.first_seed, arguments.correlate):
        flagged += bool(movie.flags)
        names.update(flag.name for flag in movie.flags)
        for flag in movie.flags:
            where = places_words(flag.places, {})
            print(f"{movie.kind}, seed {movie.seed}: {flag.name}: {flag.what} ({where})", flush=True)
    print(f"clean movies with a flag: {flagged} of {arguments.movies} (at most {MOST_FLAGGED} of 50)")
    print(f"by flag: {dict(names.most_common())}")


if __name__ == "__main__":
    main()
