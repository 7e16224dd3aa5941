"""Parameters of movies whose edge and channels follow series."""

from cytodisk.parameters import Parameters, parameter
from cytodisk.simulate.predicting.predicting_parameters import WhoPredictsParameters
from cytodisk.simulate.waves.wave_parameters import RunningParameters


class DrivenCellParameters(Parameters):
    """The cell, how far its edge moves, and how it is filmed."""

    frames: int = parameter(150, "Number of frames.", least=2, most=100_000)
    radius_px: float = parameter(
        45.0, "Radius of the disk of the same area as the cell at rest.", least=10, most=1000, unit="px"
    )
    sectors: int = parameter(24, "Number of places around the cell that have a series.", least=4, most=1000)
    edge_speed_px: float = parameter(
        1.0, "Speed of the edge where its series is 1.", least=0, most=100, unit="px/frame"
    )
    relaxation: float = parameter(
        10.0,
        "Frames in which an edge that nothing pushes goes back to exp(-1) of its distance from rest. It "
        "keeps the cell in shape, and takes nothing from what predicts the edge.",
        least=1,
        most=1e6,
        unit="frames",
    )
    contrast: float = parameter(
        0.2, "Change of a channel's brightness where its series is 1, over its mean.", least=0, most=1
    )
    depth_px: float = parameter(
        8.0, "How deep what happens at the edge reaches into the channels.", above=0, most=1000, unit="px"
    )
    turn_deg: float = parameter(
        0.0,
        "Turn of the whole cell on the slide, positive from +x towards +y.",
        least=-180,
        most=180,
        unit="degrees/frame",
    )
    jitter_px: float = parameter(
        0.0,
        "Standard deviation of the drawn outline about the true one, smooth along the edge over 8 px and "
        "independent between frames.",
        least=0,
        most=100,
        unit="px",
    )
    pixel_size_um: float = parameter(
        0.16, "Side of a pixel, stored with the signal.", above=0, most=1e6, unit="µm"
    )
    frame_interval_s: float = parameter(
        5.0, "Time between frames, stored with the signal.", above=0, most=1e6, unit="s"
    )


class PredictingMovieParameters(DrivenCellParameters, WhoPredictsParameters):
    """A cell whose channels predict its edge, or not."""


class WaveMovieParameters(DrivenCellParameters, RunningParameters):
    """A cell along whose edge, or through which, a wave runs."""
