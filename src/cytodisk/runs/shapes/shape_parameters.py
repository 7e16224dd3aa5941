"""Parameters of `cytodisk shapes`."""

from cytodisk.analysis.shape.score_parameters import ScoreParameters
from cytodisk.geometry.mask_parameters import HoleParameters
from cytodisk.images.file_parameters import KindParameters
from cytodisk.scale_parameters import PixelSizeParameters


class ShapeParameters(ScoreParameters, PixelSizeParameters, HoleParameters, KindParameters):
    """What decides the result of `cytodisk shapes`, beside the input files."""
