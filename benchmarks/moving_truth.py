"""What `predict` and `edge_waves` find in simulated cells whose edge moves, from masks and images on.

    benchmarks/moving_truth.py [--movies 20] [--workers 2] [--only predict waves]

Each movie is drawn as masks and images, mapped, followed and measured in windows; then the result is compared
with what was put in. Two tables:

* predict: share of movies with p ≤ 0.05 from the channel to the edge and back in layer 0, share with the
  larger gain above chance from the channel, and the median gain over the true one.
* waves: share of movies with the right kind, share with the right direction, and the largest error of the
  speed over the truth. Noise is as large as the wave; a period has 9 to 30 frames, and a movie three periods.
  "none" is noise of the wave's spectrum that forgets its phase over two periods.

Seeds count from 20000, on which nothing was set. Ends with status 1 if a yardstick is missed.
"""

import argparse
import os
import sys
import warnings
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

import cytodisk as cd
from figure import Figure

FIRST_SEED, ALPHA = 20_000, 0.05
FRAMES, LAYERS, SECTORS, SURROGATES = 150, 3, 24, 99
CELL = {"radius_px": 35.0, "sectors": SECTORS}
PERIODS = {0.05: 30, 0.2: 20, 0.5: 15, 1.0: 10, 2.0: 9}  # frames in one, by speed in µm/s
IN_A_MOVIE, MODE = 3, 2  # periods; waves around the cell

PREDICT: dict[str, dict[str, Any]] = {
    "one way, r = 0.3": {"strength": 0.3},
    "one way, r = 0.5": {"strength": 0.5},
    "one way, r = 0.5, neighbouring frames alike": {"kind": "ar1", "strength": 0.5, "edge_speed_px": 0.5},
    "both ways, r = 0.4": {"coupling": "both ways", "strength": 0.4},
    "neither": {"coupling": "none"},
    "neither, neighbouring frames alike": {"kind": "ar1", "coupling": "none", "edge_speed_px": 0.5},
    "driver of both, r = 0.6": {"coupling": "common driver", "strength": 0.6},
    "driver of both, given": {"coupling": "common driver", "strength": 0.6, "give": True},
}


def measured(cell: cd.simulate.DrivenMovie) -> tuple[xr.DataArray, xr.DataArray]:
    """Channels by window and velocity by sector, from masks and images."""
    movie = cd.map_movie(cell.masks, pixel_size_um=cell.pixel_size_um, frame_interval_s=cell.frame_interval_s)
    signal = cd.sample_movie(movie, cd.polar_windows(layers=LAYERS, sectors=SECTORS), cell.signal)["mean"]
    return signal, cd.edge_velocity(movie, sectors=SECTORS)


def predicted(case: str, number: int) -> dict[str, float]:
    """Both directions in layer 0 of one movie."""
    settings = dict(PREDICT[case])
    kind, give = settings.pop("kind", "white"), settings.pop("give", False)
    cell = cd.simulate.predicting_movie(kind, FIRST_SEED + number, frames=FRAMES, **CELL, **settings)
    signal, velocity = measured(cell)
    outer = signal.sel(layer=0)
    source = outer.sel(channel="source")
    given = [outer.sel(channel="driver")] if give else []
    forth, back = (
        cd.predict(one, other, given, surrogates=SURROGATES)
        for one, other in ((source, velocity), (velocity, source))
    )
    return {
        "p": float(forth["p"]),
        "back": float(back["p"]),
        "larger": float(forth["gain_excess"] > back["gain_excess"]),
        "gain": float(forth["gain"]),
        "true": cell.truth["gain"],
    }


