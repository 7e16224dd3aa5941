"""Whether an image can be sampled with masks."""

from cytodisk.errors import SignalError
from cytodisk.images.frame_file import FrameFile

_MOST_UNNAMED = 10  # more planes than that are hardly channels


def check_signal(masks: FrameFile, signal: FrameFile) -> None:
    """Raise SignalError unless an image can be sampled with masks."""
    if signal.image_shape != masks.image_shape:
        if signal.doubt:
            raise SignalError(f"signal {signal.doubt}")
        raise SignalError(
            f"signal {signal.path} has images of {signal.image_shape}, the masks of {masks.image_shape}: "
            "they must have the same height and width"
        )
    if signal.dtype.kind not in "biuf":
        raise SignalError(
            f"signal {signal.path} holds values of type {signal.dtype}, which cannot be measured: "
            "save it as uint16 or float32"
        )
    if len(signal.channels) > _MOST_UNNAMED and signal.unnamed:
        raise SignalError(
            f"signal {signal.path} has {len(signal.channels)} planes without names, where one image is due: "
            "pass one frame, or name its axes in the file, and its channels there or with --channels"
        )
    if signal.n_frames not in (1, masks.n_frames):
        raise SignalError(
            f"signal {signal.path} has {signal.n_frames} frames, the masks {masks.n_frames}: "
            "pass as many, or a single image"
        )
