import base64
import builtins
import io
import re
import shutil
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cells_study import CHANNELS, FILES, LAYERS, SECTORS, json_in
from PIL import Image

import cytodisk as cd
from cytodisk.errors import MissingPartError, ParameterError
from cytodisk.pages.report.cells import cells_html as cells_module
from cytodisk.pages.report.cells.cells_html import cells_page
from cytodisk.pages.report.listed import MOST_ROWS, listed, rows_words
from cytodisk.pages.report.page import write_report
from cytodisk.runs.map.input_files import find_inputs
from cytodisk.store.study import Study


def array(packed: dict[str, Any]) -> np.ndarray[Any, Any]:
    numbers = np.frombuffer(zlib.decompress(base64.b64decode(packed["data"])), dtype="<f4")
    return numbers.reshape(packed["shape"])


def rows_of(page: Path | str) -> list[dict[str, Any]]:
    table = json_in(page, "data")["table"]
    names = [column["name"] for column in table["columns"]]
    return [dict(zip(names, row, strict=True)) for row in table["rows"]]


def test_finding_comes_first(cells_written: Path) -> None:
    text = cells_written.read_text(encoding="utf-8")
    body = text.split("<body")[1]
    words = "5 of 6 cells in 2 files are mapped one to one; 1 refused;"
    assert words in body
    assert body.index(words) < body.index('id="flags"') < body.index('<div id="cells"')
    assert "<strong>1 refused</strong>: " in body
    assert 'data-cell="5">b.tif, label 3</button>' in body


def test_page_is_one_file_and_names_stay_names(cells_written: Path) -> None:
    text = cells_written.read_text(encoding="utf-8")
    assert re.findall(r"""(?:src|href)=["']?(?!data:)([^"'> ]+)""", text.split("<script>")[0]) == []
    assert CHANNELS[0] not in text
    assert FILES[0] not in text.split("<script")[0]
    assert text.count("</script>") == text.count("<script")


def test_list_holds_every_cell_with_its_means(cells: Study, cells_written: Path) -> None:
    rows = rows_of(cells_written)
    assert [row["cell"] for row in rows] == list(range(6))
    assert [row["source"] for row in rows] == [FILES[0]] * 3 + [FILES[1]] * 3
    assert [row["mean DNA"] for row in rows] == [500, 500, 500, 500, 500, None]
    windows = cells.windows[(cells.windows["cell"] == 2) & (cells.windows["channel"] == CHANNELS[0])]
    expected = np.average(windows["mean"], weights=windows["n_pixels"])
    assert rows[2][f"mean {CHANNELS[0]}"] == pytest.approx(expected, rel=1e-5)
    assert rows[5]["status"] == "refused"
    assert rows[5]["reason"]


def test_pictures_hold_pixels_windows_and_numbers(cells: Study, cells_written: Path) -> None:
    data, pictures = json_in(cells_written, "data"), json_in(cells_written, "pictures")
    assert data["pictured"] == list(range(6))
    one = pictures[0]
    height, width = one["shape"]
    labels = np.frombuffer(zlib.decompress(base64.b64decode(one["labels"])), dtype="<u2").reshape(
        height, width
    )
    assert set(np.unique(labels)) == {*range(LAYERS * SECTORS), 65535}
    grey = np.asarray(Image.open(io.BytesIO(base64.b64decode(one["channels"][1]))))
    assert grey.shape == (height, width)
    assert grey[labels != 65535].mean() > 240
    assert grey[labels == 65535].mean() < 120
    table = cells.windows[(cells.windows["cell"] == 0) & (cells.windows["channel"] == CHANNELS[0])]
    found = array(one["numbers"]["mean"])
    assert found.shape == (2, LAYERS * SECTORS)
    np.testing.assert_allclose(found[0], table["mean"], rtol=2e-4)
    np.testing.assert_allclose(array(one["numbers"]["area"]), table["area"], rtol=2e-4)


def test_refused_cell_is_shown_by_its_mask(cells_written: Path) -> None:
    refused = json_in(cells_written, "pictures")[5]
    labels = np.frombuffer(zlib.decompress(base64.b64decode(refused["labels"])), dtype="<u2")
    assert set(np.unique(labels)) == {0, 65535}
    assert refused["numbers"] is None
    assert len(refused["channels"]) == 2


