import struct
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from scipy import ndimage

import cytodisk as cd
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError, SignalError, StudyError
from cytodisk.pages.cell_pages import write_cell_figures
from cytodisk.windows.polar_windows import CellWindows


def _pixels_across(path: Path) -> int:
    return int(struct.unpack(">I", path.read_bytes()[16:20])[0])


def _labels(figure: Figure) -> set[str]:
    return {label for ax in figure.axes for label in (ax.get_xlabel(), ax.get_ylabel()) if label}


def _words(figure: Figure) -> set[str]:
    texts = [*figure.texts, *(text for ax in figure.axes for text in ax.texts)]
    return {text.get_text() for text in texts}


def test_page_with_channels(
    tmp_path: Path, windows: CellWindows, image: FloatArray, saved: list[Figure]
) -> None:
    signal = xr.DataArray(
        np.stack([image, image**2]), dims=("channel", "y", "x"), coords={"channel": ["VASP", "$Rac1$"]}
    )
    (path,) = write_cell_figures(tmp_path, "cell 1.b", windows, signal, cd.Scale(0.25))
    assert path == tmp_path / "cell 1.b.png"
    assert list(tmp_path.iterdir()) == [path]
    assert 85 / 25.4 * 300 < _pixels_across(path) < 119 / 25.4 * 300
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


@pytest.mark.slow
def test_page_says_which_channels_it_leaves_out(
    tmp_path: Path, windows: CellWindows, image: FloatArray, saved: list[Figure]
) -> None:
    signal = xr.DataArray(np.stack([image] * 5), dims=("channel", "y", "x"))
    write_cell_figures(tmp_path, "a", windows, signal, None)
    assert any("channels 1–3 of 5" in words for words in _words(saved[0]))
    assert "channel 2 (a.u.)" in _labels(saved[0])
    assert "channel 3 (a.u.)" not in _labels(saved[0])


@pytest.mark.slow
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
    with pytest.raises(ParameterError, match=r"name.*'a/b'"):
        write_cell_figures(tmp_path, "a/b", windows, None, None)
    with pytest.raises(SignalError, match="signal has shape"):
        write_cell_figures(tmp_path, "a", windows, xr.DataArray(np.ones((3, 3)), dims=("y", "x")), None)
    with pytest.raises(StudyError, match="cannot write"):
        write_cell_figures(tmp_path / "missing", "a", windows, None, None)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("measured", "covers"), [(True, 2), (False, 1)])  # means and layers; layers
def test_windows_leave_excluded_holes_out(
    tmp_path: Path, saved: list[Figure], measured: bool, covers: int
) -> None:
    cell = cd.simulate.cell_with_nucleus("off centre", seed=5, shape="spread")
    depth = ndimage.distance_transform_edt(cell.mask & ~cell.nucleus)
    mask = cell.mask & (depth < depth.max())
    disk = cd.map_to_disk(mask, nucleus=cell.nucleus, holes="exclude")
    assert disk.holes is not None
    windows = cd.polar_windows(layers=3, sectors=8, nucleus_layers=1).on(disk)
    signal = xr.DataArray(mask.astype(float), dims=("y", "x")) if measured else None
    write_cell_figures(tmp_path, "cell", windows, signal)
    arrays = [np.asarray(image.get_array()) for ax in saved[0].axes for image in ax.images]
    opaque = [array[..., 3].sum() for array in arrays if array.shape[2:] == (4,)]
    assert opaque.count(disk.holes.box.sum()) == covers
