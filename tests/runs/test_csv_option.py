"""`csv=True` in every run that writes tables, also on top of a study that is complete."""

import json
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import DamagedPartWarning, StudyError

GRID = {"layers": 2, "sectors": 6}


@pytest.fixture
def labels(tmp_path: Path) -> Path:
    path = tmp_path / "labels.tif"
    tifffile.imwrite(path, cd.simulate.label_image(cells=3))
    return path


@pytest.fixture
def movie(tmp_path: Path) -> dict[str, Path]:
    truth = cd.simulate.movie("fluctuating", frames=24, radius_px=11)
    masks, signal = tmp_path / "masks.tif", tmp_path / "signal.ome.tif"
    tifffile.imwrite(masks, truth.masks.astype("uint8"), photometric="minisblack")
    tifffile.imwrite(signal, truth.signal.to_numpy(), metadata={"axes": "TCYX"})
    return {"masks": masks, "signal": signal}


def same_tables(folder: Path) -> list[str]:
    """Names of the tables of a folder; each is there as CSV, with the same content and a line a column."""
    tables = sorted(folder.glob("*.parquet"))
    told = pd.read_csv(folder / "columns.csv", keep_default_na=False)
    for table in tables:
        kept, text = pd.read_parquet(table), pd.read_csv(table.with_suffix(".csv"))
        assert list(text) == list(kept)
        assert sorted(told["column"][told["table"] == table.name]) == sorted(kept)
        numbers = kept.select_dtypes("number").columns
        pd.testing.assert_frame_equal(text[numbers], kept[numbers], check_dtype=False, rtol=0, atol=1e-12)
        assert (text["status"].fillna("") == kept["status"].fillna("")).all() if "status" in kept else True
    return [table.stem for table in tables]


def recorded(folder: Path) -> set[str]:
    return set(json.loads((folder / "provenance.json").read_text())["files"])


def test_map(labels: Path, tmp_path: Path) -> None:
    cd.run_map(labels, tmp_path / "out", csv=True, **GRID)
    assert same_tables(tmp_path / "out") == ["cells", "windows"]
    assert {"cells.csv", "windows.csv", "columns.csv"} <= recorded(tmp_path / "out")


def test_movie_and_correlation(movie: dict[str, Path], tmp_path: Path) -> None:
    study = cd.run_movie(**movie, out=tmp_path / "out", csv=True, channels=("=1+1", "b"), **GRID)
    assert same_tables(study.path) == ["cells", "consistency", "edge", "windows"]
    assert set(pd.read_csv(study.path / "windows.csv")["channel"]) == {"'=1+1", "b"}
    found = cd.run_correlate(study, "=1+1", max_lag=2, surrogates=19, csv=True)
    assert {"cells", "curves", "windows"} <= set(same_tables(found.path))


def test_shapes(labels: Path, tmp_path: Path) -> None:
    cd.run_shapes(labels, tmp_path / "out", csv=True)
    assert same_tables(tmp_path / "out") == ["cells", "shapes"]


@pytest.mark.parametrize("through_time", [False, True])
def test_compare_windows(labels: Path, movie: dict[str, Path], tmp_path: Path, through_time: bool) -> None:
    settings: dict[str, Any] = {"methods": ("edge",), "movie": through_time, **GRID}
    cd.run_compare_windows(movie["masks"] if through_time else labels, tmp_path / "out", csv=True, **settings)
    assert same_tables(tmp_path / "out") == ["cells", *(["consistency"] if through_time else []), "layers"]


def test_batch(labels: Path, tmp_path: Path) -> None:
    lines = ["[study]", "kind = 'map'", "[parameters]", "layers = 2", "[[inputs]]", "masks = 'labels.tif'"]
    (tmp_path / "batch.toml").write_text("\n".join([*lines, "condition = '=cmd()'"]))
    out = tmp_path / "out"
    cd.run_batch(tmp_path / "batch.toml", out)
    assert not (out / "cells.csv").exists()
    cd.run_batch(tmp_path / "batch.toml", out, csv=True, resume=True)
    assert same_tables(out) == ["cells", "inputs", "windows"]
    assert set(pd.read_csv(out / "windows.csv")["condition"]) == {"'=cmd()"}
    assert {"cells.csv", "windows.csv"} <= recorded(out)
    (out / "cells.csv").unlink()
    cd.run_batch(tmp_path / "batch.toml", out, resume=True)  # what was asked for once stays with the tables
    assert same_tables(out) == ["cells", "inputs", "windows"]


def test_csv_on_top_of_a_complete_study(labels: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    cd.run_map(labels, out, **GRID)
    assert not (out / "cells.csv").exists()
    before = (out / "cells.parquet").read_bytes()
    cd.run_map(labels, out, csv=True, resume=True, **GRID)
    assert same_tables(out) == ["cells", "windows"]
    assert (out / "cells.parquet").read_bytes() == before
    assert {"cells.csv", "windows.csv"} <= recorded(out)
    (out / "windows.csv").write_text("damaged")
    with pytest.warns(DamagedPartWarning, match=r"windows\.csv gone or damaged: these are made anew"):
        cd.run_map(labels, out, resume=True, **GRID)
    assert same_tables(out) == ["cells", "windows"]
    cd.run_map(labels, out, overwrite=True, **GRID)
    assert not list(out.glob("windows.csv"))


def test_a_table_of_the_user_is_not_replaced(labels: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    cd.run_map(labels, out, **GRID)
    (out / "windows.csv").write_text("mine")
    for again in ({"resume": True}, {"overwrite": True}):
        with pytest.raises(StudyError, match=r"windows\.csv was not written by cytodisk.*leave --csv out"):
            cd.run_map(labels, out, csv=True, **again, **GRID)
    cd.run_map(labels, out, overwrite=True, **GRID)
    assert (out / "windows.csv").read_text() == "mine"
