"""Parameters of rings between a nucleus and a cell's edge."""

from cytodisk.disk.sector_parameters import MOST
from cytodisk.geometry.mask_parameters import HoleParameters
from cytodisk.parameters import parameter
from cytodisk.windows.grid_parameters import RingGridParameters


class NucleusRingParameters(RingGridParameters):
    """How a cell is divided into rings and wedges around its nucleus."""

    layers: int = parameter(
        8, "Number of layers of the cytoplasm; layer 0 is at the edge of the cell.", least=1, most=MOST
    )
    sectors: int = parameter(8, "Number of wedges around the centroid of the nucleus.", least=1, most=MOST)
    nucleus_layers: int = parameter(
        3, "Number of layers of the nucleus, which follow those of the cytoplasm.", least=1, most=MOST
    )


class NucleusRingWindowParameters(HoleParameters, NucleusRingParameters):
    """What `nucleus_ring_windows` takes."""


class InterpolatedRingParameters(NucleusRingParameters):
    """How a cell is divided by rings that are interpolated between two outlines."""

    sectors: int = parameter(
        60, "Number of sectors of equal length on both outlines, from +x on.", least=1, most=MOST
    )
    points: int = parameter(
        256, "Number of points on each outline, rounded up to a multiple of the sectors.", least=3, most=MOST
    )
    harmonics: int | None = parameter(
        None,
        "Number of Fourier harmonics of both outlines that are kept; without it outlines stay as they are.",
        least=1,
        most=MOST,
    )


class InterpolatedRingWindowParameters(HoleParameters, InterpolatedRingParameters):
    """What `interpolated_ring_windows` takes."""
