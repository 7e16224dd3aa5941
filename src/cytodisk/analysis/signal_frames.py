"""Signals of a movie: frames with their channels, each checked when it is asked for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.arrays import AnyArray
from cytodisk.errors import SignalError
from cytodisk.windows.sample import check_channel_names


@dataclass(frozen=True, eq=False)
class MovieSignals:
    """Frames of a signal that fit a movie.

    Attributes
    ----------
    frames : sequence of array_like of shape (H, W) or (C, H, W)
    channels : list of str
        Names, "0" for the one channel of frames (H, W).
    frame_shape : tuple of int
        (H, W) or (C, H, W), as the first frame has it.
    """

    frames: Any
    channels: list[str]
    frame_shape: tuple[int, ...]

    def __len__(self) -> int:
        return len(self.frames)

    @property
    def image_shape(self) -> tuple[int, int]:
        """(H, W) of a frame."""
        return self.frame_shape[-2], self.frame_shape[-1]

    @property
    def channel_names(self) -> list[str] | None:
        """Names of the channels; None if the frames have no such axis."""
        return self.channels if len(self.frame_shape) == 3 else None

    def image(self, frame: int) -> AnyArray:
        """Read a frame.

        Parameters
        ----------
        frame : int

        Returns
        -------
        ndarray of shape (C, H, W)

        Raises
        ------
        SignalError
            It has not the shape of the first.
        """
        values = np.asarray(self.frames[frame])
        wanted = (len(self.channels), *self.image_shape)
        if values.shape != wanted and (1, *values.shape) != wanted:
            raise SignalError(
                f"frame {frame} of the signals has shape {values.shape}, those before {self.frame_shape}: "
                "save all frames alike"
            )
        return values.reshape(wanted)


def parse_signals(signals: Any, n_frames: int, image_shape: tuple[int, int]) -> MovieSignals:
    """The signals of a movie, checked against it.

    Parameters
    ----------
    signals : array_like, DataArray or sequence
        See `sample_movie`.
    n_frames : int
    image_shape : (int, int)

    Returns
    -------
    MovieSignals

    Raises
    ------
    SignalError
        They do not fit, are not numbers, or two channels have one name.
    """
    names: list[str] | None = None
    if isinstance(signals, xr.DataArray):
        if not {"time", "y", "x"} <= set(signals.dims) or not set(signals.dims) <= {
            "time",
            "channel",
            "y",
            "x",
        }:
            raise SignalError(
                f"signals have the dims {list(signals.dims)}: a movie has time, (channel,) y, x"
            )
        signals = signals.transpose("time", "channel", "y", "x", missing_dims="ignore")
        if "channel" in signals.coords:
            names = [str(name) for name in np.atleast_1d(signals["channel"].to_numpy())]
        signals = signals.to_numpy()
    if not hasattr(signals, "__getitem__") or not hasattr(signals, "__len__"):
        raise SignalError(f"signals must be an array or a sequence of frames, got {type(signals).__name__}")
    if len(signals) != n_frames:
        raise SignalError(
            f"signals have {len(signals)} frames, the movie {n_frames}"
            + _axis_hint(getattr(signals, "shape", ()), n_frames)
            + ": pass as many, time first"
        )
    first = np.asarray(signals[0])
    if first.dtype.kind not in "biuf":
        raise SignalError(f"signals must be numbers, got dtype {first.dtype}")
    if first.ndim not in (2, 3) or first.shape[-2:] != tuple(image_shape):
        raise SignalError(
            f"a frame of the signals has shape {first.shape}, the masks {tuple(image_shape)}: "
            "pass (time, y, x) or (time, channel, y, x) of the same size"
        )
    count = first.shape[0] if first.ndim == 3 else 1
    if names is None or len(names) != count:
        names = [str(number) for number in range(count)]
    check_channel_names("signals", names)
    return MovieSignals(signals, names, tuple(first.shape))


def _axis_hint(shape: tuple[int, ...], n_frames: int) -> str:
    axes = [axis for axis, size in enumerate(shape) if size == n_frames]
    return f" (but {n_frames} is the length of axis {axes[0]} of {tuple(shape)})" if axes else ""
