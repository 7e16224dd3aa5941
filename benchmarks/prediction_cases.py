"""Pairs of simulated signals of which it is known whether one predicts the other, by block and name."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

import cytodisk as cd
from cytodisk.arrays import FloatArray

FRAMES, SECTORS = 150, 60
FRAME_COUNTS = (20, 30, 45, 60, 90, 120)
KINDS = ("white", "ar1", "slow", "smooth", "oscillating")
_SOURCE_APART = 500_000  # between seeds of a pair whose signals are made separately


@dataclass(frozen=True, eq=False)
class Signals:
    """A source and a target of shape (T, S), what is given, and settings of `predict`."""

    source: FloatArray
    target: FloatArray
    given: tuple[FloatArray, ...] = ()
    settings: dict[str, Any] = field(default_factory=dict)

    @property
    def back(self) -> "Signals":
        """The same with source and target exchanged."""
        return Signals(self.target, self.source, self.given, self.settings)


Make = Callable[[int], Signals]


def pair(
    kind: Any, give: bool = False, frames: int = FRAMES, sectors: int = SECTORS, **settings: Any
) -> Make:
    """What makes a pair of `predicting_series` from a seed."""

    def make(seed: int) -> Signals:
        made = cd.simulate.predicting_series(kind, seed, frames, 1, sectors, **settings)
        given = (made["driver"].to_numpy(),) if give else ()
        return Signals(made["source"].to_numpy()[:, 0], made["target"].to_numpy(), given)

    return make


def unlike(source: Any, target: Any) -> Make:
    """What makes two signals of different kinds that have nothing to do with each other."""

    def make(seed: int) -> Signals:
        first, second = pair(source, coupling="none"), pair(target, coupling="none")
        return Signals(first(seed).source, second(seed + _SOURCE_APART).target)

    return make


def changed(make: Make, change: Callable[[Signals, np.random.Generator], Signals]) -> Make:
    """What makes the same signals, and changes them."""
    return lambda seed: change(make(seed), np.random.default_rng([seed, 77]))


def with_settings(make: Make, **settings: Any) -> Make:
    """What makes the same signals, with settings of `predict`."""
    return lambda seed: replace(make(seed), settings=settings)


def with_trends(signals: Signals, random: np.random.Generator) -> Signals:
    """Straight lines on both, the same in all sectors, that rise or fall by 2 to 4 standard deviations."""
    time = np.linspace(-0.5, 0.5, len(signals.source))[:, None]
    sizes = random.uniform(2.0, 4.0, 2) * random.choice([-1.0, 1.0], 2)
    return Signals(signals.source + sizes[0] * time, signals.target + sizes[1] * time)


def with_walks(signals: Signals, random: np.random.Generator) -> Signals:
    """A random walk of the whole cell on both, of one standard deviation from start to end."""
    walks = random.normal(size=(2, len(signals.source), 1)).cumsum(axis=1) / np.sqrt(len(signals.source))
    return Signals(signals.source + walks[0], signals.target + walks[1])


def without_lines(signals: Signals, _: np.random.Generator) -> Signals:
    """Both without the straight line through each series."""
    lines = [cd.prepare_series(one, detrend="linear") for one in (signals.source, signals.target)]
    return Signals(lines[0], lines[1])


def by_square(signals: Signals, _: np.random.Generator) -> Signals:
    """A target that follows the source's square two frames later, r = 0.3."""
    follows = np.roll(signals.source**2 - 1.0, 2, axis=0) / np.sqrt(2.0)
    return Signals(signals.source, np.sqrt(1.0 - 0.3**2) * signals.target + 0.3 * follows)


def by_product(signals: Signals, _: np.random.Generator) -> Signals:
    """A target whose size, not its sign, follows the source two frames later."""
    size = np.exp(0.5 * np.roll(signals.source, 2, axis=0))
    return Signals(signals.source, signals.target * size)


def with_flicker(signals: Signals, random: np.random.Generator) -> Signals:
    """The same noise in both in each frame and sector, as two channels of one camera have: half of each."""
    flicker = random.normal(size=signals.source.shape)
    return Signals(signals.source + flicker, signals.target + flicker)


ALIKE = {"correlation_length": 5.0}


def _null() -> dict[str, Make]:
    sizes = {"": (150, 60), ", 60 frames": (60, 60), ", 8 sectors": (150, 8), ", one sector": (150, 1)}
    found = {
        f"{kind}{words}": pair(kind, frames=frames, sectors=sectors, coupling="none")
        for words, (frames, sectors) in sizes.items()
        for kind in KINDS
    }
    found["waves"] = pair("waves", coupling="none")
    found |= {f"{kind}, neighbours alike": pair(kind, coupling="none", **ALIKE) for kind in ("white", "ar1")}
    found["waves, neighbours alike"] = pair("waves", coupling="none", **ALIKE)
    found["slow source, white target"] = unlike("slow", "white")
    found["white source, slow target"] = unlike("white", "slow")
    found["waves source, ar1 target"] = unlike("waves", "ar1")
    return found


def _one_way() -> dict[str, Make]:
    kinds = [kind for kind in KINDS if kind != "smooth"]  # no autoregression: among the failures
    found = {kind: pair(kind) for kind in kinds}
    found |= {f"{kind}, neighbours alike": pair(kind, **ALIKE) for kind in kinds}
    found["ar1, r = 0.5"] = pair("ar1", strength=0.5)
    found["ar1, negative"] = pair("ar1", strength=-0.3)
    return found


