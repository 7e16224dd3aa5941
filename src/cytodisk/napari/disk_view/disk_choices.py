"""What the disk can be coloured by."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal

from cytodisk.napari.given.layer_kinds import MARK, is_picture, layer_kind
from cytodisk.runs.channel_names import correlation_name, shown_name

Kind = Literal["mean", "area", "correlation", "lag", "image"]

_PEAKS = {"correlation": "peak correlation", "lag": "lag of the peak"}
_LONGEST_NAME = 24  # letters that a combo has room for


@dataclass(frozen=True)
class DiskChoice:
    """One way to colour the disk.

    Attributes
    ----------
    kind : {"mean", "area", "correlation", "lag", "image"}
    names : tuple of str
        Of the channel, of the correlation as in `Study.correlations`, or of the image layer.
    """

    kind: Kind
    names: tuple[str, ...] = ()

    @property
    def is_peak(self) -> bool:
        """Whether it is of the peak of a correlation."""
        return self.kind in _PEAKS

    @property
    def key(self) -> str:
        """At the colour bar, where a peak needs no name of what was correlated."""
        return _PEAKS.get(self.kind, self.label)

    @property
    def label(self) -> str:
        """In the list to choose from."""
        if self.kind == "mean":
            return f"mean {shown_name(self.names[0], _LONGEST_NAME)}"
        if self.kind in _PEAKS:
            return f"{_PEAKS[self.kind]}, {correlation_name(self.names)}"
        return "window area" if self.kind == "area" else f"pixels of {self.names[0]}"


def disk_choices(shown: Any) -> list[DiskChoice]:
    """What the disk of a study can be coloured by now.

    Parameters
    ----------
    shown : ShownStudy
        Images that are open and fit its masks can be mapped onto the disk.

    Returns
    -------
    list of DiskChoice
        Channels first, area where there is none.
    """
    means = [DiskChoice("mean", (name,)) for name in shown.channels]
    kinds: tuple[Kind, Kind] = ("correlation", "lag")
    peaks = [DiskChoice(kind, tuple(names)) for names in shown.study.correlations for kind in kinds]
    return [*means, DiskChoice("area"), *peaks, *_images(shown)]


def _images(shown: Any) -> Iterator[DiskChoice]:
    shape = image_shape_of(shown)
    if shown.viewer is None or shape is None:
        return
    for layer in shown.viewer.layers:
        is_image = layer_kind(layer) == "image" and not is_picture(layer) and MARK not in layer.metadata
        if is_image and fits(layer.data.shape, shape, shown):
            yield DiskChoice("image", (layer.name,))


def image_shape_of(shown: Any) -> tuple[int, int] | None:
    """(H, W) of the masks; None where no map tells it."""
    found: tuple[int, int] | None = shown.cells.image_shape
    return found


def fits(shape: tuple[int, ...], image_shape: tuple[int, int], shown: Any) -> bool:
    """Whether an image has the masks' pixels, and a frame for each of theirs."""
    frames = shape[:-2]
    return tuple(shape[-2:]) == image_shape and (
        frames == () or (len(frames) == 1 and shown.cells.is_stack and frames[0] >= shown.cells.n_frames)
    )
