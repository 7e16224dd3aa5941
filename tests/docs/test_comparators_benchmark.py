"""The benchmark that the comparators' defaults come from, on small cells whose answer is known."""

import sys
from pathlib import Path
from typing import Any

import pytest

import cytodisk as cd
from cytodisk.runs.compare_windows.laid_frames import lay_frames, registered_frames, spring_frames

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def comparators() -> Any:
    sys.path.insert(0, str(BENCHMARKS))
    try:
        import comparators
    finally:
        sys.path.remove(str(BENCHMARKS))
    return comparators


@pytest.mark.slow
def test_springs_lower_the_spread_on_a_disk(comparators: Any) -> None:
    mask = cd.simulate.disk(25)
    loose, even = (
        comparators.regularity([cd.spring_windows(mask, 8, 20, evenness=evenness)]) for evenness in (0.0, 4.0)
    )
    assert even[0] > loose[0]  # windows in the middle are as wide as a subpixel
    assert even[2] < 0.5 * loose[2]


@pytest.mark.slow
def test_points_of_a_cell_that_only_moves_stay_in_their_windows(comparators: Any) -> None:
    pytest.importorskip("SimpleITK")
    truth = cd.simulate.movie("translating", seed=1, frames=3, radius_px=20.0)
    movie = cd.map_movie(truth.masks, method="harmonic")
    grid = cd.polar_windows(3, 8)
    for frames in (
        lay_frames("newton", movie, grid),
        spring_frames(movie, cd.SpringGrid(3, 8, 6.0)),
        registered_frames(movie, grid, iterations=20),
    ):
        in_place, complete, coverage, folded, outside = comparators.kept(truth, frames)
        assert in_place > 0.85
        assert complete > 0.9
        assert coverage > 0.85
        assert not folded > 0.0
        assert not outside > 0.02
