"""What each kind of movie shows: the shape of a cell at rest and the flow that moves it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.simulate.flow import NO_RUFFLES, NOTHING, Flow, Ruffles, Swing, no_numbers
from cytodisk.simulate.fluctuation import NO_FLUCTUATION, Fluctuation, random_fluctuation
from cytodisk.simulate.pose import Pose
from cytodisk.simulate.resting_shapes import ANGLE, egg, lobed, of_area, outward, polar, waves

MovieKind = Literal[
    "bulging",
    "migrating",
    "translating",
    "turning",
    "necking",
    "neutrophil",
    "spiky",
    "ruffling",
    "growing",
    "still",
    "dropping",
    "fluctuating",
]
MOVIE_KINDS: tuple[MovieKind, ...] = get_args(MovieKind)


@dataclass(frozen=True)
class Habits:
    """Numbers of a kind that the caller may replace.

    Attributes
    ----------
    speed_px : float
        In pixels per frame; of the edge for "growing", of the whole cell else.
    turn_deg : float
        In degrees per frame.
    protrusion_px : float or None
        Height of the largest protrusion, in pixels; None for a kind that has none. For "fluctuating" three
        standard deviations of the edge about its mean place.
    jitter_px : float
        Standard deviation of the drawn edge about the true one, in pixels.
    dropped : float
        Share of frames whose mask is empty.
    """

    speed_px: float = 0.0
    turn_deg: float = 0.0
    protrusion_px: float | None = None
    jitter_px: float = 0.0
    dropped: float = 0.0


HABITS: dict[MovieKind, Habits] = {
    "bulging": Habits(protrusion_px=15.0),
    "migrating": Habits(speed_px=0.7, turn_deg=0.5, protrusion_px=11.0),
    "translating": Habits(speed_px=1.5),
    "turning": Habits(turn_deg=2.0),
    "necking": Habits(),
    "neutrophil": Habits(speed_px=1.0, turn_deg=1.0, protrusion_px=18.0),
    "spiky": Habits(protrusion_px=15.0),
    "ruffling": Habits(protrusion_px=4.0),
    "growing": Habits(speed_px=1.0),
    "still": Habits(jitter_px=1.0),
    "dropping": Habits(protrusion_px=15.0, dropped=0.15),
    "fluctuating": Habits(protrusion_px=12.0),
}


@dataclass(frozen=True, eq=False)
class Plan:
    """A cell at rest and how it moves.

    Attributes
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        From +x towards +y, in the cell's frame, before any push.
    places_yx : ndarray of shape (K, 2) and dtype float
        Where the pushes sit on that outline.
    flow : Flow
    pose : Pose
    """

    outline_yx: FloatArray
    places_yx: FloatArray
    flow: Flow
    pose: Pose


@dataclass(frozen=True, eq=False)
class _Motion:
    """Outline with the cell's heading along +x, and everything that changes its shape."""

    outline_yx: FloatArray
    push: Swing = NOTHING
    push_width: FloatArray = field(default_factory=no_numbers)
    push_at: FloatArray = field(default_factory=no_numbers)  # angle of its place as seen from the centre
    stretch: Swing = NOTHING
    bend: Swing = NOTHING
    neck: Swing = NOTHING
    neck_width: float = 1.0
    ruffles: Ruffles = NO_RUFFLES
    fluctuation: Fluctuation = NO_FLUCTUATION


def plan_movie(kind: MovieKind, random: np.random.Generator, radius: float, habits: Habits) -> Plan:
    """Draw shape, places, phases and directions of one movie.

    Parameters
    ----------
    kind : str
        One of `MOVIE_KINDS`.
    random : Generator
    radius : float
        Radius of the disk of the same area as the cell at rest, in pixels.
    habits : Habits

    Returns
    -------
    Plan
    """
    motion = _MAKERS[kind](random, radius, habits.protrusion_px or 0.0)
    y, x = motion.outline_yx.T
    places = [int(np.cos(np.arctan2(y, x) - angle).argmax()) for angle in motion.push_at]
    normal = outward(motion.outline_yx)[places]
    growing = kind == "growing"
    flow = Flow(
        radius=radius,
        push=motion.push,
        push_width=motion.push_width,
        push_angle=np.arctan2(normal[:, 0], normal[:, 1]),
        ruffles=motion.ruffles,
        fluctuation=motion.fluctuation,
        growth=habits.speed_px if growing else 0.0,
    )
    pose = Pose(
        radius=radius,
        heading=random.uniform(-np.pi, np.pi),
        turn=np.radians(habits.turn_deg),
        speed=0.0 if growing else habits.speed_px,
        neck=motion.neck,
        neck_width=motion.neck_width,
        stretch=motion.stretch,
        bend=motion.bend,
    )
    return Plan(motion.outline_yx, motion.outline_yx[places], flow, pose)


def _bulging(random: np.random.Generator, radius: float, height: float) -> _Motion:
    return _Motion(
        lobed(random, radius, 0.03),
        push=_swing(random, height * random.uniform(0.7, 1.0, 5), (20.0, 30.0)),
        push_width=radius / 45.0 * random.uniform(8.0, 12.0, 5),
        push_at=_spread(random, 5),
    )


