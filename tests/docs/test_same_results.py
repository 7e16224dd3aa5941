"""The comparison of results finds what differs, and knows the names that changed."""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import zarr
from PIL import Image
from zarr.storage import ZipStore

BENCHMARKS = str(Path(__file__).parents[2] / "benchmarks")


@pytest.fixture(scope="module")
def same() -> Iterator[Any]:
    sys.path.insert(0, BENCHMARKS)
    try:
        yield __import__("same_results")
    finally:
        sys.path.remove(BENCHMARKS)


def write_results(folder: Path, frame: str, flags: str, **changed: Any) -> Path:
    """A small study, with the names of its columns; what is changed in it."""
    (folder / "maps").mkdir(parents=True)
    table = {
        frame: [0, 1],
        "area": [1.5, np.nan],
        flags: ["", "hole"],
        "seconds": [changed.pop("seconds", 1.0)] * 2,
    }
    table |= {name: values for name, values in changed.items() if name in ("area", flags)}
    units = {frame: "frame", "area": changed.get("unit", "px²")}
    columns = pa.Table.from_pandas(pd.DataFrame(table))
    fields = [field.with_metadata({"unit": units.get(field.name, "")}) for field in columns.schema]
    pq.write_table(columns.cast(pa.schema(fields)), folder / "cells.parquet")
    header = json.dumps({"format": changed.get("format", 1), "report": {"holes": 0}})
    np.savez(folder / "maps" / "cell_0.npz", header=header, vertices=changed.get("vertices", np.eye(3)))
    place = folder / "activity.zarr"  # as earlier versions wrote it
    store = place if frame == "time" else ZipStore(place.with_suffix(".zarr.zip"), mode="w")
    cell = zarr.open_group(store, mode="w").create_group("cell_0")
    for name, values in ((frame, np.arange(2)), ("velocity", changed.get("velocity", np.zeros(4)))):
        cell.create_array(name, data=values)
    if isinstance(store, ZipStore):
        store.close()
    picture = np.zeros((4, 5, 3), np.uint8)
    picture[: changed.get("drawn", 1)] = 255
    Image.fromarray(picture).save(folder / "cell.png")
    return folder


@pytest.fixture
def old(tmp_path: Path) -> Path:
    return write_results(tmp_path / "old", "time", "doubts")


def test_renamed_columns_and_other_running_times_are_no_difference(
    same: Any, old: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    new = write_results(tmp_path / "new", "frame", "qc_flags", seconds=2.0, format=2)
    files, findings = same.compare_folders(old, new)
    assert files == ["activity.zarr.zip", "cell.png", "cells.parquet", "maps/cell_0.npz"]
    assert findings == []
    assert same.report(files, findings)
    assert "seconds (running time)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("changed", "file", "name", "words"),
    [
        ({"area": [1.5 + 3e-16, np.nan]}, "cells.parquet", "area", "1 of 2 differ, by at most 2.22e-16"),
        ({"area": [1.5, 2.0]}, "cells.parquet", "area", "NaN on one side only: 1"),
        ({"area": [1, 2]}, "cells.parquet", "area", "type float64 → int64"),
        ({"unit": "µm²"}, "cells.parquet", "unit of area", "'px²' → 'µm²'"),
        ({"qc_flags": ["", "two"]}, "cells.parquet", "qc_flags", "'hole' → 'two'"),
        (
            {"vertices": np.eye(3) * 2},
            "maps/cell_0.npz",
            "vertices",
            "3 of 9 differ, by at most 1 (relative 0.5)",
        ),
        ({"vertices": np.eye(4)}, "maps/cell_0.npz", "vertices", "shape (3, 3) → (4, 4)"),
        ({"velocity": np.array([0, 0, 0, 1e-9])}, "activity.zarr.zip", "cell_0/velocity", "1 of 4 differ"),
    ],
)
def test_a_planted_difference_is_found(
    same: Any,
    old: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    changed: dict[str, Any],
    file: str,
    name: str,
    words: str,
) -> None:
    new = write_results(tmp_path / "new", "frame", "qc_flags", **changed)
    files, findings = same.compare_folders(old, new)
    assert [(one.file, one.name) for one in findings] == [(file, name)]
    assert words in findings[0].text
    assert not same.report(files, findings)
    assert "DIFFERENT: " in capsys.readouterr().out


def test_a_column_a_file_and_a_figure_that_are_gone_are_differences(
    same: Any, old: Path, tmp_path: Path
) -> None:
    new = write_results(tmp_path / "new", "frame", "other")
    (new / "cell.png").rename(new / "cell_0.png")
    gone = [(one.file, one.name) for one in same.compare_folders(old, new)[1] if one.text == "is gone"]
    come = [(one.file, one.name) for one in same.compare_folders(old, new)[1] if one.text == "is new"]
    assert gone == [("cell.png", ""), ("cells.parquet", "qc_flags"), ("cells.parquet", "unit of qc_flags")]
    assert come == [("cell_0.png", ""), ("cells.parquet", "other"), ("cells.parquet", "unit of other")]


def test_pixels_of_a_figure_are_told_and_do_not_count(same: Any, old: Path, tmp_path: Path) -> None:
    new = write_results(tmp_path / "new", "frame", "qc_flags", drawn=2)
    files, findings = same.compare_folders(old, new)
    assert [(one.file, one.text, one.counts) for one in findings] == [
        ("cell.png", "25.00% of pixels differ", False)
    ]
    assert same.report(files, findings)


def test_a_difference_that_is_explained_is_no_failure(
    same: Any, old: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    new = write_results(tmp_path / "new", "frame", "qc_flags", area=[1.0, 1.0])
    monkeypatch.setitem(same.EXPLAINED, (r"cells\.parquet$", "area"), "areas are whole now")
    assert same.report(*same.compare_folders(old, new))
    assert "wanted: area: " in capsys.readouterr().out
