import struct
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.figure import Figure

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError, SignalError, StudyError
from cytodisk.pages.cell_pages import write_cell_figures, write_overview
from cytodisk.windows.cell_windows import CellWindows


def _pixels_across(path: Path) -> int:
    return int(struct.unpack(">I", path.read_bytes()[16:20])[0])


def _labels(figure: Figure) -> set[str]:
    return {label for ax in figure.axes for label in (ax.get_xlabel(), ax.get_ylabel()) if label}


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


def test_page_with_channels(
    tmp_path: Path, windows: CellWindows, image: FloatArray, saved: list[Figure]
) -> None:
    signal = xr.DataArray(
        np.stack([image, image**2]), dims=("channel", "y", "x"), coords={"channel": ["VASP", "$Rac1$"]}
    )
    (path,) = write_cell_figures(tmp_path, "cell 1.b", windows, signal, 0.25)
    assert path == tmp_path / "cell 1.b.png"
    assert list(tmp_path.iterdir()) == [path]
    assert _pixels_across(path) == round(180 / 25.4 * 200)
    expected = {"VASP (a.u.)", "mean VASP (a.u.)", "$Rac1$ (a.u.)", "mean $Rac1$ (a.u.)"}
    assert expected | {"disk area / cell area, log2", "cell's area (%)"} == _labels(saved[0])
    assert any(word.endswith("µm²") for words in _words(saved[0]) for word in words.split(" · "))
    assert "2 µm" in _words(saved[0])


def test_page_of_one_channel_without_name_or_scale(
    tmp_path: Path, windows: CellWindows, image: FloatArray, saved: list[Figure]
) -> None:
    write_cell_figures(tmp_path, "a", windows, xr.DataArray(image, dims=("y", "x")), None)
    assert "signal (a.u.)" in _labels(saved[0])
    assert not any("µm" in words for words in _words(saved[0]))


def test_page_says_which_channels_it_leaves_out(
    tmp_path: Path, windows: CellWindows, image: FloatArray, saved: list[Figure]
) -> None:
    signal = xr.DataArray(np.stack([image] * 5), dims=("channel", "y", "x"))
    write_cell_figures(tmp_path, "a", windows, signal, None)
    assert any("channels 1–3 of 5" in words for words in _words(saved[0]))
    assert "channel 2 (a.u.)" in _labels(saved[0])
    assert "channel 3 (a.u.)" not in _labels(saved[0])


def test_page_without_signal(tmp_path: Path, windows: CellWindows, saved: list[Figure]) -> None:
    write_cell_figures(tmp_path, "x" * 200, windows, None, None)
    labels = {"layer, 0 at the cell's edge", "disk area / cell area, log2", "cell's area (%)"}
    assert _labels(saved[0]) == labels


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_page_of_an_empty_signal(tmp_path: Path, windows: CellWindows, value: float) -> None:
    signal = xr.DataArray(np.full(windows.mask.shape, value), dims=("y", "x"))
    (path,) = write_cell_figures(tmp_path, "a", windows, signal, None)
    assert path.exists()


def test_page_refuses(tmp_path: Path, windows: CellWindows) -> None:
    with pytest.raises(ParameterError, match="name must be a file name without folders, got 'a/b'"):
        write_cell_figures(tmp_path, "a/b", windows, None, None)
    with pytest.raises(SignalError, match="signal has shape"):
        write_cell_figures(tmp_path, "a", windows, xr.DataArray(np.ones((3, 3)), dims=("y", "x")), None)
    with pytest.raises(StudyError, match="cannot write"):
        write_cell_figures(tmp_path / "missing", "a", windows, None, None)
    assert not list(tmp_path.iterdir())


def test_overview_of_many(tmp_path: Path, saved: list[Figure]) -> None:
    cells = _cells(["ok"] * 30 + ["refused"] * 3 + ["unreadable"])
    cells.attrs["units"] = {"area": "µm²"}
    path = write_overview(tmp_path / "overview.png", cells)
    assert _pixels_across(path) == round(180 / 25.4 * 200)
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
