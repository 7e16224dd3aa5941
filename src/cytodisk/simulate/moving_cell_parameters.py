"""Parameters of simulated movies."""

from dataclasses import replace
from typing import Annotated, Self

from pydantic import Field, model_validator

from cytodisk.parameters import Parameters, parameter
from cytodisk.simulate.movie_kinds import HABITS, Habits, MovieKind

_MOST_PX = 100.0  # speed, protrusions, jitter: beyond any cell, and the images stay within memory


class HabitParameters(Parameters):
    """What a cell does, where it is not what all cells of its kind do."""

    speed_px: float | None = parameter(
        None,
        'Speed of the whole cell, for "growing", "filopodium" and "lamellipodium" of the edge where it '
        "grows; without it that of the kind.",
        least=0,
        most=_MOST_PX,
        unit="px/frame",
    )
    turn_deg: float | None = parameter(
        None,
        "Turn of the whole cell and its direction, positive from +x towards +y; without it that of the kind.",
        least=-180,
        unit="degrees/frame",
    )
    heading_deg: float | None = parameter(
        None,
        "Direction of the cell in frame 0, from +x towards +y: where it crawls, or where a filopodium or a "
        "lamellipodium grows; without it drawn from the seed.",
        least=-360,
        most=360,
        unit="degrees",
    )
    protrusion_px: float | None = parameter(
        None,
        'Height of the largest protrusion, for kinds that have protrusions; for "fluctuating" three standard '
        "deviations of the edge about its mean place. Without it that of the kind.",
        least=0,
        most=_MOST_PX,
        unit="px",
    )
    waves: int | None = parameter(
        None,
        'Number of waves or lobes around the cell, for "waving" (3 without it) and "lobes" (without it '
        "2, 4 or 5, drawn).",
        least=2,
        most=12,
    )
    jitter_px: float | None = parameter(
        None,
        "Standard deviation of the drawn outline about the true one, smooth along the edge and independent "
        "between frames; without it that of the kind.",
        least=0,
        most=_MOST_PX,
        unit="px",
    )
    jitter_length_px: float | None = parameter(
        None,
        "Length along the edge over which jitter stays correlated, to exp(-1/2); without it 8.",
        above=0,
        most=_MOST_PX,
        unit="px",
    )
    dropped: Annotated[float | None, Field(lt=1)] = parameter(
        None,
        "Share of frames with an empty mask and no signal, never the first or last; without it that of the "
        "kind.",
        least=0,
    )

    def habits(self, kind: MovieKind) -> Habits:
        """The habits of a kind, with those that are given here.

        Raises
        ------
        ParameterError
            A protrusion, or waves, for a kind that has none.
        """
        own = HABITS[kind]
        if self.protrusion_px is not None and own.protrusion_px is None:
            raise self.fault(
                f"kind {kind!r} has no protrusions, got protrusion_px={self.protrusion_px!r}: leave it out"
            )
        if self.waves is not None and own.waves is None:
            raise self.fault(f"kind {kind!r} has no waves, got waves={self.waves!r}: leave it out")
        names = HabitParameters.model_fields
        given = {name: value for name in names if (value := getattr(self, name)) is not None}
        return replace(own, **given)


class MovingCellParameters(HabitParameters):
    """How a movie of one cell is made."""

    frames: int = parameter(40, "Number of frames.", least=2)
    radius_px: float = parameter(
        45.0, "Radius of the disk of the same area as the cell at rest.", least=10, unit="px"
    )
    lag_frames: int = parameter(
        4,
        'Number of frames by which the "edge" channel follows the velocity of the edge; negative: leads it.',
        unit="frames",
    )
    coupled: float = parameter(
        1.0,
        'Share of the edge along which the "edge" channel follows the velocity of the edge: one stretch from '
        "a random place on. Elsewhere it follows, at the same boundary points, the velocity of another cell "
        "of the kind, drawn independently; within 30 of the 3000 boundary points the one goes over into the "
        "other. Whatever all movies of a kind share, like the steady advance of a front, both cells have: "
        '"fluctuating" shares nothing, "growing" everything.',
        least=0,
        most=1,
    )
    pixel_size_um: float = parameter(
        0.16, "Side of a pixel, stored with the signal.", above=0, unit="µm", flag="pixel-size"
    )
    frame_interval_s: float = parameter(
        5.0, "Time between frames, stored with the signal.", above=0, unit="s", flag="frame-interval"
    )
    margin: int = parameter(10, "Width of the background around all that is drawn.", least=0, unit="px")
    signals: bool = parameter(True, "Make the two channels, which takes most of the time.")

    @model_validator(mode="after")
    def _known_velocity(self) -> Self:
        if self.lag_frames < -self.frames:
            raise ValueError(f"lag_frames must be at least -{self.frames}, the frames, got {self.lag_frames}")
        return self
