"""Parameters that all runs over cells share."""

from typing import ClassVar, Literal

from pydantic import field_validator

from cytodisk.disk.mapping_parameters import MeshParameters
from cytodisk.disk.nucleus.nucleus_parameters import SeveralParameters
from cytodisk.errors import CytodiskError, ParameterError
from cytodisk.geometry.mask_parameters import HoleParameters
from cytodisk.images.file_parameters import KindParameters, SignalFileParameters
from cytodisk.images.nuclei.nuclei_parameters import NucleiFileParameters
from cytodisk.parameters import Parameters, parameter
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.scale_parameters import PixelSizeParameters
from cytodisk.windows.grid_parameters import GridParameters, SampleParameters


class ChannelParameters(Parameters):
    """What the channels of a signal are called."""

    channels: tuple[str, ...] | None = parameter(
        None,
        "Names for the channels of the signal, such as Rac1,RhoA. Without it, those in the file, "
        "or the file's name.",
        words="names, such as Rac1,RhoA",
    )

    @field_validator("channels")
    @classmethod
    def _names(cls, channels: tuple[str, ...] | None) -> tuple[str, ...] | None:
        if channels is None:
            return None
        if not channels or any(not name.strip() or not name.isprintable() for name in channels):
            raise ValueError("every channel needs a name that can be printed")
        if len(set(channels)) < len(channels):
            raise ValueError("two channels have one name")
        taken = [name for name in channels if name in VELOCITIES]
        if taken:
            raise ValueError(f"{taken[0]} is the name of the edge's velocity")
        return channels


class FileParameters(PixelSizeParameters, ChannelParameters, SignalFileParameters, KindParameters):
    """How the files of a run are read."""


class PlainCellParameters(Parameters):
    """What is done with cells without a nucleus."""

    missing: Literal["refuse", "plain"] = parameter(
        "refuse",
        'Cells without a nucleus, where nuclei are given: "refuse" them, or map them without, as "plain" '
        "cells, whose layers do not go with those of the others.",
    )


class CheckParameters(
    SeveralParameters, PlainCellParameters, HoleParameters, NucleiFileParameters, FileParameters
):
    """What `cytodisk check` takes, beside the input files."""


class CellParameters(MeshParameters, SampleParameters, GridParameters, FileParameters):
    """What all runs over cells have, whatever the method of the map."""

    fault: ClassVar[type[CytodiskError]] = ParameterError
