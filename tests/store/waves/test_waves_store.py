"""Waves on disk: a folder a signal, read as it was written, with a layer that may be empty."""

from pathlib import Path

import pandas as pd
import pyarrow as pa
import pytest

from cytodisk.errors import ReadError
from cytodisk.store.tables import CELL, LAYER, Column
from cytodisk.store.waves.waves_store import list_waves, read_waves, write_waves

COLUMNS = {"layers": (CELL, LAYER, Column("p", pa.float64(), "1", "p")), "cells": (CELL,)}


def tables(layer: int | None) -> dict[str, pd.DataFrame]:
    layers = pd.DataFrame({"cell": [0], "layer": pd.array([layer], dtype="Int64"), "p": [0.01]})
    layers.attrs["units"] = {"p": "1"}
    return {"layers": layers, "cells": pd.DataFrame({"cell": [0]})}


def test_waves_are_read_as_they_were_written(tmp_path: Path) -> None:
    written = write_waves(tmp_path, "velocity", tables(None), COLUMNS, {"surrogates": 19}, csv=True)
    assert written.path == tmp_path / "waves" / "velocity"
    assert written.layers["layer"].isna().all()
    assert written.layers.attrs["units"]["p"] == "1"
    assert written.depths is None
    assert {path.name for path in written.path.iterdir()} >= {"layers.csv", "cells.csv", "columns.csv"}
    write_waves(tmp_path, "a/b", tables(2), COLUMNS, {}, "early")
    assert list_waves(tmp_path) == [("a/b", "early"), ("velocity",)]
    assert read_waves(tmp_path, "a/b", "early").layers["layer"].tolist() == [2]


def test_what_is_not_there_is_said_with_what_is(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="no waves of velocity: run cytodisk waves first"):
        read_waves(tmp_path)
    write_waves(tmp_path, "Rac1", tables(0), COLUMNS, {}, "early")
    with pytest.raises(ReadError, match=r"no waves of velocity: it has those of Rac1 \(early\)"):
        read_waves(tmp_path)
