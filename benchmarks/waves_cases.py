"""Series of the wave benchmarks: waves of known speed, and noise without a wave."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import cytodisk as cd

FIRST_SEED = 100_000  # no parameter was set on these
NOISES = {
    "white": ("white", 0.0),
    "AR": ("ar1", 0.0),
    "slow": ("slow", 0.0),
    "oscillating": ("oscillating", 0.0),
    "neighbours alike": ("white", 3.0),
    "neighbours alike, AR": ("ar1", 3.0),
    "neighbours alike, slow": ("slow", 3.0),
    "neighbours alike, oscillating": ("oscillating", 3.0),
}
BURSTS = "bursts"
BURST_FRAMES, BURST_SECTORS = 5.0, 2.0  # standard deviations of a burst
UM = 60.0  # length of the edge


def noise(name: str, seed: int, frames: int, sectors: int) -> NDArray[np.float64]:
    """Noise (time, sector) without a wave: one of `NOISES`, or bursts."""
    if name == BURSTS:
        return bursts(seed, frames, sectors)
    kind, length = NOISES[name]
    found = cd.simulate.independent_series(kind, seed, frames, 1, sectors, correlation_length=length)[1]  # type: ignore[arg-type]
    return np.asarray(found.to_numpy())


def bursts(seed: int, frames: int, sectors: int) -> NDArray[np.float64]:
    """Smooth bumps (time, sector) at random times and places, on a floor of white noise."""
    random = np.random.default_rng(seed)
    count = frames * sectors // 50
    at = random.uniform(-3.0 * BURST_FRAMES, frames + 3.0 * BURST_FRAMES, count)
    place = random.uniform(0.0, sectors, count)
    later = (np.arange(frames)[:, None] - at) / BURST_FRAMES
    around = (np.arange(sectors)[:, None] - place + 0.5 * sectors) % sectors - 0.5 * sectors
    sizes = random.exponential(2.0, count)
    shapes = np.exp(-0.5 * later**2) * sizes, np.exp(-0.5 * (around / BURST_SECTORS) ** 2)
    return np.asarray(shapes[0] @ shapes[1].T + 0.3 * random.normal(size=(frames, sectors)))


@dataclass(frozen=True)
class WaveCase:
    """A wave along an edge of 60 µm.

    Attributes
    ----------
    kind : str
        "running" or "standing".
    speed : float
        In µm/s, whatever the direction.
    mode, sectors : int
    frames_per_period, periods, noise : float
        Noise over the wave, as standard deviations.
    direction : int
    way : str
        "equal" sectors from a random sector on, "unequal" ones of known length, or a cell that "turns" on the
        slide, by which waves are faster or slower, with sectors that do not turn with it.
    seed : int
    """

    kind: str
    speed: float
    mode: int
    sectors: int
    frames_per_period: float
    periods: float
    noise: float
    direction: int
    way: str
    seed: int

    @property
    def interval(self) -> float:
        """Seconds between frames."""
        return UM / (self.mode * self.speed) / self.frames_per_period

    def series(self) -> tuple[NDArray[np.float64], Any, float]:
        """Values, length of the edge or of its sectors, and the true speed in µm/s as it is seen."""
        random = np.random.default_rng([self.seed, 7])
        frames = int(np.ceil(self.frames_per_period * self.periods))
        lengths = np.full(self.sectors, 1.0)
        if self.way == "unequal":
            lengths = random.lognormal(0.0, 0.4, self.sectors)
        lengths *= UM / lengths.sum()
        place = (np.cumsum(lengths) - 0.5 * lengths) / UM
        turn = np.arange(frames)[:, None] / self.frames_per_period
        drift = random.choice([-0.2, 0.2]) if self.way == "turns" and self.kind == "running" else 0.0
        start = random.uniform(0.0, 1.0, 2)
        if self.kind == "running":
            seen = self.direction + drift
            wave = np.cos(2.0 * np.pi * (self.mode * place - turn * seen + start[0]))
        else:
            seen = 0.0
            wave = np.cos(2.0 * np.pi * (self.mode * place + start[1])) * np.cos(
                2.0 * np.pi * (turn + start[0])
            )
        values = wave / wave.std() + self.noise * random.normal(size=wave.shape)
        edge: Any = UM
        if self.way == "unequal":
            edge = np.tile(lengths, (frames, 1))
        return values, edge, self.speed * seen


def random_case(kind: str, periods: float, noise_ratio: float, way: str, seed: int) -> WaveCase:
    """A wave of random speed (0.05 to 2 µm/s), direction, mode, frames per period and sectors."""
    random = np.random.default_rng([seed, 8])
    sectors = int(random.choice([12, 24, 60]))
    few = 10.0 if way == "turns" else 8.0  # a fifth faster, periods still have 8 frames
    more = 1.25 if way == "turns" else 1.0
    return WaveCase(
        kind,
        float(np.exp(random.uniform(np.log(0.05), np.log(2.0)))),
        int(random.integers(1, min(4, sectors // 4) + 1)),
        sectors,
        float(few * random.uniform(1.0, 2.5)),
        float(periods * more * random.uniform(1.0, 1.2)),
        noise_ratio,
        int(random.choice([-1, 1])),
        way,
        seed,
    )
