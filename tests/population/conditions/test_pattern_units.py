"""A pattern must lie at the same place in several experiments, not in many cells of one."""

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.errors import PopulationError


def aligned(experiments: int, share: float, polarity: float, seed: int = 0) -> cd.Population:
    truth = cd.simulate.population(
        seed,
        conditions=("wild type",),
        experiments=experiments,
        cells=12,
        between_experiments=share,
        polarity=polarity,
        turned="nucleus",
    )
    return cd.Population(truth.values, truth.cells).align("nucleus", weakest=0.0)


def test_dishes_with_patterns_of_their_own_make_no_common_one() -> None:
    found = [
        float(cd.pattern_test(aligned(6, 0.5, 0.0, seed), permutations=99).windows["p_fwer"].min())
        for seed in range(12)
    ]
    assert np.sum(np.array(found) <= 0.05) <= 3  # a cell by itself: nearly always


def test_what_few_experiments_can_show_of_a_pattern_is_said() -> None:
    found = cd.pattern_test(aligned(2, 0.1, 2.0), permutations=999)
    assert found.smallest_p == pytest.approx(1 / 12)
    assert "can give p = 0.083 at best" in found.sentences[0]
    assert float(found.windows["p_fwer"].min()) >= 1 / 12 - 0.03  # within the error of drawn turns
    assert cd.pattern_test(aligned(3, 0.1, 2.0), permutations=199).windows["p_fwer"].min() <= 0.05
    with pytest.raises(PopulationError, match="1 of the experiments"):
        cd.pattern_test(aligned(1, 0.1, 2.0))


def test_cells_of_unknown_experiments_are_taken_for_independent_and_that_is_said() -> None:
    pop = aligned(3, 0.0, 2.0)
    found = cd.pattern_test(pop.with_cells(pop.cells.drop(columns="experiment")), permutations=99)
    assert found.experiments == ()
    assert found.sentences[0].startswith("36 cells were turned")
    assert "treated as independent" in found.sentences[0]
