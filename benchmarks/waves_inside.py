"""Speed inwards that `disk_waves` finds of waves that are known, and how often it finds one in noise.

    benchmarks/waves_inside.py [--trials 40] [--null 400] [--surrogates 39]

Waves that run inwards, outwards, around, or around and inwards, through 6 layers of 1 µm and 16 sectors,
with random speeds inwards (0.05 to 2 µm/s), 8 to 16 frames per period, 1.5 to 3.6 periods, one wave in 5 to
12 µm of depth, and noise of 0.3 to 1 times the wave's standard deviation. Prints the share whose kind is
right with p ≤ 0.05, whose speed inwards is within 10 %, and the median error. Then the share of movies of
noise with p ≤ 0.05, beside 0.03 to 0.07. Ends with status 1 unless speeds are within 10 % in 95 % of the
trials, and rates within their range and three standard errors.
"""

import argparse
import sys

import numpy as np

import cytodisk as cd
from waves_cases import FIRST_SEED, NOISES

LAYERS, SECTORS, FRAMES = 6, 16, 75
KINDS = {"inward": "inwards", "outward": "outwards", "spiral": "spiral", "running": "around"}
LOW, HIGH = 0.03, 0.07


def measured(kind: str, seed: int, noise: float, surrogates: int) -> tuple[bool, float]:
    """Whether the kind is right, and the error of the speed inwards (0 where nothing runs inwards)."""
    random = np.random.default_rng([seed, 9])
    speed, wavelength = np.exp(random.uniform(np.log(0.05), np.log(2.0))), random.uniform(5.0, 12.0)
    period = wavelength / speed
    per_period, periods = random.uniform(8.0, 16.0), random.uniform(1.5, 3.6)
    wave = cd.simulate.wave_series(
        kind,  # type: ignore[arg-type]
        seed,
        int(np.ceil(per_period * periods)),
        SECTORS,
        LAYERS,
        mode=int(random.integers(1, 4)),
        period_s=period,
        frame_interval_s=period / per_period,
        wavelength_um=wavelength,
        noise=noise,
    )
    found = cd.disk_waves(wave, surrogates=surrogates, seed=seed, max_mode=4)
    truth = wave.attrs["inward_speed_um_s"]
    error = abs(found["inward_speed_um_s"].item() / truth - 1.0) if truth else 0.0
    return found["kind"].item() == KINDS[kind], error


def false_rate(name: str, trials: int, surrogates: int) -> float:
    """Share of movies of noise with p of at most 0.05."""
    kind, length = NOISES[name]
    p = []
    for seed in range(FIRST_SEED, FIRST_SEED + trials):
        values = cd.simulate.independent_series(
            kind,  # type: ignore[arg-type]
            seed,
            FRAMES,
            LAYERS,
            SECTORS,
            correlation_length=length,
        )[0]
        p.append(cd.disk_waves(values, 2.0, surrogates=surrogates, seed=seed, max_mode=4)["p"].item())
    return float((np.array(p) <= 0.05).mean())


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--trials", type=int, default=40, help="waves of each row (default 40)")
    parser.add_argument("--null", type=int, default=400, help="movies of each noise (default 400)")
    parser.add_argument("--surrogates", type=int, default=39, help="of each movie (default 39)")
    parser.add_argument(
        "--noise", nargs="+", default=list(NOISES), choices=list(NOISES), help="(default all)"
    )
    chosen = parser.parse_args()
    met = []
    print("| wave | noise | kind and p | speed ± 10 % | median error |\n|---|---|---|---|---|")
    for kind in KINDS:
        for noise in (0.3, 1.0):
            seeds = range(FIRST_SEED, FIRST_SEED + chosen.trials)
            found = np.array([measured(kind, seed, noise, chosen.surrogates) for seed in seeds])
            right, speed = float(found[:, 0].mean()), float((found[:, 1] <= 0.1).mean())
            shown = f"{speed:.3f} | {np.median(found[:, 1]):.2%}" if kind != "running" else "– | –"
            print(
                f"| {kind} | {noise:g} | {right:.3f} | {shown} |{'' if speed >= 0.95 else ' NO'}", flush=True
            )
            met.append(speed >= 0.95)
    room = 3.0 * np.sqrt(0.05 * 0.95 / chosen.null)
    print("\n| noise | movies | p ≤ 0.05 | 0.03 to 0.07? |\n|---|---|---|---|")
    for name in chosen.noise:
        rate = false_rate(name, chosen.null, chosen.surrogates)
        is_met = LOW - room <= rate <= HIGH + room
        print(
            f"| {name} | {chosen.null} | {rate:.3f} ± {room:.3f} | {'yes' if is_met else 'NO'} |", flush=True
        )
        met.append(is_met)
    return 0 if all(met) else 1


if __name__ == "__main__":
    sys.exit(main())
