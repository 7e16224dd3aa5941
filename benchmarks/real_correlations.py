"""How signals of real movies go with the velocity of the edge, by layer and by sector, with defaults.

Prints Markdown tables for VASP and lamellipodin in a melanoma cell and for Rac1 in a Dictyostelium cell: the
mean over sectors by layer, and all sectors of layer 0 one by one. Where masks jitter, both are printed again
without lags -1 and 0. Data is found through CYTODISK_DATA or --data.
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

import pandas as pd

from cytodisk.runs.correlate.correlate_study import channels_of, correlate_study
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.store.correlation_store import Correlation
from cytodisk.store.study import Study, open_study

MOVIES = (
    ("melanoma_vasp_lpd", "signal.ome.tif", None),
    ("dictyostelium_rac1", "rac1.tif", 1.29),
)


def study_of(folder: Path, signal: str, interval: float | None, out: Path, workers: int) -> Study:
    """The movie's study, run now unless it is there."""
    if (out / "provenance.json").exists():
        return open_study(out)
    inputs = open_movie(folder / "mask.tif", folder / signal, MovieParameters(frame_interval_s=interval))
    return movie_study(inputs, out, workers=workers)


def show(name: str, found: Correlation) -> None:
    """Print a correlation."""
    skipped = found.settings["skip_lags"]
    without = f", without lags {', '.join(map(str, skipped))}" if skipped else ""
    print(f"\n## {name}: signal {found.signal!r} with {found.with_}{without}\n")
    significant = found.windows["q"] < 0.05
    share = significant.groupby(found.windows["layer"]).mean()
    print(
        "| layer | mean r | lag (frames) | lag (s) | q | windows with q < 0.05 |\n|---|---|---|---|---|---|"
    )
    for row in found.layers.itertuples():
        print(f"| {row.layer} | {row.correlation:+.2f} | {numbers(row)} | {share[row.layer]:.0%} |")
    outer = found.windows[found.windows["layer"] == 0].sort_values("sector")
    print("\nLayer 0 by sector: r at lag (frames), q\n")
    print(
        "; ".join(
            f"{row.sector}: {row.correlation:+.2f} at {row.lag:+.0f}, {row.q:.2g}"
            for row in outer.itertuples()
        )
    )


def numbers(row: object) -> str:
    """Lag and q of a row."""
    seconds = "" if pd.isna(row.lag_s) else f"{row.lag_s:+.1f}"  # type: ignore[attr-defined]
    return f"{row.lag:+.0f} | {seconds} | {row.q:.3g}"  # type: ignore[attr-defined]


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--data", type=Path, default=Path(os.environ.get("CYTODISK_DATA", "../shared/data")))
    parser.add_argument("--keep", type=Path, help="folder that keeps the studies, and has them next time")
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()
    missing = [name for name, _, _ in MOVIES if not (arguments.data / name).is_dir()]
    if missing:
        print(f"{arguments.data} has no {', '.join(missing)}: pass --data", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as temporary:
        for name, signal, interval in MOVIES:
            out = (arguments.keep or Path(temporary)) / name
            study = study_of(arguments.data / name, signal, interval, out, arguments.workers)
            for channel in channels_of(study):
                found = correlate_study(study, channel)
                show(name, found)
                mark, drifting = found.cells[["jitter", "drifting_signal"]].iloc[0]
                print(f"\nMark of jitter: {mark:+.2f}; series of the signal that drift: {drifting:.0%}")
                if mark:
                    show(name, correlate_study(study, channel, skip_lags=(-1, 0)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
