"""Predictions on disk: folders by names, listed, opened, replaced whole."""

from pathlib import Path

import pandas as pd
import pyarrow as pa
import pytest

from cytodisk.errors import ReadError
from cytodisk.runs.predict.prediction_columns import PREDICTION_TABLES
from cytodisk.store.predictions.prediction_store import (
    Prediction,
    list_predictions,
    prediction_path,
    read_prediction,
    write_prediction,
)
from cytodisk.store.provenance_file import read_provenance, write_json
from cytodisk.store.tables import CELL, Column
from cytodisk.store.written_files import recorded

PAIR = ("Rac1", "velocity", "")


def write(
    folder: Path, names: tuple[str, str, str], gain: float = 0.1, csv: bool = False, without: str = ""
) -> None:
    needed = dict.fromkeys(Prediction.needed["links"], "")
    table = pd.DataFrame([{"cell": 0} | needed | {"gain": gain}]).drop(columns=without or [])
    table.attrs["units"] = dict.fromkeys(table, "") | {"gain": "nat"}
    columns = {"links": (CELL, Column("gain", pa.float64(), "nat", "how much"))}
    write_prediction(folder, names, {"links": table}, columns, {"signals": ["Rac1", "velocity"]}, csv)


def test_pairs_networks_and_variants_are_listed_and_opened(tmp_path: Path) -> None:
    for names in (PAIR, ("", "", ""), ("", "", "velocity"), ("network", "velocity", ""), ("a/b", "~", "x")):
        write(tmp_path, names)
    folders = sorted(path.name for path in (tmp_path / "prediction").iterdir())
    assert len(folders) == 5
    assert {"network", "network~velocity", "Rac1~velocity"} <= set(folders)
    listed = list_predictions(tmp_path)
    assert set(listed) == {
        PAIR[:2],
        (),
        ("", "", "velocity"),
        ("network", "velocity"),
        ("a/b", "~", "x"),
    }
    for names in listed:
        found = read_prediction(tmp_path, *names)
        assert (found.source, found.target, found.name)[: len(names)] == names
        assert found.is_network == (not found.source)
        assert found.links["gain"].tolist() == [0.1]
        assert found.links.attrs["units"]["gain"] == "nat"
    assert prediction_path(tmp_path, "network", "velocity") != prediction_path(tmp_path, name="velocity")


def test_a_table_of_an_earlier_version_says_to_predict_again(tmp_path: Path) -> None:
    assert {*Prediction.needed} <= {*PREDICTION_TABLES}
    for name, columns in Prediction.needed.items():
        assert {*columns} <= {column.name for column in PREDICTION_TABLES[name]}
    write(tmp_path, PAIR, without="weaker")
    with pytest.raises(ReadError, match=r"column weaker is missing, .*: run cytodisk predict again"):
        _ = read_prediction(tmp_path, *PAIR).links


def test_a_prediction_is_replaced_with_its_csv(tmp_path: Path) -> None:
    write_json(tmp_path / "provenance.json", {"fingerprint": {}, "files": {}})
    write(tmp_path, PAIR, csv=True)
    folder = tmp_path / "prediction" / "Rac1~velocity"
    assert {path.name for path in folder.iterdir()} == {
        "links.parquet",
        "links.csv",
        "columns.csv",
        "settings.json",
    }
    assert "links.parquet,gain,nat,how much" in (folder / "columns.csv").read_text(encoding="utf-8-sig")
    assert set(recorded(read_provenance(tmp_path) or {})) == {
        path.relative_to(tmp_path).as_posix() for path in folder.iterdir()
    }
    write(tmp_path, PAIR, gain=0.3)
    assert read_prediction(tmp_path, *PAIR).links["gain"].tolist() == [0.3]
    assert [path.name for path in folder.parent.iterdir()] == [folder.name]


def test_what_is_not_there_or_damaged_says_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="no prediction Rac1 and velocity: run cytodisk predict first"):
        read_prediction(tmp_path, *PAIR)
    write(tmp_path, ("", "", ""))
    with pytest.raises(ReadError, match="no prediction Rac1 and velocity: it has network"):
        read_prediction(tmp_path, *PAIR)
    file = tmp_path / "prediction" / "network" / "settings.json"
    file.write_text(file.read_text().replace('"signals"', '"signal"'))
    with pytest.raises(ReadError, match=r"settings\.json.*signals.*run cytodisk predict again"):
        read_prediction(tmp_path)
