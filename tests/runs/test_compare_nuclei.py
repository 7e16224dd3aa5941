"""Windows compared on cells with nuclei."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.errors import ParameterError
from cytodisk.runs.compare_windows.comparison_words import ring_faults
from cytodisk.runs.parameters_file import parameters_from

METHODS = ("newton", "nucleus-rings", "interpolated-rings")
SETTINGS: dict[str, Any] = {"layers": 4, "sectors": 12, "nucleus_layers": 2}


def horseshoe() -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """A cell that interpolated rings leave, with its nucleus in one arm."""
    cell = np.zeros((70, 64), dtype=bool)
    cell[2:68, 2:20] = cell[50:68, 2:62] = cell[2:68, 44:62] = True
    nucleus = np.zeros_like(cell)
    nucleus[7:18, 6:16] = True
    return cell, nucleus


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A round cell with a nucleus off its centre, a horseshoe, and a cell without a nucleus."""
    cells, nuclei = np.zeros((2, 80, 210), dtype=np.uint16)
    y, x = np.indices(cells.shape)
    cells[(y - 40) ** 2 + (x - 40) ** 2 <= 30**2] = 1
    nuclei[(y - 40) ** 2 + (x - 48) ** 2 <= 10**2] = 7
    cell, nucleus = horseshoe()
    cells[5:75, 80:144][cell], nuclei[5:75, 80:144][nucleus] = 2, 3
    cells[20:40, 160:200] = 3
    folder = tmp_path_factory.mktemp("nuclei")
    tifffile.imwrite(folder / "cells.tif", cells)
    tifffile.imwrite(folder / "nuclei.tif", nuclei)
    return folder / "cells.tif", folder / "nuclei.tif"


@pytest.fixture(scope="module")
def comparison(files: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> cd.Comparison:
    cells, nuclei = files
    out = tmp_path_factory.mktemp("comparison") / "out"
    return cd.run_compare_windows(cells, out, nuclei=nuclei, **SETTINGS)


def row_of(comparison: cd.Comparison, cell: int, method: str) -> dict[str, Any]:
    cells = comparison.cells
    (row,) = cells[(cells["cell"] == cell) & (cells["method"] == method)].to_dict("records")
    return row


def test_numbers_are_those_of_the_windows(comparison: cd.Comparison) -> None:
    cell, nucleus = horseshoe()
    rings = cd.interpolated_ring_windows(cell, nucleus, **SETTINGS)
    row = row_of(comparison, 1, "interpolated-rings")
    assert row["flipped"] == rings.n_turned_over > 0
    assert row["invalid_maps"] == 1
    assert row["outside"] == pytest.approx(rings.outside)
    assert row["overlap"] == pytest.approx(rings.overlap)
    assert row["nucleus_area"] == nucleus.sum()
    by_distance = cd.nucleus_ring_windows(cell, nucleus, **SETTINGS)
    row = row_of(comparison, 1, "nucleus-rings")
    assert row["empty_windows"] == by_distance.n_empty
    five = cd.nucleus_ring_windows(cell, nucleus, 5, 1, 1).areas[:, 0]
    assert row["outer_fifth"] == pytest.approx(five[0] / five[:5].sum())
    assert row["outer_fifth"] > 0.4


def test_windows_of_the_map_are_equal_and_none_is_empty(comparison: cd.Comparison) -> None:
    for cell in (0, 1):
        row = row_of(comparison, cell, "newton")
        assert (row["certificate_valid"], row["flipped"], row["empty_windows"]) == (True, 0, 0)
        assert row["outer_fifth"] == pytest.approx(0.2, abs=0.02)
        for other in METHODS[1:]:
            for name in ("area_error_cytoplasm", "area_error_nucleus"):
                assert row[name] < row_of(comparison, cell, other)[name]


def test_a_cell_without_a_nucleus_has_rows_with_the_reason(comparison: cd.Comparison) -> None:
    for method in METHODS:
        row = row_of(comparison, 2, method)
        assert row["status"] == "refused"
        assert "nucleus" in row["reason"]
        assert "--missing" not in row["reason"], "there is no such flag here"


def test_layers_say_their_compartment_and_how_large_they_are(comparison: cd.Comparison) -> None:
    table = comparison.by_layer
    assert table["compartment"].tolist() == [*["cytoplasm"] * 4, *["nucleus"] * 2] * 3
    own = table.set_index("method")["relative_area"]
    assert own["newton"].to_numpy() == pytest.approx(1.0, abs=0.05)
    outer, *_, inner = own["nucleus-rings"].iloc[:4]
    assert outer > 1.3 > 0.8 > inner


def test_summaries_stand_in_files_with_their_columns(comparison: cd.Comparison) -> None:
    told = pd.read_csv(comparison.path / "comparison_columns.csv").set_index(["table", "name"])
    for name, table in (
        ("comparison.csv", comparison.by_layer),
        ("comparison_methods.csv", comparison.by_method),
    ):
        assert list(told.loc[name].index) == list(table.columns)
        assert list(pd.read_csv(comparison.path / name).columns) == list(table.columns)
    method = comparison.by_method.set_index("method")
    assert method.loc["interpolated-rings", "invalid_maps"] == 1
    assert np.isnan(method.loc["nucleus-rings", "outside"])
    read = cd.open_comparison(comparison.path)
    assert read.has_nuclei
    assert not read.is_movie
    assert read.methods == METHODS


def test_words_say_what_is_wrong_with_rings(comparison: cd.Comparison) -> None:
    distance, interpolated = ring_faults(comparison)
    assert distance.startswith("rings by distance: ")
    assert "the outermost of five rings holds" in distance
    assert interpolated.startswith("interpolated rings: rings cross each other in 1 of 2 cells; ")
    assert "of their points lie outside the cell" in interpolated


def test_windows_are_kept_with_the_nucleus(comparison: cd.Comparison) -> None:
    labels = comparison.labels(1)
    assert set(labels) == {"mask", "nucleus", *METHODS}
    assert labels["nucleus"].sum() == 16 * horseshoe()[1].sum()
    for method in ("newton", "nucleus-rings"):
        assert ((labels[method] >= 4 * 12) == labels["nucleus"]).all()


def test_a_stopped_run_goes_on_and_is_the_same(
    files: tuple[Path, Path], comparison: cd.Comparison, tmp_path: Path
) -> None:
    """Any complete comparison is one that can be resumed."""
    cells, nuclei = files
    out = tmp_path / "out"
    cd.run_compare_windows(cells, out, nuclei=nuclei, methods=("nucleus-rings",), **SETTINGS)
    again = cd.run_compare_windows(
        cells, out, nuclei=nuclei, methods=("nucleus-rings",), resume=True, **SETTINGS
    )
    own = comparison.cells[comparison.cells["method"] == "nucleus-rings"].reset_index(drop=True)
    pd.testing.assert_frame_equal(again.cells.drop(columns="seconds"), own.drop(columns="seconds"))


def test_parameters_can_be_fed_back(comparison: cd.Comparison) -> None:
    path = comparison.path / "parameters.toml"
    found = parameters_from({}, path, cd.CompareNucleiParameters)
    assert found == cd.CompareNucleiParameters(**SETTINGS)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"methods": ("edge",)}, "methods must be several of newton, nucleus-rings, interpolated-rings"),
        ({"methods": ("newton", "newton")}, "each once"),
        ({"movie": True}, "leave signal and movie out"),
        ({"signal": "signal.tif"}, "leave signal and movie out"),
    ],
)
def test_what_makes_no_sense_with_nuclei_is_refused(
    files: tuple[Path, Path], tmp_path: Path, settings: dict[str, Any], words: str
) -> None:
    cells, nuclei = files
    with pytest.raises(ParameterError, match=words):
        cd.run_compare_windows(cells, tmp_path / "out", nuclei=nuclei, **settings)


