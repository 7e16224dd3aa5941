"""CSV tables: numbers in full, text that no spreadsheet runs, and files of others left alone."""

import csv
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from cytodisk.store.csv_tables import (
    parquet_to_csv,
    text_as_meant,
    text_made_harmless,
    write_csv,
)

FORMULAS = ("=1+1", "+cmd", "-2+3", "@SUM(A1)", "\tx", "\rx", "\n=x", " =x", "'=x", "＝x")


def written(frame: pd.DataFrame, folder: Path) -> list[list[str]]:
    pq.write_table(pa.Table.from_pandas(frame, preserve_index=False), folder / "a.parquet")
    parquet_to_csv(folder / "a.parquet", folder / "a.csv")
    with (folder / "a.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.reader(file))


@pytest.mark.parametrize("text", FORMULAS)
def test_a_formula_becomes_text_and_comes_back(text: str) -> None:
    harmless = text_made_harmless(text)
    assert harmless == f"'{text}"
    assert text_as_meant(harmless) == text


@pytest.mark.parametrize("text", ["-5", "+1.5e-3", ".5", "a=b", "'quoted'", "", "1-2", "cell -1"])
def test_numbers_and_plain_text_stay(text: str) -> None:
    assert text_made_harmless(text) == text
    assert text_as_meant(text) == text


@given(st.text(alphabet="'=+-@\t\r\n 15.ea,\"＝", max_size=6))
def test_any_text_comes_back(text: str) -> None:
    harmless = text_made_harmless(text)
    assert text_as_meant(harmless) == text
    assert harmless[:1] not in ("=", "@", "\t", "\r", "\n")


@given(texts=st.lists(st.text(max_size=8).filter(lambda text: "\0" not in text), min_size=1, max_size=5))
def test_texts_in_blocks_are_as_those_one_by_one(
    texts: list[str], tmp_path_factory: pytest.TempPathFactory
) -> None:
    texts = [text.encode(errors="ignore").decode() for text in [*texts, *FORMULAS, 'a,"b"', "-5"]]
    found = written(pd.DataFrame({"=name": texts, "n": 1}), tmp_path_factory.mktemp("csv"))
    assert found[0] == ["'=name", "n"]
    assert [row[0] for row in found[1:]] == [text_made_harmless(text) for text in texts]


@given(st.lists(st.floats(allow_nan=False), min_size=1))
def test_numbers_come_back_to_the_bit(tmp_path_factory: pytest.TempPathFactory, numbers: list[float]) -> None:
    (_, *rows) = written(pd.DataFrame({"x": [*numbers, 0.1]}), tmp_path_factory.mktemp("csv"))
    assert_array_equal(
        np.array([float(row[0]) for row in rows]).view(np.int64), np.array([*numbers, 0.1]).view(np.int64)
    )


def test_missing_values_are_empty_and_kinds_of_columns_stay(tmp_path: Path) -> None:
    frame = pd.DataFrame(
        {"whole": [1, 2], "number": [2.0, np.nan], "yes": [True, False], "text": ["a", None], "none": np.nan}
    )
    assert written(frame, tmp_path)[1:] == [["1", "2.0", "true", "a", ""], ["2", "", "false", "", ""]]
    back = pd.read_csv(tmp_path / "a.csv")
    assert [kind.kind for kind in back.dtypes[:3]] == ["i", "f", "b"]


def test_many_blocks_make_one_table(tmp_path: Path) -> None:
    count = 45_000
    frame = pd.DataFrame({"i": np.arange(count), "x": np.sqrt(np.arange(count))})
    pq.write_table(pa.Table.from_pandas(frame, preserve_index=False), tmp_path / "a.parquet")
    parquet_to_csv(tmp_path / "a.parquet", tmp_path / "a.csv")
    assert_array_equal(pd.read_csv(tmp_path / "a.csv")["i"], np.arange(count))


def test_an_empty_table_has_its_names(tmp_path: Path) -> None:
    write_csv(pd.DataFrame({"a": [], "b": []}), tmp_path / "a.csv")
    assert (tmp_path / "a.csv").read_text() == "a,b\n"
