import struct
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError
from cytodisk.pages.overview import write_overview


def _pixels_across(path: Path) -> int:
    return int(struct.unpack(">I", path.read_bytes()[16:20])[0])


def _words(figure: Figure) -> set[str]:
    texts = [*figure.texts, *(text for ax in figure.axes for text in ax.texts)]
    return {text.get_text() for text in texts}


def _cells(status: list[str]) -> pd.DataFrame:
    mapped = np.array([word == "ok" for word in status])
    numbers = np.arange(1.0, len(status) + 1)
    return pd.DataFrame(
        {
            "status": status,
            "area": 1000 * numbers,
            "area_distortion": np.where(mapped, 0.01 * numbers, np.nan),
        }
    )


def test_overview_of_many(tmp_path: Path, saved: list[Figure]) -> None:
    cells = _cells(["ok"] * 30 + ["refused"] * 3 + ["unreadable"])
    cells.attrs["units"] = {"area": "µm²"}
    path = write_overview(tmp_path / "overview.png", cells)
    assert _pixels_across(path) == int(119 / 25.4 * 300)
    status, histogram, scatter = saved[0].axes
    assert [patch.get_width() for patch in status.patches] == [30, 3, 1]
    assert sum(patch.get_height() for patch in histogram.patches) == 30
    assert scatter.get_xlabel() == "area (µm²)"
    assert len(scatter.collections[0].get_offsets()) == 30


def test_files_without_a_cell_are_no_cells_in_the_overview(tmp_path: Path, saved: list[Figure]) -> None:
    cells = _cells(["ok"] * 30 + ["refused"] * 3 + ["unreadable", "no cell"])
    cells["label"] = [1] * 33 + [0] * 2
    write_overview(tmp_path / "overview.png", cells)
    status = saved[0].axes[0]
    assert [patch.get_width() for patch in status.patches] == [30, 3, 0]
    assert (status.get_xlabel(), status.get_title()) == ("cells", "status (and 2 without a cell)")


@pytest.mark.parametrize("status", [["ok"], ["refused"], ["unreadable", "refused"]])
def test_overview_of_few(tmp_path: Path, saved: list[Figure], status: list[str]) -> None:
    write_overview(tmp_path / "overview.png", _cells(status))
    assert ("no cell was mapped" in _words(saved[0])) == ("ok" not in status)


@pytest.mark.parametrize(
    ("largest", "expected"),
    [(2.0e3, ["200", "500", "1000", "2000"]), (2.0e6, ["1000", "10000", "100000", "1e+06"])],
)
def test_labels_of_areas_do_not_lie_over_each_other(
    tmp_path: Path, saved: list[Figure], largest: float, expected: list[str]
) -> None:
    cells = _cells(["ok"] * 50)
    cells["area"] = np.geomspace(190.0, largest, 50)
    write_overview(tmp_path / "overview.png", cells)
    ax = saved[0].axes[2]
    low, high = ax.get_xlim()
    inside = [tick for tick in ax.get_xticks() if low <= tick <= high]
    assert [ax.xaxis.get_major_formatter()(tick) for tick in inside] == expected
    assert ax.xaxis.get_minor_formatter()(300.0) == ""


def test_overview_draws_cells_from_least_to_most(tmp_path: Path, disk: DiskMap, saved: list[Figure]) -> None:
    asked: list[int] = []

    def find(row: int) -> DiskMap:
        asked.append(row)
        return disk

    cells = _cells(["refused", *["ok"] * 11])
    cells.index = cells.index[::-1]
    write_overview(tmp_path / "overview.png", cells, find)
    assert asked == sorted(asked)
    assert len(asked) == 6
    assert (asked[0], asked[-1]) == (1, 11)


def test_overview_refuses(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="cells has no rows"):
        write_overview(tmp_path / "a.png", _cells([]))
    with pytest.raises(ParameterError, match=r"cells lacks the columns \['area'\]"):
        write_overview(tmp_path / "a.png", _cells(["ok"]).drop(columns="area"))