def test_what_needs_nuclei_is_refused_without(files: tuple[Path, Path], tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="nucleus_layers, harmonics: only with nuclei"):
        cd.run_compare_windows(files[0], tmp_path / "out", nucleus_layers=2, harmonics=8)
    with pytest.raises(ParameterError, match="pass nuclei, too"):
        cd.run_compare_windows(files[0], tmp_path / "out", parameters=cd.CompareNucleiParameters())


def test_figures_show_both_compartments(comparison: cd.Comparison, monkeypatch: pytest.MonkeyPatch) -> None:
    """Layers of the nucleus are blue, those of the cytoplasm brown to yellow, and a line stands between."""
    drawn: list[Figure] = []
    save = Figure.savefig
    monkeypatch.setattr(
        Figure, "savefig", lambda self, *args, **named: drawn.append(self) or save(self, *args, **named)
    )
    cd.pages.write_comparison(comparison)
    cd.pages.write_compared_cells(comparison)
    by_layer, cells = drawn
    assert [ax.get_ylabel() for ax in by_layer.axes] == [
        "completeness",
        "area over the mean",
        "CV of area",
        "mean eccentricity",
    ]
    for ax in by_layer.axes:
        borders = [line for line in ax.get_lines() if list(line.get_xdata()) == [3.5, 3.5]]
        assert len(borders) == 1
    picture = np.asarray(cells.axes[0].get_images()[0].get_array())
    nucleus = comparison.labels(0)["nucleus"]
    mask = comparison.labels(0)["mask"]
    red, blue = picture[..., 0], picture[..., 2]
    assert (blue[nucleus] > red[nucleus]).all()
    assert (blue[mask & ~nucleus] < red[mask & ~nucleus]).all()
    row = row_of(comparison, 1, "interpolated-rings")
    words = [f"{1 - row['empty_windows'] / 72:.0%}", f"{row['flipped']:.0f} turned over"]
    assert set(words) <= {text.get_text() for text in cells.texts}
