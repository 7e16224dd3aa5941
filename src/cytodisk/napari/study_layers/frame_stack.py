"""`FrameStack`: an image of napari whose frames are made when they are looked at."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np


class FrameStack:
    """An array of shape (T, H, W) that makes its frames one by one.

    Parameters
    ----------
    frame : callable
        Makes frame t, shape (H, W).
    shape : tuple of int
    dtype : dtype
    """

    def __init__(self, frame: Callable[[int], Any], shape: tuple[int, int, int], dtype: Any):
        self._frame = frame
        self.shape = shape
        self.dtype = np.dtype(dtype)

    @property
    def ndim(self) -> int:
        """Number of axes."""
        return len(self.shape)

    @property
    def size(self) -> int:
        """Number of values."""
        return int(np.prod(self.shape))

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, key: Any) -> Any:
        places = key if isinstance(key, tuple) else (key,)
        first, *rest = places if places else (slice(None),)
        if first is Ellipsis:
            first, rest = slice(None), [Ellipsis, *rest]
        if isinstance(first, int | np.integer):
            return self._frame(int(range(len(self))[first]))[tuple(rest)]
        chosen = np.arange(len(self))[first]
        if not len(chosen):
            return np.empty((0, *self.shape[1:]), self.dtype)[(slice(None), *rest)]
        return np.stack([self._frame(int(t)) for t in chosen])[(slice(None), *rest)]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Any:
        return np.asarray(self[:], dtype=dtype)

    def __deepcopy__(self, memo: Any) -> FrameStack:
        return self  # it is never written to