def test_cells_beyond_the_room_are_told(cells: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    few = cells_page(cells, most=2)
    assert json_in(few, "data")["pictured"] == [0, 1]
    assert len(rows_of(few)) == 6
    assert "Pictures of 2 of 6 cells are on this page" in few
    assert f"cytodisk report {cells.path} --cell 2" in few
    monkeypatch.setattr(cells_module, "MOST_BYTES", 1)
    assert json_in(cells_page(cells), "data")["pictured"] == [0]


def test_first_cell_with_a_picture(cells: Study, cell_files: Path) -> None:
    path = write_report(cells, cell=3)
    assert path.name == "report_cell_00003.html"
    assert json_in(path, "data")["pictured"] == [3, 4, 5]
    path.unlink()
    with pytest.raises(ParameterError, match=r"6 cells from 0, got 9"):
        write_report(cells, cell=9)


def test_signal_is_for_movies(cells: Study) -> None:
    class Images:
        n_frames, image_shape, channels = 1, (60, 120), ("a",)

        def frame(self, number: int) -> np.ndarray[Any, Any]:
            return np.zeros((1, 60, 120))

    with pytest.raises(ParameterError, match="signal is for movies"):
        write_report(cells, signal=Images())


def test_files_are_found_again_where_names_end_alike(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import tifffile

    monkeypatch.chdir(tmp_path)
    (tmp_path / "in").mkdir()
    mask = cd.simulate.disk(10.0).astype(np.uint8)
    for name in ("x", "y"):
        tifffile.imwrite(f"in/{name}_masks.tif", mask)
        tifffile.imwrite(f"in/{name}_img.tif", mask * 9)
    study = cd.run_map("in", "out", signal="_img", layers=2, sectors=4)
    assert study.provenance["inputs"]["signal"]["given"] == "_img"
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir("elsewhere")  # paths are then looked up from the study
    found = find_inputs(cd.open_study(tmp_path / "out"))
    assert found.fault == ""
    assert found.inputs is not None
    assert [file.path.name for file in found.inputs.signal_files] == ["x_img.tif", "y_img.tif"]


def test_changed_and_missing_images_cost_the_pixels_alone(
    cell_files: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(cell_files / "masks", tmp_path / "masks")
    shutil.copytree(cell_files / "images", tmp_path / "images")
    study = cd.run_map(
        tmp_path / "masks", tmp_path / "out", signal=tmp_path / "images", kind="labels", layers=2
    )
    shutil.copy(cell_files / "images" / FILES[0], tmp_path / "images" / "b.tif")
    text = cells_page(study)
    assert "b.tif does not hold what was measured" in text
    picture = json_in(text, "pictures")[0]
    assert picture["channels"] is None
    assert picture["labels"]
    shutil.rmtree(tmp_path / "masks")
    assert "masks is not there any more" in cells_page(study)


def test_conditions_are_named_with_the_command(cells: Study) -> None:
    named = cells.cells.assign(
        condition=["control", "drug <i>"] * 3, experiment=["1", "1", "2", "2", "3", "3"]
    )
    named.attrs = cells.cells.attrs
    text = cells_page(Study(cells.path, named, cells.provenance), most=1)
    assert "control: 3 cells in 3 experiments; drug &lt;i&gt;: 2 cells in 2 experiments" in text
    assert "cytodisk population" in text
    assert json_in(text, "data")["group_columns"] == ["condition", "experiment"]


def test_missing_part_is_named(cells: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name == "jinja2":
            raise ImportError(name)
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(MissingPartError, match="pip install"):
        write_report(cells)


def test_long_tables_are_cut_and_say_so() -> None:
    import pandas as pd

    table = pd.DataFrame({"cell": range(MOST_ROWS + 1), "area": 0.123456789, "empty": None})
    found = listed(table, main=["area"])
    assert len(found["rows"]) == MOST_ROWS
    assert [column["name"] for column in found["columns"]] == ["area", "cell"]
    assert found["rows"][0] == [0.123457, 0]
    assert f"first {MOST_ROWS} of {MOST_ROWS + 1}" in rows_words(table, "cells.parquet")
    assert rows_words(table.head(), "cells.parquet") == ""
