"""What each kind of movie shows: the shape of a cell at rest and the flow that moves it."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.simulate.flow import NO_RUFFLES, NOTHING, Flow, Ruffles, Swing, no_numbers
from cytodisk.simulate.fluctuation import NO_FLUCTUATION, Fluctuation, random_fluctuation
from cytodisk.simulate.growing_edges import Filopodium, Growth, Lamellipodium
from cytodisk.simulate.movie_kinds import Habits, MovieKind
from cytodisk.simulate.pose import Pose
from cytodisk.simulate.resting_shapes import ANGLE, egg, lobed, of_area, outward, polar, waves

_WAVE_TURN = np.radians(5.0)  # a frame
_LOBES_PERIOD = 20.0  # frames


@dataclass(frozen=True, eq=False)
class Plan:
    """A cell at rest and how it moves.

    Attributes
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        From +x towards +y, in the cell's frame, before any push.
    places_yx : ndarray of shape (K, 2) and dtype float
        Where the pushes sit on that outline.
    flow : Flow, Filopodium or Lamellipodium
    pose : Pose
    """

    outline_yx: FloatArray
    places_yx: FloatArray
    flow: Flow | Growth
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
    if kind in _GROWTHS:
        growth = _GROWTHS[kind](radius, habits.speed_px)
        pose = Pose(
            radius, heading=habits.heading(random.uniform(-np.pi, np.pi)), turn=np.radians(habits.turn_deg)
        )
        return Plan(growth.outline_yx, np.zeros((0, 2)), growth, pose)
    motion = _MAKERS[kind](random, radius, habits)
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
        heading=habits.heading(random.uniform(-np.pi, np.pi)),
        turn=np.radians(habits.turn_deg),
        speed=0.0 if growing else habits.speed_px,
        neck=motion.neck,
        neck_width=motion.neck_width,
        stretch=motion.stretch,
        bend=motion.bend,
    )
    return Plan(motion.outline_yx, motion.outline_yx[places], flow, pose)


def _bulging(random: np.random.Generator, radius: float, habits: Habits) -> _Motion:
    return _Motion(
        lobed(random, radius, 0.03),
        push=_swing(random, habits.height_px * random.uniform(0.7, 1.0, 5), (20.0, 30.0)),
        push_width=radius / 45.0 * random.uniform(8.0, 12.0, 5),
        push_at=_spread(random, 5),
    )


def _migrating(random: np.random.Generator, radius: float, habits: Habits) -> _Motion:
    """A broad front of four overlapping pushes, four small ones aside, and a tail that is pulled in."""
    front = np.radians([-66.0, -22.0, 22.0, 66.0]) + random.uniform(-0.12, 0.12, 4)
    side = np.radians([-140.0, -108.0, 108.0, 140.0]) + random.uniform(-0.2, 0.2, 4)
    share = np.concatenate([random.uniform(0.6, 1.0, 4), random.uniform(0.3, 0.6, 4), [0.6]])
    width = np.concatenate([random.uniform(10.0, 13.0, 4), random.uniform(7.0, 9.0, 4), [11.0]])
    return _Motion(
        egg(random, radius),
        push=_swing(random, habits.height_px * share, (18.0, 30.0)),
        push_width=radius / 45.0 * width,
        push_at=np.concatenate([front, side, [np.pi]]),
        stretch=_between(random, [-0.04, -0.05], [0.1, 0.05], (25.0, 40.0)),
    )


def _rigid(random: np.random.Generator, radius: float, habits: Habits) -> _Motion:
    return _Motion(lobed(random, radius, 0.1))


def _necking(random: np.random.Generator, radius: float, habits: Habits) -> _Motion:
    """Two lobes whose waist of 1.25 radii narrows to a ninth of the radius: 5 px of 45."""
    outline = of_area(polar(1.0 + 0.38 * np.cos(2.0 * ANGLE) + waves(random, 0.02)), radius)
    y, x = outline.T
    waist = 2.0 * np.abs(y[np.abs(x) < 2.0]).mean()
    narrowing = np.log(waist / (radius / 9.0))
    neck = Swing(np.zeros(1), np.array([narrowing]), random.uniform(32.0, 40.0, 1), np.zeros(1))
    return _Motion(outline, neck=neck, neck_width=radius / 45.0 * random.uniform(12.0, 16.0))


def _neutrophil(random: np.random.Generator, radius: float, habits: Habits) -> _Motion:
    """Stretch up to 2:1 whose axis leans from side to side, bending, and large pseudopods in front."""
    places = np.concatenate([np.radians([-45.0, 5.0, 50.0]), np.radians([-110.0, 110.0])])
    share = np.concatenate([random.uniform(0.75, 1.0, 3), random.uniform(0.4, 0.7, 2)])
    return _Motion(
        lobed(random, radius, 0.04),
        push=_swing(random, habits.height_px * share, (22.0, 36.0)),
        push_width=radius / 45.0 * random.uniform(12.0, 15.0, 5),
        push_at=places + random.uniform(-0.25, 0.25, 5),
        stretch=_between(random, [-0.1, -0.22], [0.3, 0.22], (28.0, 44.0)),
        bend=_between(random, [-0.25 * radius], [0.25 * radius], (26.0, 40.0)),
    )


def _spiky(random: np.random.Generator, radius: float, habits: Habits) -> _Motion:
    return _Motion(
        lobed(random, radius, 0.03),
        push=_swing(random, habits.height_px * random.uniform(0.6, 1.0, 12), (24.0, 36.0)),
        push_width=random.uniform(3.0, 3.5, 12),
        push_at=_spread(random, 12),
    )


def _ruffling(random: np.random.Generator, radius: float, habits: Habits) -> _Motion:
    period = random.uniform(16.0, 24.0, 3) * random.choice([-1.0, 1.0])
    speed = 2.0 * np.pi / np.abs(period) * habits.height_px * np.array([0.3, 0.45, 0.25])
    ruffles = Ruffles(np.array([3.0, 5.0, 8.0]), speed, period, random.uniform(-np.pi, np.pi, 3))
    return _Motion(lobed(random, radius, 0.03), ruffles=ruffles)


def _waving(random: np.random.Generator, radius: float, habits: Habits) -> _Motion:
    """A round cell with waves that travel around it, 5° a frame, so that its edge slides past."""
    count, phase = habits.waves or 0, random.uniform(-np.pi, np.pi)
    turn = random.choice([-1.0, 1.0]) * _WAVE_TURN
    speed = count * turn * habits.height_px
    ruffles = Ruffles(
        np.array([float(count)]),
        np.array([speed]),
        np.array([2.0 * np.pi / (count * turn)]),
        np.array([phase]),
    )
    return _Motion(polar(radius + habits.height_px * np.cos(count * ANGLE + phase)), ruffles=ruffles)


def _lobes(random: np.random.Generator, radius: float, habits: Habits) -> _Motion:
    """A round cell with lobes that stand, sink, and rise again where the hollows were."""
    drawn, phase, time = (
        random.choice([2, 4, 5]),
        random.uniform(-np.pi, np.pi),
        random.uniform(-np.pi, np.pi),
    )
    count = float(habits.waves or drawn)
    speed = np.pi / _LOBES_PERIOD * habits.height_px
    ruffles = Ruffles(
        np.full(2, count),
        np.full(2, speed),
        np.array([_LOBES_PERIOD, -_LOBES_PERIOD]),
        np.array([phase - time, phase + time]),
    )
    lobes = habits.height_px * np.sin(time) * np.sin(count * ANGLE + phase)
    return _Motion(polar(radius + lobes), ruffles=ruffles)


def _growing(random: np.random.Generator, radius: float, habits: Habits) -> _Motion:
    return _Motion(radius * polar(np.ones_like(ANGLE)))


def _fluctuating(random: np.random.Generator, radius: float, habits: Habits) -> _Motion:
    directions = _spread(random, int(random.integers(14, 21)))
    return _Motion(
        lobed(random, radius, 0.03),
        fluctuation=random_fluctuation(random, directions, habits.height_px / 3.0),
    )


_MAKERS: dict[MovieKind, Callable[[np.random.Generator, float, Habits], _Motion]] = {
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
    "waving": _waving,
    "lobes": _lobes,
}
_GROWTHS: dict[MovieKind, type[Growth]] = {"filopodium": Filopodium, "lamellipodium": Lamellipodium}


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
