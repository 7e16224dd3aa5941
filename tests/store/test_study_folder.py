import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

import cytodisk as cd
from cytodisk.disk.mapping_parameters import MAPS_VERSION
from cytodisk.errors import EarlierVersionWarning, ReadError, StudyError
from cytodisk.files import temporary_name
from cytodisk.store.csv_tables import check_csv_room
from cytodisk.store.provenance_file import MAPS, differences
from cytodisk.store.study_folder import StudyFolder, part_key
from cytodisk.store.study_kind import StudyKind
from cytodisk.store.tables import SOURCE_COLUMNS
from cytodisk.store.window_columns import WINDOW_COLUMNS
from cytodisk.store.written_files import writing_files

KIND = StudyKind(
    "map",
    "cytodisk map",
    "",
    SOURCE_COLUMNS,
    {"windows": WINDOW_COLUMNS},
    ("maps/cell_[0-9]*.npz", "extra.csv"),
)

EARLIER = {MAPS: None}
"""Settings of a study of the first maps, which did not write their version down."""


def run(length_unit: str = "px", **settings: object) -> dict[str, object]:
    fingerprint = {"layers": 10} | settings | {MAPS: settings.get(MAPS, MAPS_VERSION)}
    known = {name: value for name, value in fingerprint.items() if value is not None}
    return {"fingerprint": known, "length_unit": length_unit}


def windows_of(cell: int) -> dict[str, object]:
    columns: dict[str, object] = {column.name: np.array([0.5 * cell, 1.0]) for column in WINDOW_COLUMNS}
    whole = {"cell": np.array([cell, cell]), "frame": [0, 0], "layer": [0, 0], "sector": [0, 1]}
    return columns | whole | {"channel": ["a", "a"], "status": ["ok", "ok"]}


def add(folder: StudyFolder, cell: int, **values: object) -> None:
    tables, files = {}, []
    if values["status"] == "ok":
        tables, files = {"windows": windows_of(cell)}, [folder.map_path(part_key(cell))]
        folder.begin(part_key(cell), files)
        files[0].write_text(f"map of cell {cell}")
    folder.add(part_key(cell), {"cell": cell, "frame": 0} | values, tables, files)


def finished(path: Path, length_unit: str = "px", **settings: object) -> StudyFolder:
    folder = StudyFolder.start(path, run(length_unit, **settings), KIND)
    add(folder, 0, status="ok", area=12.5)
    add(folder, 1, status="refused", reason="empty")
    folder.finish([part_key(0), part_key(1)])
    return folder


def test_a_study_reads_back_what_was_added(tmp_path: Path) -> None:
    finished(tmp_path / "out")
    study = cd.open_study(tmp_path / "out")
    assert study.cells["status"].tolist() == ["ok", "refused"]
    assert study.cells["area"].iloc[0] == 12.5
    assert np.isnan(study.cells["area"].iloc[1])
    assert study.windows["sector"].tolist() == [0, 1]
    assert study.provenance["status"] == "complete"


def test_each_column_of_each_table_is_explained(tmp_path: Path) -> None:
    finished(tmp_path / "out", "µm")
    told = pd.read_csv(tmp_path / "out" / "columns.csv", keep_default_na=False)
    for name in ("cells", "windows"):
        table = pq.read_schema(tmp_path / "out" / f"{name}.parquet")
        rows = told[told["table"] == f"{name}.parquet"]
        assert rows["column"].tolist() == table.names
        assert rows["unit"].tolist() == [field.metadata[b"unit"].decode() for field in table]
    assert told.set_index(["table", "column"]).loc[("windows.parquet", "area"), "unit"] == "µm²"
    assert (told["meaning"].str.len() > 5).all()


def test_no_temporary_file_is_left(tmp_path: Path) -> None:
    finished(tmp_path / "out")
    names = sorted(str(path.relative_to(tmp_path / "out")) for path in (tmp_path / "out").rglob("*"))
    assert names == [
        "cells.parquet",
        "columns.csv",
        "maps",
        "maps/cell_00000.npz",
        "provenance.json",
        "windows.parquet",
    ]


@pytest.mark.parametrize("unit", ["px", "µm"])
def test_units_stand_in_the_tables_metadata(tmp_path: Path, unit: str) -> None:
    finished(tmp_path / "out", unit)
    for name, columns in (("cells.parquet", SOURCE_COLUMNS), ("windows.parquet", WINDOW_COLUMNS)):
        schema = pq.read_schema(tmp_path / "out" / name)
        found = {field.name: field.metadata[b"unit"].decode() for field in schema}
        assert found == {column.name: column.unit.replace("length", unit) for column in columns}
        assert found["area"] == f"{unit}²"
    study = cd.open_study(tmp_path / "out")
    assert study.cells.attrs["units"]["perimeter"] == unit
    assert study.windows.attrs["units"]["frame"] == "frame"


