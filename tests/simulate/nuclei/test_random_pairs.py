import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy import ndimage

from cytodisk.errors import ParameterError
from cytodisk.geometry.outline import has_one_outline
from cytodisk.simulate import PAIR_CELLS, PAIR_NUCLEI, random_pair, random_pair_kinds

EIGHT = np.ones((3, 3), dtype=bool)
COUNT = 360


@pytest.fixture(scope="module")
def shares_and_gaps() -> dict[tuple[str, str], list[tuple[float, int]]]:
    """Share of the nucleus and pixels of cytoplasm where it is narrowest, by kind; each pair is checked."""
    found: dict[tuple[str, str], list[tuple[float, int]]] = {}
    for seed in range(COUNT):
        mask, nucleus = random_pair(seed)
        assert has_one_outline(mask), seed
        assert has_one_outline(nucleus), seed
        depth = ndimage.distance_transform_cdt(np.pad(mask, 1), "chessboard")[1:-1, 1:-1]
        gap = int(depth[nucleus].min()) - 1
        found.setdefault(random_pair_kinds(seed), []).append((nucleus.sum() / mask.sum(), gap))
    return found


def test_all_neighbours_of_nuclear_pixels_are_cell_pixels(
    shares_and_gaps: dict[tuple[str, str], list[tuple[float, int]]],
) -> None:
    assert min(gap for rows in shares_and_gaps.values() for _, gap in rows) >= 1


def test_nuclei_have_all_sizes_and_gaps(
    shares_and_gaps: dict[tuple[str, str], list[tuple[float, int]]],
) -> None:
    shares, gaps = np.transpose([row for rows in shares_and_gaps.values() for row in rows])
    assert 0.01 <= shares.min() < 0.015
    assert 0.75 < shares.max() <= 0.8
    below = np.quantile(shares, [0.1, 0.5, 0.9])
    assert (below > [0.01, 0.05, 0.4]).all()
    assert (below < [0.03, 0.25, 0.7]).all()
    assert 0.3 < (gaps == 1).mean() < 0.7
    assert gaps.max() >= 8


def test_every_kind_of_cell_meets_every_kind_of_nucleus(
    shares_and_gaps: dict[tuple[str, str], list[tuple[float, int]]],
) -> None:
    assert set(shares_and_gaps) == {(cell, nucleus) for cell in PAIR_CELLS for nucleus in PAIR_NUCLEI}
    for kind, rows in shares_and_gaps.items():
        assert 1 in {gap for _, gap in rows}, kind
        assert len(rows) == COUNT / len(shares_and_gaps)
    large = {kind for kind, rows in shares_and_gaps.items() if max(share for share, _ in rows) > 0.5}
    assert {cell for cell, _ in large} == set(PAIR_CELLS)


def test_nuclei_in_arms_lie_where_the_cell_is_thin() -> None:
    relative_depth: dict[str, list[float]] = {"in an arm": [], "ball": []}
    for seed in range(COUNT):
        cell, kind = random_pair_kinds(seed)
        if cell == "smooth" or kind not in relative_depth:
            continue
        mask, nucleus = random_pair(seed)
        if nucleus.sum() < 0.1 * mask.sum():
            depth = ndimage.distance_transform_edt(mask)
            relative_depth[kind].append(depth[nucleus].max() / depth.max())
    assert min(map(len, relative_depth.values())) > 10
    assert np.median(relative_depth["in an arm"]) < 0.8 * np.median(relative_depth["ball"])


def test_the_same_seed_gives_the_same_pair() -> None:
    for one, again, other in zip(random_pair(5), random_pair(5), random_pair(6), strict=True):
        assert_array_equal(one, again)
        assert one.shape != other.shape or (one != other).any()


@pytest.mark.parametrize("seed", [-1, 0.5, "one"])
def test_seeds_are_whole_numbers(seed: object) -> None:
    with pytest.raises(ParameterError, match="seed must be a whole number"):
        random_pair(seed)  # type: ignore[arg-type]
