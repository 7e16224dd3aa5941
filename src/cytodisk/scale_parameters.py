"""Parameters that say how large a pixel is, and how long a frame."""

from cytodisk.checks import LARGEST_SCALE, SMALLEST_SCALE
from cytodisk.parameters import Parameters, parameter


class PixelSizeParameters(Parameters):
    """How large a pixel is."""

    pixel_size_um: float | None = parameter(
        None,
        "Side of a pixel; without it the one in the file or array is used.",
        least=SMALLEST_SCALE,
        most=LARGEST_SCALE,
        unit="µm",
        flag="pixel-size",
    )


class ScaleParameters(PixelSizeParameters):
    """How large a pixel is, and how long a frame."""

    frame_interval_s: float | None = parameter(
        None,
        "Time between frames; without it the one in the file or array is used.",
        least=SMALLEST_SCALE,
        most=LARGEST_SCALE,
        unit="s",
        flag="frame-interval",
    )
