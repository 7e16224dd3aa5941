"""A batch's `--resume` believes no damaged study, and its `--overwrite` removes what was recorded alone."""

import shutil
from pathlib import Path

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import StudyError
from cytodisk.runs.batch.batch_file import Batch, read_batch
from cytodisk.runs.batch.batch_study import batch_study

THEIRS = ("notes.txt", ".hidden", "rows/mine.txt", "inputs/one/notes.txt", "inputs/mine/a.tif")
TEXT = """[parameters]
layers = 2
sectors = 6
[[inputs]]
masks = "{}*.tif"
name = "{{stem}}"
kind = "map"
"""


@pytest.fixture(scope="module")
def batch(tmp_path_factory: pytest.TempPathFactory) -> Batch:
    folder = tmp_path_factory.mktemp("batch")
    for name, radius in (("one", 9), ("two", 11)):
        tifffile.imwrite(folder / f"{name}.tif", cd.simulate.disk(radius).astype(np.uint8))
    (folder / "batch.toml").write_text(TEXT.format(""))
    return read_batch(folder / "batch.toml")


@pytest.fixture(scope="module")
def done(batch: Batch, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Results of the batch."""
    out = tmp_path_factory.mktemp("done") / "out"
    batch_study(batch, out)
    return out


@pytest.fixture
def out(done: Path, tmp_path: Path) -> Path:
    """A copy of them, to be harmed."""
    return Path(shutil.copytree(done, tmp_path / "out"))


def contents(out: Path) -> dict[str, bytes]:
    return {str(path.relative_to(out)): path.read_bytes() for path in out.rglob("*") if path.is_file()}


@pytest.mark.slow
def test_a_study_that_is_not_whole_is_done_anew(batch: Batch, out: Path) -> None:
    for name in ("inputs/one/maps/cell_00000.npz", "inputs/two/windows.parquet", "rows/two.json"):
        before = (out / name).read_bytes()
        (out / name).write_bytes(before[:-9])
        summary = batch_study(batch, out, resume=True)
        assert summary.statuses == {"ok": 2}
        damaged = name.split("/")[1].removesuffix(".json")
        assert summary.remarks == [f"damaged since they were done, so they are done anew: {damaged}"]
        if not name.endswith(".json"):  # which has times
            assert (out / name).read_bytes() == before
    assert batch_study(batch, out, resume=True).remarks == []


@pytest.mark.slow
def test_overwrite_leaves_what_is_not_the_batchs(batch: Batch, out: Path) -> None:
    for name in THEIRS:
        (out / name).parent.mkdir(exist_ok=True)
        (out / name).write_text("mine")
    assert batch_study(batch, out, overwrite=True).statuses == {"ok": 2}
    assert [(out / name).read_text() for name in THEIRS] == ["mine"] * len(THEIRS)


@pytest.mark.slow
def test_overwrite_is_refused_where_an_input_would_go(batch: Batch, out: Path, tmp_path: Path) -> None:
    tifffile.imwrite(out / "inputs" / "one" / "maps" / "mask.tif", cd.simulate.disk(9).astype(np.uint8))
    (tmp_path / "batch.toml").write_text(TEXT.format("out/inputs/one/maps/"))
    inside = read_batch(tmp_path / "batch.toml")
    (out / "columns.csv").unlink()
    (out / "columns.csv").symlink_to(out / "inputs" / "one" / "maps" / "mask.tif")
    before = contents(out)
    with pytest.raises(StudyError, match="is among the results in"):
        batch_study(inside, out, overwrite=True)
    assert contents(out) == before
    (out / "columns.csv").unlink()
    (out / "inputs").rename(tmp_path / "elsewhere")
    (out / "inputs").symlink_to(tmp_path / "elsewhere")
    before = contents(tmp_path / "elsewhere")
    with pytest.raises(StudyError, match="inputs is a link, which --overwrite does not follow"):
        batch_study(batch, out, overwrite=True)
    assert contents(tmp_path / "elsewhere") == before


@pytest.mark.slow
def test_a_url_is_checked_too(batch: Batch, tmp_path: Path) -> None:
    out, url = tmp_path / "out", f"file://{tmp_path}/out"
    batch_study(batch, url)
    before = (out / "inputs" / "two" / "maps" / "cell_00000.npz").read_bytes()
    (out / "inputs" / "two" / "maps" / "cell_00000.npz").unlink()
    (out / "inputs" / "two" / "notes.txt").write_text("mine")
    summary = batch_study(batch, url, resume=True)
    assert summary.remarks == ["damaged since they were done, so they are done anew: two"]
    assert (out / "inputs" / "two" / "maps" / "cell_00000.npz").read_bytes() == before
    batch_study(batch, url, overwrite=True)
    assert (out / "inputs" / "two" / "notes.txt").read_text() == "mine"
