"""One scale out of those of several layers and their files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from cytodisk.errors import ReadError
from cytodisk.images.frame_file import FrameFile
from cytodisk.napari.given.layer_axes import UNNAMED
from cytodisk.napari.given.layer_scale import LayerScale, layer_scale
from cytodisk.scale import UNKNOWN, Scale, alike

_QUANTITIES = (("pixel_size_um", "pixel", "µm"), ("frame_interval_s", "frame", "s"))


class ScaleOfLayers:
    """What layers say of the scale, or where they do not, their files; and what the files of a run say.

    Parameters
    ----------
    layers : sequence of (layer, letters, FrameFile or None)
        Layers of pixels, the letters of their axes, and the files that they were opened from.

    Raises
    ------
    ReadError
        Layers have no square pixels, or they differ.
    """

    def __init__(self, layers: Sequence[tuple[Any, str, FrameFile | None]]):
        self._said: list[tuple[Any, LayerScale]] = [
            (layer, layer_scale(layer, letters)) for layer, letters, _ in layers
        ]
        self._files = [file for *_, file in layers if file is not None]
        self._of_run: list[Scale] = []  # as the run's files say
        self._from_file: list[str] = []
        found = {name: self._agreed(name, what, unit) for name, what, unit in _QUANTITIES}
        self.known = Scale(**found)

    def _agreed(self, name: str, what: str, unit: str) -> float | None:
        told = [(layer.name, value) for layer, said in self._said if (value := getattr(said.scale, name))]
        for layer, value in told[1:]:
            if not alike(told[0][1], value):
                raise ReadError(
                    f"layer {told[0][0]} says {told[0][1]:g} {unit} a {what}, layer {layer} {value:g} "
                    f"{unit}: correct the scale of one of them"
                )
        if told:
            return float(told[0][1])
        for file in self._files:
            value = getattr(file.scale, name)
            if value is not None:
                self._from_file.append(f"{value:g} {unit} a {what}, as the file {file.path.name} says")
                return float(value)
        return None

    def add_file(self, file: FrameFile) -> None:
        """A file of the user's is one of the run."""
        self._of_run.append(file.scale)

    def add_written(self, axes: str) -> None:
        """A file was written, with the scale if its axes have names."""
        self._of_run.append(UNKNOWN if UNNAMED in axes else self.known)

    def add_unsaid(self) -> None:
        """A file was written that says no scale."""
        self._of_run.append(UNKNOWN)

    def values(self, *, is_movie: bool) -> dict[str, float]:
        """Parameters without which the files would say another scale than is known."""
        found = {}
        for name, *_ in _QUANTITIES[: 2 if is_movie else 1]:
            wanted = getattr(self.known, name)
            told = [value for scale in self._of_run if (value := getattr(scale, name)) is not None]
            if wanted is not None and not (told and alike(wanted, *told)):
                found[name] = wanted
        return found

    def notes(self, typed: Mapping[str, Any], *, is_movie: bool) -> list[str]:
        """What a user should know of the scale, beside what he typed."""
        scale = self.known.given(**{name: typed.get(name) for name, *_ in _QUANTITIES})
        told = [f"scale: {words}" for words in self._from_file]
        for layer, said in self._said:
            told += said.notes(layer.name, self.known, is_movie=is_movie)
        for file in self._files:
            for name, what, unit in _QUANTITIES[: 2 if is_movie else 1]:
                own, used = getattr(file.scale, name), getattr(self.known, name)
                if own is not None and used is not None and not alike(own, used):
                    told.append(
                        f"the layer says {used:g} {unit} a {what}, which is used; its file {file.path.name} "
                        f"says {own:g} {unit}"
                    )
        words = scale.words()[: 2 if is_movie else 1]
        values = (scale.pixel_size_um, scale.frame_interval_s)
        return told + [line for line, value in zip(words, values, strict=False) if value is None]
