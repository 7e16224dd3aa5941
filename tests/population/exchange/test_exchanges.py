"""Exchanges of labels: all of them where there are few, and the smallest p-value that they can give."""

from itertools import combinations
from math import comb

import numpy as np
import pytest

from cytodisk.arrays import BoolArray
from cytodisk.population.exchange.dose_exchanges import DoseExchanges
from cytodisk.population.exchange.exchanges import LabelExchanges, SignExchanges
from cytodisk.population.exchange.turns import TurnExchanges


def treated(control: int, other: int) -> BoolArray:
    return np.repeat([False, True], [control, other])


@pytest.mark.parametrize(
    ("exchanges", "smallest"),
    [
        (SignExchanges(3, 9999, 0), 0.25),
        (LabelExchanges(treated(3, 3), 9999, 0), 0.1),
        (LabelExchanges(treated(4, 4), 9999, 0), 2 / 70),
        (SignExchanges(6, 9999, 0), 1 / 32),
        (LabelExchanges(treated(5, 5), 9999, 0), 2 / 252),
        (LabelExchanges(treated(3, 5), 9999, 0), 1 / 56),
        (LabelExchanges(treated(1, 1), 9999, 0), 1.0),
        (LabelExchanges(treated(40, 40), 999, 0), 1 / 1000),
        (DoseExchanges(np.array([0.0, 1, 2]), np.zeros(3, int), 9999, 0), 2 / 6),
        (DoseExchanges(np.array([0.0, 0, 1, 5]), np.zeros(4, int), 9999, 0), 1 / 12),
        (DoseExchanges(np.array([0.0, 1, 0, 1, 0, 1]), np.array([0, 0, 1, 1, 2, 2]), 9999, 0), 0.25),
        (TurnExchanges(5, 8, 99, 0), 0.01),
    ],
)
def test_the_smallest_p_is_what_the_number_of_experiments_allows(exchanges, smallest: float) -> None:
    assert exchanges.smallest_p == pytest.approx(smallest)


def test_all_labels_come_once_and_the_observed_first() -> None:
    observed = np.array([True, False, False, True, False])
    rows = np.concatenate(list(LabelExchanges(observed, 99, 0).chunks(3)))
    assert len(rows) == comb(5, 2)
    assert (rows[0] == observed).all()
    assert {tuple(np.flatnonzero(row)) for row in rows} == set(combinations(range(5), 2))


def test_all_signs_come_once_and_the_observed_first() -> None:
    rows = np.concatenate(list(SignExchanges(4, 99, 0).chunks(5)))
    assert (rows[0] == 1).all()
    assert len(np.unique(rows, axis=0)) == len(rows) == 16


@pytest.mark.parametrize("size", [7, 64, 1000])
def test_random_labels_do_not_hang_on_the_size_of_chunks(size: int) -> None:
    exchanges = LabelExchanges(treated(20, 12), 200, 3)
    assert exchanges.count == 201
    rows = np.concatenate(list(exchanges.chunks(size)))
    assert (rows == np.concatenate(list(exchanges.chunks(13)))).all()
    assert (rows.sum(axis=1) == 12).all()
    assert len(np.unique(rows, axis=0)) == 201


def test_random_doses_stay_within_their_experiments() -> None:
    blocks = np.repeat(np.arange(6), 4)
    doses = np.tile([0.0, 1, 10, 100], 6)
    exchanges = DoseExchanges(doses, blocks, 300, 0)
    assert not exchanges.all_ways
    for row in np.concatenate(list(exchanges.chunks(50))):
        assert (np.sort(row.reshape(6, 4), axis=1) == [0, 1, 10, 100]).all()


def test_ways_of_very_many_units_are_not_counted_out() -> None:
    treated = np.arange(1_000_000) % 2 == 0  # the number of ways has 300 000 digits
    found = LabelExchanges(treated, 99, 0)
    assert (found.all_ways, found.count, found.smallest_p) == (False, 100, 0.01)
    few = LabelExchanges(np.arange(1_000) == 3, 10**6, 0)
    assert (few.all_ways, few.count) == (True, 1_000)
