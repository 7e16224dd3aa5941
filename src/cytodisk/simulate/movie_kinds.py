"""Kinds of movies, and the numbers of each that the caller may replace."""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

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
    "filopodium",
    "waving",
    "lobes",
    "lamellipodium",
]
MOVIE_KINDS: tuple[MovieKind, ...] = get_args(MovieKind)
# Their edge is exact. How far its points slide along it, and what lies inside, is a convention.
EDGE_KINDS: tuple[MovieKind, ...] = ("filopodium", "waving", "lobes", "lamellipodium")


@dataclass(frozen=True)
class Habits:
    """Numbers of a kind that the caller may replace.

    Attributes
    ----------
    speed_px : float
        In pixels per frame; of the edge that grows for "growing", "filopodium" and "lamellipodium", of the
        whole cell else.
    turn_deg : float
        In degrees per frame.
    heading_deg : float or None
        Direction of the cell in frame 0, in degrees from +x towards +y; None to draw it.
    protrusion_px : float or None
        Height of the largest protrusion, in pixels; None for a kind that has none. For "fluctuating" three
        standard deviations of the edge about its mean place.
    jitter_px : float
        Standard deviation of the drawn edge about the true one, in pixels.
    jitter_length_px : float
        Over which it stays correlated along the edge.
    dropped : float
        Share of frames whose mask is empty.
    waves : int or None
        Number of waves around the cell; None for a kind that has none, 0 to draw one of 2, 4 and 5.
    """

    speed_px: float = 0.0
    turn_deg: float = 0.0
    heading_deg: float | None = None
    protrusion_px: float | None = None
    jitter_px: float = 0.0
    jitter_length_px: float = 8.0
    dropped: float = 0.0
    waves: int | None = None

    def heading(self, drawn: float) -> float:
        """Direction of the cell in frame 0, in radians, for one that was drawn."""
        return drawn if self.heading_deg is None else float(np.radians(self.heading_deg))

    @property
    def height_px(self) -> float:
        """Height of the largest protrusion, 0 where there is none."""
        return self.protrusion_px or 0.0


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
    "filopodium": Habits(speed_px=4.0),
    "waving": Habits(protrusion_px=6.0, waves=3),
    "lobes": Habits(protrusion_px=8.0, waves=0),
    "lamellipodium": Habits(speed_px=1.5),
}