def test_parts_come_in_the_order_of_cells_whatever_the_order_of_adding(tmp_path: Path) -> None:
    folder = StudyFolder.start(tmp_path / "out", run(), KIND)
    for cell in (10, 2, 0):
        add(folder, cell, status="ok")
    folder.finish([part_key(cell) for cell in (0, 2, 10)])
    study = cd.open_study(tmp_path / "out")
    assert study.cells["cell"].tolist() == [0, 2, 10]
    assert study.windows["cell"].tolist() == [0, 0, 2, 2, 10, 10]


def test_a_folder_with_something_else_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("years of work")
    for options in ({}, {"resume": True}, {"overwrite": True}):
        with pytest.raises(StudyError, match="not empty and holds no study"):
            StudyFolder.start(tmp_path, run(), KIND, **options)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.txt"]


def test_a_provenance_of_something_else_is_no_study(tmp_path: Path) -> None:
    (tmp_path / "provenance.json").write_text('{"made by": "another program"}')
    with pytest.raises(StudyError, match="holds no study"):
        StudyFolder.start(tmp_path, run(), KIND, overwrite=True)
    assert json.loads((tmp_path / "provenance.json").read_text()) == {"made by": "another program"}


@pytest.mark.parametrize("options", [{}, {"resume": True}, {"overwrite": True}])
@pytest.mark.parametrize(
    "damage", [lambda text: text[: len(text) // 2], lambda text: "", lambda text: "\0" * 9]
)
def test_a_study_with_a_damaged_provenance_is_left_and_told(
    tmp_path: Path, damage: Callable[[str], str], options: dict[str, bool]
) -> None:
    folder = StudyFolder.start(tmp_path / "out", run(), KIND)
    add(folder, 0, status="ok")
    folder.finish([part_key(0)])
    path = tmp_path / "out" / "provenance.json"
    path.write_text(damage(path.read_text()))
    before = sorted((tmp_path / "out").rglob("*"))
    with pytest.raises(StudyError, match=r"as its provenance\.json is damaged .*: pass another folder"):
        StudyFolder.start(tmp_path / "out", run(), KIND, **options)
    check_csv_room(tmp_path / "out", ["cells.parquet"])  # whose reason would be another one
    assert sorted((tmp_path / "out").rglob("*")) == before


def test_a_study_is_not_overwritten_unasked(tmp_path: Path) -> None:
    finished(tmp_path / "out")
    with pytest.raises(StudyError, match=r"--resume.*--overwrite"):
        StudyFolder.start(tmp_path / "out", run(), KIND)
    assert len(cd.open_study(tmp_path / "out").cells) == 2


def test_resume_names_what_differs_from_another_run(tmp_path: Path) -> None:
    finished(tmp_path / "out")
    with pytest.raises(StudyError, match=r"layers: 10 then, 5 now.*--overwrite"):
        StudyFolder.start(tmp_path / "out", run(layers=5), KIND, resume=True)
    assert len(cd.open_study(tmp_path / "out").cells) == 2


def test_resume_says_first_which_command_another_run_is_of() -> None:
    there = {"run": "shapes", "fingerprint": {"seed": 0, "packages": {"numpy": "1"}}}
    here = {"fingerprint": {"layers": 10, "packages": {"numpy": "2"}}}
    assert differences(there, here) == "that of cytodisk shapes, not of cytodisk map"


def test_resume_names_the_packages_that_differ_alone() -> None:
    there = {"fingerprint": {"packages": {"numpy": "1.26.4", "scipy": "1.11"}, "gone": 1}}
    here = {"fingerprint": {"packages": {"numpy": "2.1.0", "scipy": "1.11"}}}
    assert differences(there, here) == "numpy: 1.26.4 then, 2.1.0 now; gone: 1 then, None now"


def test_resume_says_that_an_earlier_version_made_other_maps(tmp_path: Path) -> None:
    finished(tmp_path / "out", method="newton", **EARLIER)
    with pytest.raises(
        StudyError, match=r"another mesh and relaxation\): pass --overwrite .*or another folder"
    ):
        StudyFolder.start(tmp_path / "out", run(method="newton"), KIND, resume=True)
    with pytest.raises(StudyError, match=r"newton then, newton-triangles now; .*another mesh and relaxation"):
        StudyFolder.start(tmp_path / "out", run(method="newton-triangles"), KIND, resume=True)
    with pytest.warns(EarlierVersionWarning):
        assert len(cd.open_study(tmp_path / "out").cells) == 2


def test_resume_by_another_method_names_both_and_the_way_on(tmp_path: Path) -> None:
    finished(tmp_path / "out", method="newton-triangles")
    words = r"method: newton-triangles then, newton now\): pass --method newton-triangles to go on"
    with pytest.raises(StudyError, match=words):
        StudyFolder.start(tmp_path / "out", run(method="newton"), KIND, resume=True)


def test_resume_keeps_complete_parts(tmp_path: Path) -> None:
    add(StudyFolder.start(tmp_path / "out", run(), KIND), 3, status="ok")
    again = StudyFolder.start(tmp_path / "out", run(), KIND, resume=True)
    again.expect([part_key(3), part_key(4)])
    assert (again.has(part_key(3)), again.has(part_key(4))) == (True, False)
    assert [row["cell"] for row in again.rows()] == [3]


def test_a_part_without_its_row_is_not_complete(tmp_path: Path) -> None:
    folder = StudyFolder.start(tmp_path / "out", run(), KIND)
    add(folder, 3, status="ok")
    next((tmp_path / "out").glob(".parts/*.json")).unlink()
    again = StudyFolder.start(tmp_path / "out", run(), KIND, resume=True)
    again.expect([part_key(3)])
    assert not again.has(part_key(3))


def test_arrays_of_parts_are_kept_until_the_run_ends(tmp_path: Path) -> None:
    folder = StudyFolder.start(tmp_path / "out", run(), KIND)
    values = np.random.default_rng(1000).normal(size=(2, 5))
    folder.add_array(part_key(0), "pieces", values)
    again = StudyFolder.start(tmp_path / "out", run(), KIND, resume=True)
    found = again.part_array(part_key(0), "pieces")
    assert found is not None
    np.testing.assert_array_equal(found, values)
    assert again.part_array(part_key(1), "pieces") is None
    add(again, 0, status="ok")
    again.finish([part_key(0)])
    assert not list((tmp_path / "out").rglob("*.npy"))


def test_overwrite_removes_the_study_and_nothing_else(tmp_path: Path) -> None:
    finished(tmp_path / "out")
    out = tmp_path / "out"
    names = ("figures/cell_00000.png", "report.html", "folder/a.csv", "folder/below/b.csv")
    (out / "folder" / "below").mkdir(parents=True)
    (out / "figures").mkdir()
    with writing_files(out, *names):
        for name in names:
            (out / name).write_text("there")
    ours = [out / name for name in (*names, "maps/cell_00000.npz")]
    theirs = [
        out / name for name in ("notes.txt", "figures/mine.png", "maps/mine.npz", ".mine", "features.csv")
    ]
    for path in theirs:
        path.write_text("there")
    folder = StudyFolder.start(out, run(layers=5), KIND, overwrite=True)
    assert folder.rows() == []
    assert [path.read_text() for path in theirs] == ["there"] * len(theirs)
    assert not any(path.exists() for path in ours)
    assert not (out / "folder").exists()
    assert not (out / "cells.parquet").exists()


def test_overwrite_removes_nothing_outside_the_folder(tmp_path: Path) -> None:
    out, outside = tmp_path / "out", tmp_path / "notes.txt"
    finished(out)
    outside.write_text("there")
    change(out, {"../notes.txt": "", "maps/../../notes.txt": "", str(outside): ""})
    StudyFolder.start(out, run(), KIND, overwrite=True)
    assert outside.read_text() == "there"


def change(out: Path, files: dict[str, str]) -> None:
    """Write names into a study's list of files."""
    told = out / "provenance.json"
    found = json.loads(told.read_text())
    told.write_text(json.dumps(found | {"files": found["files"] | files}))


@pytest.mark.parametrize("how", ["itself", "link to it", "another name", "folder", "by a link in its place"])
def test_overwrite_is_refused_where_an_input_would_be_removed(tmp_path: Path, how: str) -> None:
    out, masks = tmp_path / "out", tmp_path / "masks.tif"
    finished(out)
    result = out / "maps" / "cell_00000.npz"
    files = {}
    if how == "link to it":
        masks.symlink_to(result)
    elif how == "another name":
        masks.hardlink_to(result)
    elif how == "by a link in its place":
        masks.write_text("masks")
        result.unlink()
        result.symlink_to(masks)
    elif how == "folder":
        masks, files = result.parent, {"files": {result.name: "hash"}}
    else:
        masks = result
    here = run() | {"inputs": {"masks": {"path": str(masks)} | files}}
    before = everything(out)
    with pytest.raises(StudyError, match=r"among the results in .*which --overwrite removes: move it"):
        StudyFolder.start(out, here, KIND, overwrite=True)
    assert everything(out) == before


def everything(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("name", ["maps", "figures", "correlation/a~b"])
def test_overwrite_is_refused_where_a_folder_is_a_link(tmp_path: Path, name: str) -> None:
    out = tmp_path / "out"
    finished(out)
    (out / name).mkdir(parents=True, exist_ok=True)
    with writing_files(out, f"{name}/result.csv"):
        (out / name / "result.csv").write_text("there")
    (out / name).rename(tmp_path / "elsewhere")
    (out / name).symlink_to(tmp_path / "elsewhere")
    before = everything(out), everything(tmp_path / "elsewhere")
    with pytest.raises(StudyError, match="is a link, which --overwrite does not follow"):
        StudyFolder.start(out, run(), KIND, overwrite=True)
    assert (everything(out), everything(tmp_path / "elsewhere")) == before


@pytest.mark.parametrize("name", ["maps/cell_00007.npz", "extra.csv"])
@pytest.mark.parametrize("options", [{"resume": True}, {"overwrite": True}])
def test_what_the_run_may_write_must_not_be_someone_elses(
    tmp_path: Path, name: str, options: dict[str, bool]
) -> None:
    out = tmp_path / "out"
    finished(out)
    change(out, {})
    (out / name).write_text("mine")
    before = everything(out)
    with pytest.raises(StudyError, match=f"holds {name}, which its study did not write"):
        StudyFolder.start(out, run(), KIND, **options)
    assert everything(out) == before


def test_what_a_killed_run_had_begun_is_its_own(tmp_path: Path) -> None:
    """Its name is noted before the file is written, and so before the part is done."""
    out = tmp_path / "out"
    folder = StudyFolder.start(out, run(), KIND)
    folder.begin(part_key(3), [folder.map_path(part_key(3))])
    folder.map_path(part_key(3)).write_text("half a part")
    (out / ".parts" / "mine.txt").write_text("mine")
    StudyFolder.start(out, run(), KIND, resume=True)
    StudyFolder.start(out, run(layers=5), KIND, overwrite=True)
    assert not folder.map_path(part_key(3)).exists()
    assert not list(out.glob(".parts/0*"))
    assert (out / ".parts" / "mine.txt").read_text() == "mine"


def test_overwrite_removes_what_a_killed_run_left_in_a_folder_among_the_inputs(tmp_path: Path) -> None:
    """Else its parts, of other parameters, would count as done."""
    out = tmp_path / "out"
    add(StudyFolder.start(out, run(), KIND), 0, status="ok")
    (tmp_path / "a.tif").touch()
    here = run(layers=5) | {"inputs": {"masks": {"path": str(tmp_path), "files": {"a.tif": "hash"}}}}
    folder = StudyFolder.start(out, here, KIND, overwrite=True)
    assert not folder.has(part_key(0))
    assert (tmp_path / "a.tif").exists()


def test_overwrite_keeps_an_input_within_a_folder_of_results(tmp_path: Path) -> None:
    out = tmp_path / "out"
    finished(out)
    (out / "maps" / "a.tif").write_text("masks")
    here = run() | {"inputs": {"masks": {"path": str(out / "maps"), "files": {"a.tif": "hash"}}}}
    StudyFolder.start(out, here, KIND, overwrite=True)
    assert everything(out / "maps") == {"a.tif": b"masks"}


def test_the_provenance_names_all_that_a_run_writes(tmp_path: Path) -> None:
    folder = finished(tmp_path / "out")
    (folder.path / "figures").mkdir()
    with writing_files(folder.path, "figures/cell_00000.png", "figures/not_drawn.png"):
        (folder.path / "figures" / "cell_00000.png").write_bytes(b"")
    told = cd.open_study(folder.path).provenance["files"]
    assert {*told, "provenance.json"} == {*everything(folder.path)}
    assert len(told) == 5
    assert told["figures/cell_00000.png"] == "0 bytes, crc32 00000000"


def test_a_file_that_is_the_users_is_not_written_over(tmp_path: Path) -> None:
    folder = finished(tmp_path / "out")
    (folder.path / "report.html").write_text("mine")
    with pytest.raises(StudyError, match="is in the way, and was not written by this study"):  # noqa: SIM117
        with writing_files(folder.path, "report.html"):
            (folder.path / "report.html").write_text("ours")
    assert (folder.path / "report.html").read_text() == "mine"


@pytest.mark.parametrize("options", [{"resume": True}, {"overwrite": True}])
def test_a_study_of_the_version_before_is_left_alone_and_named(
    tmp_path: Path, options: dict[str, bool]
) -> None:
    """It had no list of its files, and other names of columns."""
    finished(tmp_path / "out")
    told = tmp_path / "out" / "provenance.json"
    old = {
        name: value for name, value in json.loads(told.read_text()).items() if name not in ("format", "files")
    }
    told.write_text(json.dumps(old | {"versions": {"cytodisk": "0.1.0"}}))
    assert StudyFolder.complete(tmp_path / "out", run(), KIND) is None
    with pytest.raises(StudyError, match=r"0\.1\.0.*another folder"):
        StudyFolder.start(tmp_path / "out", run(), KIND, **options)
    with pytest.raises(ReadError, match=r"0\.1\.0.*that version"):
        cd.open_study(tmp_path / "out")
    assert (tmp_path / "out" / "cells.parquet").exists()


def test_left_over_temporary_files_of_a_killed_run_go_and_other_files_stay(tmp_path: Path) -> None:
    StudyFolder.start(tmp_path / "out", run(), KIND)
    left_over = tmp_path / "out" / "maps" / temporary_name(".npz")
    theirs = [tmp_path / "out" / ".editor.tmp.txt", tmp_path / "out" / "mine" / ".a.1.tmp.txt"]
    theirs[1].parent.mkdir()
    for path in (left_over, *theirs):
        path.write_text("half")
    StudyFolder.start(tmp_path / "out", run(), KIND, resume=True)
    assert not left_over.exists()
    assert [path.read_text() for path in theirs] == ["half", "half"]


def test_a_file_is_no_output_folder(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("mine")
    with pytest.raises(StudyError, match="is a file: pass a folder"):
        StudyFolder.start(tmp_path / "out", run(), KIND, overwrite=True)
    with pytest.raises(StudyError, match="cannot be written: Not a directory"):
        StudyFolder.start(tmp_path / "out" / "below", run(), KIND)
    assert (tmp_path / "out").read_text() == "mine"


def test_open_study_says_why_not(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="nowhere does not exist"):
        cd.open_study(tmp_path / "nowhere")
    with pytest.raises(ReadError, match=r"no study.*provenance\.json"):
        cd.open_study(tmp_path)
    StudyFolder.start(tmp_path / "half", run(), KIND)
    with pytest.raises(ReadError, match=r"not complete.*--resume"):
        cd.open_study(tmp_path / "half")
    finished(tmp_path / "out")
    (tmp_path / "out" / "cells.parquet").write_bytes(b"PAR1 damaged")
    with pytest.raises(ReadError, match=r"is not a table that cytodisk wrote|does not exist"):
        cd.open_study(tmp_path / "out")
    (tmp_path / "out" / "cells.parquet").unlink()
    with pytest.raises(ReadError, match=r"is not a table that cytodisk wrote|does not exist"):
        cd.open_study(tmp_path / "out")
    (tmp_path / "out" / "provenance.json").write_bytes(b"\xff\xfe{")
    with pytest.raises(ReadError, match="is no study"):
        cd.open_study(tmp_path / "out")


def test_a_map_that_is_not_there_has_a_reason(tmp_path: Path) -> None:
    finished(tmp_path / "out")
    study = cd.open_study(tmp_path / "out")
    with pytest.raises(ReadError, match=r"cell 1 of .* has no map: empty"):
        study.map(1)


def test_a_cell_that_is_not_there(tmp_path: Path) -> None:
    finished(tmp_path / "out")
    study = cd.open_study(tmp_path / "out")
    with pytest.raises(ReadError, match=r"has no cell 9: it has the cells 0 to 1"):
        study.map(9)


def test_maps_of_an_earlier_version_are_told(tmp_path: Path) -> None:
    cd.open_study(finished(tmp_path / "now").path)  # not a word on maps of today
    folder = finished(tmp_path / "out", **EARLIER)
    path = folder.path / "provenance.json"
    found = json.loads(path.read_text())
    path.write_text(json.dumps(found | {"versions": {"cytodisk": "0.1.0"}}))
    words = (
        r"out: Maps by cytodisk 0\.1\.0: their windows lie at other places than those of this version\. Do"
    )
    with pytest.warns(EarlierVersionWarning, match=words) as told:
        assert len(cd.open_study(folder.path).cells) == 2
    assert len(told) == 1
