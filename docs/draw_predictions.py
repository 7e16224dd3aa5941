"""Measure and draw what the page "Does it predict?" shows: an example and where it fails.

    docs/draw_predictions.py FILE … [--only PART …]

Writes into `docs/source/guides/does_it_predict`:

* example: `predicts.png` and `said.txt`, a picture and the lines of `cytodisk predict` on a simulated cell;
* failures: `failures.csv`, how often it says "predicts" in cases of `benchmarks/prediction_cases.py`. FILE is
  what `benchmarks/prediction_calibration.py --only "one way" given failures null --results FILE` has written.
"""

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import fill

import pandas as pd
import xarray as xr
from draw_populations import WRAP, shrink
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import cytodisk as cd

REPOSITORY = Path(__file__).resolve().parents[1]
TARGET = REPOSITORY / "docs" / "source" / "guides" / "does_it_predict"
LAYERS, SECTORS, CHANNEL = 4, 24, "Rac1"
SHOWN_FRAME, SHOWN_FRAMES = 44, 60
WIDTH_MM, HEIGHT_MM, DPI = 119.0, 48.0, 260
PARTS = ("example", "failures")
ALPHA = 0.05
CASES = {
    "nothing predicts": ("null", "ar1"),
    "source predicts target": ("one way", "ar1"),
    "… source with as much noise as signal": ("failures", "one way, noise of the source 1 of its size"),
    "… one frame in 2": ("failures", "one way, one frame in 2"),
    "… one frame in 4": ("failures", "one way, one frame in 4"),
    "… lag longer than the longest past": ("failures", "one way, lag 12, longer than max_order"),
    "… by the source's square": ("failures", "one way, by the source's square"),
    "a driver of both, not given": ("failures", "common driver not given, r = 0.6"),
    "a driver of both, given": ("given", "ar1, r = 0.6"),
    "a driver of both, given with as much noise": (
        "failures",
        "common driver given, measured with as much noise",
    ),
    "masks that jitter move both": ("failures", "masks that jitter, seen in both"),
    "a straight line in both": ("failures", "straight lines in both"),
    "a straight line in both, taken out": ("failures", "straight lines in both, taken out"),
}
"""What the page says, and the block and name of the case."""


def main() -> None:
    """Write the picture and the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("trials", nargs="*", type=Path, metavar="FILE", help="for the table of failures")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=PARTS)
    chosen = parser.parse_args()
    os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    TARGET.mkdir(parents=True, exist_ok=True)
    if "example" in chosen.only:
        example()
    if "failures" in chosen.only:
        found = failures(chosen.trials)
        found.to_csv(TARGET / "failures.csv", index=False)
        print(found.to_string(index=False))


def example() -> None:
    """From images to who predicts whom, as the page's commands do it."""
    truth = renamed(cd.simulate.predicting_movie("ar1", seed=3, frames=100, strength=0.5))
    with TemporaryDirectory() as place:
        here = Path(place)
        truth.write(here)
        grid = f"--layers {LAYERS} --sectors {SECTORS}"
        command(here, f"movie masks.tif --signal signal.ome.tif {grid} --out out --figures 0")
        said = command(here, f"predict out --source {CHANNEL} --target velocity --figures 0")
        (TARGET / "said.txt").write_text(wrapped(said), encoding="utf-8")
        study = cd.open_study(here / "out")
        activity = study.activity(0)
        signal, velocity = activity["mean"].sel(channel=CHANNEL), activity["velocity"]
        draw(truth, signal, velocity, study.prediction(*study.predictions[0]).links)
    print(said)


def renamed(cell: cd.simulate.DrivenMovie) -> cd.simulate.DrivenMovie:
    """The same cell, whose first channel has the name of the page."""
    return replace(cell, signal=cell.signal.assign_coords(channel=[CHANNEL]))


