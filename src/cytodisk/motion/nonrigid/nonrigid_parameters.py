"""Parameters of the registration of every frame to one reference."""

from cytodisk.motion.demons_parameters import DemonsFieldParameters
from cytodisk.parameters import parameter


class NonrigidParameters(DemonsFieldParameters):
    """How each frame of a movie is registered to the first one."""

    warm_start: bool = parameter(True, "Start each frame's field from that of the frame before.")
