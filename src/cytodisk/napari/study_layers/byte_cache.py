"""`ByteCache`: what was read or computed last, bounded in bytes."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import RLock
from typing import Generic, TypeVar

Content = TypeVar("Content")
_NEARLY = 0.9


class ByteCache(Generic[Content]):
    """Keeps what was used last; several threads may ask.

    Parameters
    ----------
    most_bytes : int
        Of all that is kept together. What is larger than that alone is given but not kept.
    size_of : callable
        Bytes of one content.
    """

    def __init__(self, most_bytes: int, size_of: Callable[[Content], int]):
        self.most_bytes = most_bytes
        self.n_bytes = 0
        self._size_of = size_of
        self._kept: OrderedDict[Hashable, tuple[Content, int]] = OrderedDict()
        self._lock = RLock()

    def __contains__(self, key: Hashable) -> bool:
        return key in self._kept

    def __len__(self) -> int:
        return len(self._kept)

    @property
    def is_full(self) -> bool:
        """Whether little room is left before something has to go."""
        return self.n_bytes > _NEARLY * self.most_bytes

    def get(self, key: Hashable, make: Callable[[], Content]) -> Content:
        """What is kept under a key, or else what is made now, and then kept.

        Parameters
        ----------
        key : hashable
        make : callable
            Two threads that ask at once may both call it.
        """
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
                return self._kept[key][0]
        made = make()
        with self._lock:
            if key not in self._kept:
                size = self._size_of(made)
                self._kept[key] = made, size
                self.n_bytes += size
                while self.n_bytes > self.most_bytes:
                    self.n_bytes -= self._kept.popitem(last=False)[1][1]
        return made
