"""Parameters of `cytodisk waves`."""

from cytodisk.analysis.waves.waves_parameters import WaveSearchParameters
from cytodisk.parameters import parameter
from cytodisk.runs.used_series.used_parameters import UsedFramesParameters


class WavesParameters(UsedFramesParameters, WaveSearchParameters):
    """What decides the result of `cytodisk waves`, beside the study and the signal."""

    layer: int = parameter(
        0,
        "Layer of a signal that the finding, the figures and the table of cells tell of, 0 at the edge. All "
        "layers are in the other tables.",
        least=0,
        most=10_000,
    )
    geometry: bool = parameter(
        True,
        "Also look for the waves in what the motion of the cell alone does not give: velocity in the cell's "
        "own frame, or a signal without the movie's mean in the lab and by depth, for which the maps and the "
        "images are read again.",
    )