def _given() -> dict[str, Make]:
    driven: dict[str, Any] = {"coupling": "common driver"}
    found = {f"{kind}, r = 0.3": pair(kind, give=True, **driven) for kind in KINDS}
    return found | {f"{kind}, r = 0.6": pair(kind, give=True, strength=0.6, **driven) for kind in KINDS}


def _failures() -> dict[str, Make]:
    """Where it fails; first what does not predict, then what predicts one way."""
    none = pair("ar1", coupling="none")
    found = {
        "common driver not given, r = 0.3": pair("ar1", coupling="common driver"),
        "common driver not given, r = 0.6": pair("ar1", coupling="common driver", strength=0.6),
        "common driver given, measured with as much noise": changed(
            pair("ar1", give=True, coupling="common driver", strength=0.6),
            lambda made, random: Signals(
                made.source, made.target, (made.given[0] + random.normal(size=made.source.shape),)
            ),
        ),
        "same frame alone, r = 0.5": pair("ar1", coupling="none", at_once=0.5),
        "same frame alone, r = 0.5, one frame in 2": pair("ar1", coupling="none", at_once=0.5, every=2),
        "same noise in both, half of each": changed(none, with_flicker),
        "masks that jitter, seen in both": pair("ar1", coupling="none", jitter=0.5, jitter_seen=0.5),
        "straight lines in both": changed(none, with_trends),
        "straight lines in both, taken out": changed(changed(none, with_trends), without_lines),
        "slow walks of the whole cell in both": changed(none, with_walks),
        "slow, one sector, 60 frames": pair("slow", frames=60, sectors=1, coupling="none"),
    }
    noise = {"source_noise": "source", "target_noise": "target"}
    for size in (0.5, 1.0, 2.0):
        for name, words in noise.items():
            found[f"one way, noise of the {words} {size:g} of its size"] = pair("ar1", **{name: size})
    found |= {f"one way, one frame in {every}": pair("ar1", every=every) for every in (2, 4, 8)}
    found["one way, smooth"] = pair("smooth")
    found["one way, smooth, max_order 20"] = with_settings(pair("smooth"), max_order=20)
    found["one way, waves and noise"] = pair("waves")
    found["one way, masks that jitter"] = pair("ar1", jitter=1.0)
    found["one way, masks that jitter, seen in both"] = pair("ar1", jitter=1.0, jitter_seen=0.5)
    found["one way, by the source's square"] = changed(pair("white", coupling="none"), by_square)
    found["one way, the source sets the target's size"] = changed(pair("white", coupling="none"), by_product)
    found["one way, lag 12, longer than max_order"] = pair("white", lags=(12,))
    return found


def unequal(strong: float, weak: float) -> Make:
    """What makes two signals that predict each other, the source the target better than the other way."""

    def make(seed: int) -> Signals:
        random = np.random.default_rng([seed, 78])
        source, target = random.normal(size=(2, FRAMES + 50, SECTORS))
        for frame in range(1, FRAMES + 50):
            before = source[frame - 1].copy(), target[frame - 1].copy()
            source[frame] += 0.5 * before[0] + weak * before[1]
            target[frame] += 0.5 * before[1] + strong * before[0]
        return Signals(source[50:], target[50:])

    return make


def _direction() -> dict[str, Make]:
    """One way, measured with noise, and both ways."""
    found = {
        f"one way, {kind}, r = {strength:g}, noise of the source {noise:g}": pair(
            kind, strength=strength, source_noise=noise
        )
        for kind in ("ar1", "slow")
        for strength in (0.3, 0.7)
        for noise in (0.5, 1.0, 2.0)
    }
    both: dict[str, Any] = {"coupling": "both ways"}
    for kind in ("ar1", "slow"):
        found[f"both ways, {kind}, r = 0.3"] = pair(kind, **both)
        found[f"both ways, {kind}, r = 0.3, noise of the source 1"] = pair(kind, source_noise=1.0, **both)
    found["both ways, 0.3 there and 0.25 back"] = unequal(0.3, 0.25)
    found["both ways, 0.3 there and 0.2 back"] = unequal(0.3, 0.2)
    found["both ways, 0.3 there and 0.1 back"] = unequal(0.3, 0.1)
    return found


def _frames() -> dict[str, Make]:
    """How many frames a link of r = 0.3 needs, and what few of them make of nothing."""
    found = {}
    for sectors in (24, 60):
        for words, alike in (("", {}), (", neighbours alike", ALIKE)):
            for frames in FRAME_COUNTS:
                name = f"{frames} frames, {sectors} sectors{words}"
                found[name] = pair("ar1", frames=frames, sectors=sectors, **alike)
                found[f"{name}: nothing"] = pair(
                    "ar1", frames=frames, sectors=sectors, coupling="none", **alike
                )
    return found


BLOCKS: dict[str, dict[str, Make]] = {
    "null": _null(),
    "one way": _one_way(),
    "given": _given(),
    "failures": _failures(),
    "direction": _direction(),
    "frames": _frames(),
}
"""Cases by block and name; what makes signals is looked up by these in each process."""
