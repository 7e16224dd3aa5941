import re
from pathlib import Path

import pytest
from cells_study import json_in

import cytodisk as cd
from cytodisk.errors import ReadError
from cytodisk.pages.report.page import write_batch_report, write_report


@pytest.fixture(scope="module")
def batch(cell_files: Path) -> Path:
    rows = [
        "name,masks,condition,experiment",
        "first,masks/a <b>&'.tif,control,1",
        "second,masks/b.tif,drug <i>,1",
        "third,damaged.tif,drug <i>,2",
    ]
    (cell_files / "damaged.tif").write_text("no image")
    (cell_files / "inputs.csv").write_text("\n".join(rows))
    (cell_files / "batch.toml").write_text(
        '[study]\ntable = "inputs.csv"\nkind = "map"\n'
        '[parameters]\nlayers = 2\nsectors = 4\nkind = "labels"\n'
    )
    cd.run_batch(cell_files / "batch.toml", cell_files / "all")
    return cell_files / "all"


@pytest.mark.slow
def test_batch_says_what_came_of_it_and_links_its_studies(batch: Path) -> None:
    text = write_batch_report(batch).read_text(encoding="utf-8")
    assert "2 of 3 inputs done; 1 refused; 6 cells, 5 mapped" in text
    assert "<strong>third refused</strong>: " in text
    assert "drug &lt;i&gt;: 2 inputs, 2 experiments, 3 cells" in text
    assert "2 inputs have no page of their own yet" in text
    assert json_in(text, "data")["inputs"]["links"] == [None, None, None]
    write_report(cd.open_study(batch / "inputs" / "second"))
    text = write_batch_report(batch).read_text(encoding="utf-8")
    data = json_in(text, "data")
    assert data["inputs"]["links"] == [None, "inputs/second/report.html", None]
    assert data["cells"]["links"] == [None] * 3 + [f"inputs/second/report.html#cell-{k}" for k in range(3)]
    assert "1 input has no page of its own yet" in text
    assert re.findall(r"""(?:src|href)=["']?(?!data:)([^"'> ]+)""", text.split("<script>")[0]) == []


def test_no_batch_is_told(tmp_path: Path) -> None:
    with pytest.raises(ReadError):
        write_batch_report(tmp_path)