def failures(files: Sequence[Path]) -> pd.DataFrame:
    """Percent of pairs that are called predicting, and whose gain is larger from source to target."""
    lines = [line for file in files for line in file.read_text(encoding="utf-8").splitlines()[1:]]
    trials = {(one["block"], one["case"], one["seed"]): one["values"] for one in map(json.loads, lines)}
    rows = []
    for words, (block, case) in CASES.items():
        found = pd.DataFrame([values for key, values in trials.items() if key[:2] == (block, case)])
        if found.empty:
            sys.exit(
                f"no trial of {block!r}, {case!r}: run benchmarks/prediction_calibration.py --results FILE"
            )
        row = {
            "Case": words,
            "Pairs": str(len(found)),
            "Source predicts target": percent(found["p"] <= ALPHA),
        }
        both = "p_back" in found
        row["Target predicts source"] = percent(found["p_back"] <= ALPHA) if both else "–"
        larger = percent(found["gain"] > found["gain_back"]) if both else "–"
        rows.append(row | {"Larger gain from the source": larger})
    return pd.DataFrame(rows)


def percent(true: pd.Series) -> str:
    """Share of what is true."""
    return f"{100 * true.mean():.0f} %"


def command(here: Path, words: str) -> str:
    """What a command prints."""
    arguments = [sys.executable, "-m", "cytodisk", *words.split()]
    done = subprocess.run(arguments, cwd=here, check=True, capture_output=True, text=True)
    return done.stdout


def wrapped(said: str) -> str:
    """What a command prints, in lines that fit the page, without the one that names a folder."""
    lines = [line for line in said.strip().splitlines() if not line.startswith("results:")]
    indents = [" " * (2 + len(line) - len(line.lstrip())) for line in lines]
    filled = [fill(line, WRAP, subsequent_indent=by) for line, by in zip(lines, indents, strict=True)]
    return "\n".join(filled) + "\n"


def draw(
    truth: cd.simulate.DrivenMovie, signal: xr.DataArray, velocity: xr.DataArray, links: pd.DataFrame
) -> None:
    """The cell, signal and velocity through time, and what was found in each layer in both directions."""
    with cd.plot.paper_style():
        figure = Figure(figsize=(WIDTH_MM / 25.4, HEIGHT_MM / 25.4), layout="constrained")
        grid = figure.add_gridspec(2, 3, width_ratios=(1.0, 1.4, 1.1))
        draw_cell(figure.add_subplot(grid[:, 0]), truth)
        upper = figure.add_subplot(grid[0, 1])
        lower = figure.add_subplot(grid[1, 1])
        times = {"time": slice(0, SHOWN_FRAMES)}
        cd.plot.draw_activity_map(upper, signal.sel(layer=0).isel(times), label=CHANNEL, scale=truth.scale)
        cd.plot.draw_velocity_map(lower, velocity.isel(times), scale=truth.scale)
        upper.set(xlabel="", ylabel="sector", title=f"{CHANNEL} in layer 0")
        upper.tick_params(labelbottom=False)
        lower.set(ylabel="sector", title="velocity of the edge")
        for ax in (upper, lower):
            ax.set_xticks((0, 100, 200))
        draw_gains(figure.add_subplot(grid[:, 2]), links)
        with TemporaryDirectory() as place:
            picture = Path(place) / "predicts.png"
            figure.savefig(picture, dpi=DPI)
            shrink(picture, TARGET / "predicts.png")


def draw_cell(ax: Axes, truth: cd.simulate.DrivenMovie) -> None:
    """One frame with its windows."""
    disk_map = cd.map_to_disk(truth.masks[SHOWN_FRAME])
    windows = cd.polar_windows(layers=LAYERS, sectors=SECTORS).on(disk_map)
    image = truth.signal.isel(time=SHOWN_FRAME, channel=0).to_numpy()
    cd.plot.draw_cell(ax, image, disk_map, scale=truth.scale)
    cd.plot.draw_windows(ax, windows)
    ax.set_title(f"{CHANNEL}, frame {SHOWN_FRAME}")


def draw_gains(ax: Axes, links: pd.DataFrame) -> None:
    """How much error is taken away by layer in both directions, with the limit of chance."""
    there, back = cd.plot.draw_gain_profile(ax, links)
    for line, words, place in (
        (there, f"{CHANNEL} predicts\nthe edge", (0.34, 0.88)),
        (back, f"the edge\npredicts {CHANNEL}", (0.05, 0.12)),
    ):
        ax.text(*place, words, color=line.get_color(), transform=ax.transAxes, fontsize="small")


if __name__ == "__main__":
    main()