def waved(kind: Any, speed_um_s: float, number: int) -> dict[str, float]:
    """Kind, direction and speed of the wave of one movie."""
    seed, direction = FIRST_SEED + number, 1 if number % 2 else -1
    length_um = 2.0 * np.pi * CELL["radius_px"] * 0.16
    period = PERIODS[speed_um_s]
    interval = length_um / (MODE * speed_um_s * period)
    wave: dict[str, Any] = {"mode": MODE, "period_s": period * interval, "frame_interval_s": interval}
    wave |= {"noise": 1.0, "persistence_s": 2.0 * period * interval if kind == "none" else None}
    frames = IN_A_MOVIE * period
    cell = cd.simulate.wave_movie(
        kind, seed, frames=frames, direction=direction, edge_speed_px=0.8, **wave, **CELL
    )
    found = cd.edge_waves(
        measured(cell)[1], interval, cell.truth["edge_length_um"], surrogates=SURROGATES, seed=seed
    )
    names = {"running": "rotating", "standing": "standing", "none": "none"}
    truth = cell.truth["speed_um_s"]
    return {
        "kind": float(found["kind"].item() == names[kind]),
        "direction": float(np.sign(found["speed"].item()) == direction),
        "error": abs(found["speed_um_s"].item() / truth - 1.0) if truth else np.nan,
    }


def predict_row(case: str, trials: Sequence[dict[str, float]]) -> list[str | Figure]:
    """Shares of one case."""
    table = {name: np.array([trial[name] for trial in trials]) for name in trials[0]}
    one_way, none = case.startswith("one way"), case.startswith("neither")
    forth, back = (float((table[name] <= ALPHA).mean()) for name in ("p", "back"))
    ratio = np.median(table["gain"]) / table["true"][0] if table["true"][0] else np.nan
    return [
        case,
        Figure("p", forth, "", 0.9 if one_way or case.startswith("both") else None, 0.2 if none else None),
        Figure("back", back, "", 0.9 if case.startswith("both") else None, 0.2 if none or one_way else None),
        Figure("larger", float(table["larger"].mean()), "", 0.9 if one_way else None),
        "" if np.isnan(ratio) else Figure("gain", float(ratio)),
    ]


def wave_row(kind: str, speed: float, trials: Sequence[dict[str, float]]) -> list[str | Figure]:
    """Shares and the largest error of one case."""
    runs = kind == "running"
    named, way, error = (np.array([trial[name] for trial in trials]) for name in trials[0])
    return [
        f"{kind}, {speed:g} µm/s" if runs else kind,
        Figure("kind", float(named.mean()), "", 0.8 if kind == "none" else 0.9),
        Figure("direction", float(way.mean()), "", 0.95) if runs else "",
        Figure("error", 100.0 * float(error.max()), "%", None, 10.0) if runs else "",
    ]


def print_table(heads: Sequence[str], rows: Iterable[list[str | Figure]]) -> bool:
    """A Markdown table with yardsticks; whether all are met."""
    print(f"| {' | '.join(heads)} |\n|{'---|' * len(heads)}")
    good = True
    for row in rows:
        words = []
        for cell in row:
            if isinstance(cell, str):
                words.append(cell)
                continue
            good &= cell.met is not False
            asked = f" ({cell.yardstick})" if cell.yardstick else ""
            words.append(f"{cell.measured}{asked}{' MISSED' if cell.met is False else ''}")
        print(f"| {' | '.join(words)} |", flush=True)
    print()
    return good


def run(movies: int, only: Sequence[str], each: Callable[..., Any]) -> bool:
    """Print what was asked for; `each` is a `map`, of one process or several."""
    good = True
    if "predict" in only:
        rows = (predict_row(case, list(each(partial(predicted, case), range(movies)))) for case in PREDICT)
        heads = (
            "channel and edge",
            "p ≤ 0.05",
            "backwards",
            "gain larger forwards",
            "gain over the true one",
        )
        good &= print_table(heads, rows)
    if "waves" in only:
        cases = [("running", speed) for speed in PERIODS] + [("standing", 0.5), ("none", 0.5)]
        rows = (wave_row(*case, list(each(partial(waved, *case), range(movies)))) for case in cases)
        good &= print_table(("edge", "right kind", "right direction", "largest error of the speed"), rows)
    return good


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--movies", type=int, default=20, help="of each case (default 20)")
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    parser.add_argument("--only", nargs="+", choices=("predict", "waves"), default=("predict", "waves"))
    chosen = parser.parse_args()
    os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
    warnings.simplefilter("ignore")
    with ProcessPoolExecutor(chosen.workers) as pool:
        sys.exit(0 if run(chosen.movies, chosen.only, pool.map) else 1)


if __name__ == "__main__":
    main()