def _migrating(random: np.random.Generator, radius: float, height: float) -> _Motion:
    """A broad front of four overlapping pushes, four small ones aside, and a tail that is pulled in."""
    front = np.radians([-66.0, -22.0, 22.0, 66.0]) + random.uniform(-0.12, 0.12, 4)
    side = np.radians([-140.0, -108.0, 108.0, 140.0]) + random.uniform(-0.2, 0.2, 4)
    share = np.concatenate([random.uniform(0.6, 1.0, 4), random.uniform(0.3, 0.6, 4), [0.6]])
    width = np.concatenate([random.uniform(10.0, 13.0, 4), random.uniform(7.0, 9.0, 4), [11.0]])
    return _Motion(
        egg(random, radius),
        push=_swing(random, height * share, (18.0, 30.0)),
        push_width=radius / 45.0 * width,
        push_at=np.concatenate([front, side, [np.pi]]),
        stretch=_between(random, [-0.04, -0.05], [0.1, 0.05], (25.0, 40.0)),
    )


def _rigid(random: np.random.Generator, radius: float, height: float) -> _Motion:
    return _Motion(lobed(random, radius, 0.1))


def _necking(random: np.random.Generator, radius: float, height: float) -> _Motion:
    """Two lobes whose waist of 1.25 radii narrows to a ninth of the radius: 5 px of 45."""
    outline = of_area(polar(1.0 + 0.38 * np.cos(2.0 * ANGLE) + waves(random, 0.02)), radius)
    y, x = outline.T
    waist = 2.0 * np.abs(y[np.abs(x) < 2.0]).mean()
    narrowing = np.log(waist / (radius / 9.0))
    neck = Swing(np.zeros(1), np.array([narrowing]), random.uniform(32.0, 40.0, 1), np.zeros(1))
    return _Motion(outline, neck=neck, neck_width=radius / 45.0 * random.uniform(12.0, 16.0))


def _neutrophil(random: np.random.Generator, radius: float, height: float) -> _Motion:
    """Stretch up to 2:1 whose axis leans from side to side, bending, and large pseudopods in front."""
    places = np.concatenate([np.radians([-45.0, 5.0, 50.0]), np.radians([-110.0, 110.0])])
    share = np.concatenate([random.uniform(0.75, 1.0, 3), random.uniform(0.4, 0.7, 2)])
    return _Motion(
        lobed(random, radius, 0.04),
        push=_swing(random, height * share, (22.0, 36.0)),
        push_width=radius / 45.0 * random.uniform(12.0, 15.0, 5),
        push_at=places + random.uniform(-0.25, 0.25, 5),
        stretch=_between(random, [-0.1, -0.22], [0.3, 0.22], (28.0, 44.0)),
        bend=_between(random, [-0.25 * radius], [0.25 * radius], (26.0, 40.0)),
    )


def _spiky(random: np.random.Generator, radius: float, height: float) -> _Motion:
    return _Motion(
        lobed(random, radius, 0.03),
        push=_swing(random, height * random.uniform(0.6, 1.0, 12), (24.0, 36.0)),
        push_width=random.uniform(3.0, 3.5, 12),
        push_at=_spread(random, 12),
    )


def _ruffling(random: np.random.Generator, radius: float, height: float) -> _Motion:
    period = random.uniform(16.0, 24.0, 3) * random.choice([-1.0, 1.0])
    speed = 2.0 * np.pi / np.abs(period) * height * np.array([0.3, 0.45, 0.25])
    ruffles = Ruffles(np.array([3.0, 5.0, 8.0]), speed, period, random.uniform(-np.pi, np.pi, 3))
    return _Motion(lobed(random, radius, 0.03), ruffles=ruffles)


def _growing(random: np.random.Generator, radius: float, height: float) -> _Motion:
    return _Motion(radius * polar(np.ones_like(ANGLE)))


def _fluctuating(random: np.random.Generator, radius: float, height: float) -> _Motion:
    directions = _spread(random, int(random.integers(14, 21)))
    return _Motion(
        lobed(random, radius, 0.03), fluctuation=random_fluctuation(random, directions, height / 3.0)
    )


_MAKERS: dict[MovieKind, Callable[[np.random.Generator, float, float], _Motion]] = {
    "bulging": _bulging,
    "migrating": _migrating,
    "translating": _rigid,
    "turning": _rigid,
    "necking": _necking,
    "neutrophil": _neutrophil,
    "spiky": _spiky,
    "ruffling": _ruffling,
    "growing": _growing,
    "still": _rigid,
    "dropping": _bulging,
    "fluctuating": _fluctuating,
}


def _spread(random: np.random.Generator, count: int) -> FloatArray:
    """Angles all around, uneven, no two close to each other."""
    step = 2.0 * np.pi / count
    return step * (np.arange(count) + random.uniform(-0.25, 0.25, count)) + random.uniform(0.0, 2.0 * np.pi)


def _swing(random: np.random.Generator, high: FloatArray, period: tuple[float, float]) -> Swing:
    """From 0 up and back, each in its own time."""
    phase = random.uniform(-np.pi, np.pi, high.size)
    return Swing(np.zeros_like(high), high, random.uniform(*period, high.size), phase)


def _between(
    random: np.random.Generator, low: list[float], high: list[float], period: tuple[float, float]
) -> Swing:
    swing = _swing(random, np.array(high), period)
    return Swing(np.array(low), swing.high, swing.period, swing.phase)
