import time

import numpy as np
import pandas as pd
import pytest

from cytodisk.errors import PopulationError
from cytodisk.runs.population.opening.population_tables import population_from_tables


def windows(cells: int = 4, layers: int = 2, sectors: int = 3, channels: int = 2) -> pd.DataFrame:
    """The value says where it stands: cell, channel, layer and sector as decimals."""
    places = np.indices((cells, channels, layers, sectors)).reshape(4, -1)
    names = pd.DataFrame(dict(zip(("cell", "channel", "layer", r"sector"), places, strict=True)))
    value = names @ [1000.0, 100.0, 10.0, 1.0]
    return names.assign(mean=value, channel=names["channel"].map("channel {}".format), area=1.0)


def table(cells: int = 4) -> pd.DataFrame:
    names = ["control", "drug"] * (cells // 2)
    return pd.DataFrame({"cell": range(cells), "condition": names, "experiment": "a", "size": 1.0})


def test_each_window_goes_to_its_place_in_any_order() -> None:
    shuffled = windows().sample(frac=1.0, random_state=1)
    population = population_from_tables(shuffled, table().iloc[::-1], scalars=["size"])
    assert population.cells["cell"].tolist() == [3, 2, 1, 0]
    found = population.values.sel(channel=["channel 0", "channel 1"]).values
    places = np.indices((4, 2, 2, 3))
    wanted = 1000.0 * (3 - places[0]) + 100.0 * places[1] + 10.0 * places[2] + places[3]
    np.testing.assert_array_equal(found, wanted)
    assert population.scalars == ("size",)
    assert (population.areas == 1.0).all()


def test_without_a_column_channel_it_is_the_value() -> None:
    one = windows(channels=1).drop(columns=["channel", "area"]).rename(columns={"mean": "Rac1"})
    population = population_from_tables(one, table(), value="Rac1")
    assert population.channels == ("Rac1",)
    assert population.areas is None


def test_a_window_without_a_row_has_no_value() -> None:
    population = population_from_tables(windows().iloc[1:], table())
    assert np.isnan(population.values).sum() == 1


@pytest.mark.parametrize(
    ("rows", "cells", "words"),
    [
        (
            windows().drop(columns="layer"),
            table(),
            r"windows has no column 'layer': it has cell, channel, sector",
        ),
        (windows(), table().drop(columns="cell"), r"cells has no column 'cell'"),
        (windows().iloc[:0], table(), r"windows has no rows"),
        (windows(), table().iloc[[0, 1, 1]], r"cell 1 stands twice"),
        (windows(), table().iloc[:3], r"windows has cell 3, which is not in cells"),
        (windows(), table().assign(cell=list("0123")), r"not in cells \(int64 there, "),
        (windows(2), table(), r"cells without windows: 2, 3: take them out"),
        (windows().assign(layer=0.5), table(), r"layer must be a whole number from 0, got 0.5 in 48 rows"),
        (windows().assign(sector=-1), table(), r"sector must be a whole number from 0, got -1"),
        (windows().assign(channel=None), table(), r"column channel is empty in 48 rows"),
        (windows().assign(mean="x"), table(), r"column 'mean' holds .*, no numbers"),
        (pd.concat([windows(), windows().iloc[[30]]]), table(), r"layer 0, sector 0 of cell 2 stands twice"),
        (
            windows().assign(layer=99_999, sector=range(0, 96_000, 2000)),
            table(),
            r"values are more than memory holds",
        ),
        (windows().assign(mean=np.inf), table(), r"infinite"),
        ([1], table(), r"windows must be a DataFrame, got list"),
    ],
)
def test_what_is_no_population_says_why(rows: pd.DataFrame, cells: pd.DataFrame, words: str) -> None:
    with pytest.raises(PopulationError, match=words):
        population_from_tables(rows, cells)


def test_a_million_rows_take_a_moment() -> None:
    rows = windows(cells=1000, layers=10, sectors=50)
    started = time.process_time()
    population = population_from_tables(rows, table(1000))
    assert time.process_time() - started < 5.0
    assert population.raw.shape == (1000, 2, 10, 50)
    assert len(rows) == 1_000_000
