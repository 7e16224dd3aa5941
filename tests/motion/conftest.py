from collections.abc import Callable
from functools import cache

import pytest

from cytodisk import DiskMovie, map_movie, simulate
from cytodisk.simulate import SimulatedMovie


@pytest.fixture(scope="session")
def mapped() -> Callable[..., tuple[SimulatedMovie, DiskMovie]]:
    """A simulated movie and its maps, made once for all tests."""

    @cache
    def make(kind: str, frames: int, seed: int = 0) -> tuple[SimulatedMovie, DiskMovie]:
        shown = simulate.movie(kind, seed, frames=frames, signals=False)
        return shown, map_movie(shown.masks)

    return make
