"""Parameters of simulated waves."""

from typing import Annotated, Self

from pydantic import Field, model_validator

from cytodisk.parameters import parameter
from cytodisk.simulate.series_parameters import NeighbourParameters


class RunningParameters(NeighbourParameters):
    """How a wave runs, and the noise around it."""

    mode: int = parameter(
        1,
        'Waves around the cell. 0 is for "standing": the whole edge goes up and down together. "inward", '
        '"outward" and "none" have 0, whatever is given.',
        least=0,
        most=1000,
    )
    period_s: float = parameter(
        100.0, "Time in which a wave passes, at least two frames.", above=0, most=1e6, unit="s"
    )
    frame_interval_s: float = parameter(5.0, "Time between frames.", above=0, most=1e6, unit="s")
    direction: int = parameter(
        1,
        "1: towards higher sectors at first, -1: towards lower ones.",
        least=-1,
        most=1,
        words="1 or -1",
    )
    wavelength_um: float = parameter(
        10.0,
        'Distance between two crests on the way to the centre, for "spiral", "inward" and "outward".',
        above=0,
        most=1e6,
        unit="µm",
    )
    amplitude: float = parameter(
        1.0, "Height of the crests; of the largest one, where a wave stands.", above=0, most=1e6
    )
    noise: float = parameter(
        0.5,
        "Standard deviation of the noise, over that of the wave at a place on average.",
        least=0,
        most=1000,
    )
    noise_memory: Annotated[float, Field(lt=1)] = parameter(
        0.0, "Correlation of the noise with that of the frame before; 0: white.", least=0
    )
    persistence_s: float | None = parameter(
        None,
        "Time over which a wave forgets its phase, to exp(-1) in the mean of its turned phase; without it "
        "never.",
        above=0,
        most=1e9,
        unit="s",
    )
    reversals: int = parameter(0, "How often the wave turns round, at random times.", least=0, most=10_000)
    drift: float = parameter(
        0.0,
        "How fast the cell turns on the slide and takes the wave along, positive towards higher sectors.",
        least=-1e3,
        most=1e3,
        unit="turns/s",
    )

    @model_validator(mode="after")
    def _a_wave_is_seen(self) -> Self:
        if self.direction == 0:
            raise ValueError('direction must be 1 or -1, got 0: a wave that stands is kind "standing"')
        if self.period_s < 2.0 * self.frame_interval_s:
            raise ValueError(
                f"period_s must be at least two frames of {self.frame_interval_s:g} s, got "
                f"{self.period_s:g}: take a shorter frame_interval_s"
            )
        return self


class WaveSeriesParameters(RunningParameters):
    """How a wave runs through windows, and the noise around it."""

    edge_length_um: float = parameter(
        100.0, "Length of the edge, which makes turns per second µm/s.", above=0, most=1e6, unit="µm"
    )
    layer_depth_um: float = parameter(
        1.0, "Depth of each layer of windows; the first begins at the edge.", above=0, most=1e6, unit="µm"
    )
