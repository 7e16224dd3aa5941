"""A table of groups: which cells its rows are about, and what is said where it cannot be used."""

import csv
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cytodisk.errors import ParameterError, ReadError
from cytodisk.runs.groups.groups import Groups
from cytodisk.runs.groups.groups_file import read_groups

Write = Callable[[str], Groups]


@pytest.fixture
def table(tmp_path: Path) -> Write:
    def write(text: str) -> Groups:
        (tmp_path / "groups.csv").write_text(text, encoding="utf-8")
        return read_groups(tmp_path / "groups.csv")

    return write


def faults_of(work: Callable[[], object]) -> list[str]:
    with pytest.raises(ParameterError) as caught:
        work()
    first, *faults = str(caught.value).split("\n  ")
    assert first.startswith("table of groups ")
    assert first.endswith("groups.csv cannot be used:")
    return faults


CELLS = pd.DataFrame(
    {
        "cell": range(5),
        "source": ["a_masks.tif"] * 3 + ["b_masks.tif"] * 2,
        "label": [1, 2, 7, 1, 2],
        "frame": [0] * 5,
    }
)


@pytest.mark.parametrize("name", ["a_masks.tif", "a_masks", "a", "data/a_masks.tif", "data\\a", "./a"])
def test_a_file_is_meant_by_its_name_its_path_or_the_name_of_its_image(table: Write, name: str) -> None:
    groups = table(f"file,condition\n{name},control\nb_masks.tif,drug\n")
    assert groups.of(CELLS)["condition"].tolist() == ["control"] * 3 + ["drug"] * 2


def test_cells_of_a_file_are_meant_by_their_label(table: Write) -> None:
    groups = table("file,cell,condition\na,1,control\na,2,drug\na,7,drug\nb,1,control\nb,2.0,drug\n")
    assert groups.of(CELLS)["condition"].tolist() == ["control", "drug", "drug", "control", "drug"]


def test_masks_of_a_stack_are_meant_by_their_frame(table: Write) -> None:
    stack = pd.DataFrame({"source": ["s.tif"] * 3, "label": [1, 255, 1], "frame": [0, 1, 2]})
    groups = table("frame,condition,experiment\n2,drug,d1\n0,control,d1\n1,control,d2\n")
    assert groups.of(stack)["condition"].tolist() == ["control", "control", "drug"]
    assert groups.of(stack)["experiment"].tolist() == ["d1", "d2", "d1"]


def test_an_empty_key_stands_for_all(table: Write) -> None:
    groups = table("file,cell,condition\na,,control\nb,1,drug\nb,2,other\n")
    assert groups.of(CELLS)["condition"].tolist() == ["control"] * 3 + ["drug", "other"]


def test_rows_keep_the_index_of_the_cells(table: Write) -> None:
    groups = table("file,condition\na,control\nb,drug\n")
    shuffled = CELLS.iloc[[4, 0]]
    assert groups.of(pd.concat([shuffled, CELLS.iloc[[1]]])).index.tolist() == [4, 0, 1]


def test_of_a_batch_the_name_of_an_input_means_all_its_files(table: Write) -> None:
    cells = CELLS.assign(input=["day1"] * 3 + ["day2"] * 2)
    groups = table("file,experiment\nday1,one\nday2,two\n")
    assert groups.of(cells)["experiment"].tolist() == ["one"] * 3 + ["two"] * 2


def test_paths_tell_files_of_one_name_apart(table: Write, tmp_path: Path) -> None:
    cells = pd.DataFrame(
        {"input": ["x", "y"], "source": ["a.tif", "a.tif"], "label": [1, 1], "frame": [0, 0]}
    )
    cells["path"] = [str(tmp_path / day / "a.tif") for day in ("day1", "day2")]
    groups = table(f"file,condition\nday2/a.tif,drug\n{tmp_path}/day1/a.tif,control\n")
    assert groups.of(cells)["condition"].tolist() == ["control", "drug"]
    (fault, _) = faults_of(lambda: table("file,condition\na.tif,drug\nday3/a.tif,drug\n").of(cells))
    assert fault == "groups.csv line 2: file 'a.tif' can be x, y: write 'x' if that is meant"


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("before", ["\ufeff", "", "sep={}\r\n", "\n{}{}\n"])
def test_what_spreadsheets_write_is_read(table: Write, separator: str, before: str) -> None:
    lines = [
        "File; Condition ;experiment;dose;plate;note;",
        'a; control;1;0.5;007;"x, \n y; z";',
        ";;;;;;",
        "b;drug ;2;1;08;;",
    ]
    text = (
        "\r\n".join(lines).replace('"x, \n y; z"', "Q").replace(";", separator).replace("Q", '"x, \n y; z"')
    )
    groups = table(before.replace("{}", separator) + text)
    found = groups.of(CELLS)
    assert found.iloc[0].tolist() == ["control", "1", 0.5, "007", "x, \n y; z"]
    assert found.iloc[4].tolist() == ["drug", "2", 1.0, "08", None]
    assert groups.match(CELLS).warnings == ()


def test_columns_have_types(table: Write) -> None:
    groups = table("file,condition,experiment,n,x,t\na,1,2,3,4.5,6\nb,1,2,,,x\n")
    assert [str(column.kind) for column in groups.columns] == [
        "string",
        "string",
        "int64",
        "double",
        "string",
    ]
    found = groups.of(CELLS)
    assert found.iloc[0].tolist() == ["1", "2", 3, 4.5, "6"]
    assert found[["n", "x"]].iloc[4].isna().all()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("image,condition\na,x", "line 1: has no column that says which cells: name one file, cell or frame"),
        ("source,condition\na,x", "line 1: column 'source' is called file in a table of groups: rename it"),
        ("label,condition\na,x", "line 1: column 'label' is called cell in a table of groups: rename it"),
        ("file,replicate\na,x", "line 1: column 'replicate' is called experiment: rename it"),
        ("file,area\na,x", "line 1: column 'area' is one that the tables have anyway"),
        ("file,cell\na,1", "line 1: says nothing of the cells: add a column condition"),
        ("file,condition", "has no rows below the names"),
        ("", "has no rows"),
        ("file,File,condition\na,a,x", "line 1: column 'file' stands twice, in other cases: keep one"),
        ("file,file,condition\na,a,x", "line 1: column 'file' stands twice"),
        ("file,cell,condition\na,one,x", "cell must be a whole number (label of the cell in its file), got"),
        ("frame,condition\n-1,x", "line 2: frame must be a whole number (number of the frame, from 0), got"),
        ("file,condition\n\na,\n", "line 3: the condition is empty: fill it in, or take"),
        ("file,condition\n,x\n", "line 2: does not say which cells: fill in file"),
        ("file;dose\na;0,5\nb;1\n", "line 2: dose '0,5': write 0.5"),
        ("file,dose\na,0,5\n", "line 2: has more fields than the 2 of the first line"),
        ('file,condition\na,"x', "is no CSV"),
        ("file,condition\nc,x", "line 2: no file 'c': there is a_masks.tif, b_masks.tif"),
        ("file,condition\na_mask.tif,x", "line 2: no file 'a_mask.tif': did you mean 'a_masks.tif'?"),
        ("file,cell,condition\na,9,x", "line 2: there is no cell 9 of a_masks.tif: labels of cells are 1–2"),
        ("file,frame,condition\na,3,x", "line 2: there is no frame 3 of a_masks.tif: frames are 0"),
        ("cell,condition\n4,x", "line 2: there is no cell 4: labels of cells are 1–2, 7"),
        ("file,condition\na,x\na_masks,x", "line 3: is about the same cells as line 2: keep one"),
        ("file,cell,condition\na,,x\na,7,y", "line 3: label 7 of a_masks.tif is in line 2 too"),
    ],
)  # fmt: skip
def test_a_fault_names_the_line_and_what_to_do(table: Write, text: str, words: str) -> None:
    (fault, *more) = faults_of(lambda: table(text).of(CELLS))
    assert words in fault
    assert not more


def test_all_faults_are_said_at_once_and_of_many_the_first(table: Write) -> None:
    faults = faults_of(lambda: table("file,condition\n" + "".join(f"f{k},x\n" for k in range(30))).of(CELLS))
    assert len(faults) == 21
    assert faults[-1] == "… and 10 more"


def test_cells_without_a_row_are_counted_and_named(table: Write) -> None:
    found = table("file,cell,condition\na,1,x\n").match(CELLS)
    assert found.values["condition"].tolist() == ["x", None, None, None, None]
    (words,) = found.warnings
    assert words == (
        "groups.csv: 4 of 5 cells are in no row, so they have no condition: label 2 of a_masks.tif, "
        "label 7 of a_masks.tif, label 1 of b_masks.tif, label 2 of b_masks.tif"
    )


def test_images_without_cells_are_no_fault_and_no_missing_cells(table: Write) -> None:
    empty = CELLS.assign(label=[1, 2, 7, 0, 0])
    found = table("file,cell,condition\na,,x\nb,1,x\n").match(empty)
    assert found.values["condition"].tolist() == ["x"] * 3 + [None] * 2
    assert found.warnings == ("groups.csv line 3: the image has no usable masks",)


def test_names_that_differ_in_case_or_spaces_are_named(table: Write) -> None:
    groups = table("file,cell,condition,experiment\na,,Drug A,d 1\nb,1,drug a,d 1\nb,2,druga,D1\n")
    first, second = groups.match(CELLS).warnings
    assert first.startswith(
        "groups.csv: conditions 'Drug A', 'drug a' and 'druga' differ only in case or spaces"
    )
    assert second.startswith("groups.csv: experiments 'd 1' and 'D1' differ only in case")


def test_rows_of_files_of_other_runs_are_told_and_are_no_fault(table: Write, tmp_path: Path) -> None:
    (tmp_path / "day2").mkdir()
    for name in ("c_masks.tif", "day2/a_masks.tif"):
        (tmp_path / name).touch()
    cells = CELLS.assign(path=[str(tmp_path / source) for source in CELLS["source"]])
    found = table("file,condition\na,x\nb,x\nc,y\nday2/a_masks.tif,y\n").match(cells)
    assert found.values["condition"].tolist() == ["x"] * 5
    (words,) = found.warnings
    assert words == "groups.csv: 2 rows are about files that are not of this run: c, day2/a_masks.tif"
    (fault,) = faults_of(lambda: table("file,condition\nc,y\n").of(cells))
    assert fault == "groups.csv: no row is about these masks, all are about other files: c"
    (fault,) = faults_of(lambda: table("file,condition\nd,y\n").of(cells))
    assert "no file 'd'" in fault


def test_what_may_be_a_slip_is_told(table: Write) -> None:
    first, second = table("file,conditon,experiment\na,x,d1\nb,y,\n").match(CELLS).warnings
    assert first == "groups.csv: column 'conditon' is taken for one of your own: did you mean condition?"
    assert second.startswith("groups.csv: 1 row has no experiment (line 3), without which")
    assert not table("file,condition,experimenter\na,x,Ann\nb,y,Ben\n").told[1:]


def test_a_name_may_be_composed_of_letter_and_accent(table: Write) -> None:
    cells = pd.DataFrame({"source": ["u\u0308_masks.tif"], "label": [1], "frame": [0]})
    assert table("file,condition\n\u00fc,\u00a0x \n").of(cells)["condition"].tolist() == ["x"]


def test_what_was_found_is_said_in_words(table: Write) -> None:
    text = "file,condition,experiment,dose\na,control,d1,1\nb,drug,d1,2\n"
    assert table(text).match(CELLS).words == (
        "by file; conditions: control (3 cells of 1 experiment), drug (2 cells of 1 experiment); columns dose"
    )
    assert table("file,experiment\na,d1\nb,d2\n").match(CELLS).words == (
        "by file; no column condition; 5 cells of 2 experiments"
    )
    assert table("cell,condition\n7,x\n").match(CELLS).words == (
        "by cell; conditions: x (1 cell); no column experiment"
    )


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "cannot be read: No such file"),
        (b"PK\x03\x04\xff\xff", "it is an Excel workbook: save it as CSV"),
        ("file,condition\nä,x".encode("utf-16"), "it is not in UTF-8: save it as CSV"),
        ("file,condition\nä,x".encode("cp1252"), "it is not in UTF-8: save it as CSV"),
    ],
)
def test_a_file_that_is_no_text_is_refused(tmp_path: Path, content: bytes | None, words: str) -> None:
    if content is not None:
        (tmp_path / "groups.csv").write_bytes(content)
    with pytest.raises(ReadError, match=words):
        read_groups(tmp_path / "groups.csv")


@given(
    st.lists(st.sampled_from(("file", "cell", "frame", "condition", "experiment", "dose", "")), max_size=5),
    st.lists(
        st.lists(st.sampled_from(("a", "b", "1", "7", "0", "x", "X ", "1,5", "nan", "-1", "")), max_size=5)
    ),
    st.sampled_from((",", ";", "\t")),
)
@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_table_is_read_or_refused_with_words(
    tmp_path: Path, names: list[str], rows: list[list[str]], separator: str
) -> None:
    with (tmp_path / "groups.csv").open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, delimiter=separator).writerows([names, *rows])
    said = ""
    try:
        values = read_groups(tmp_path / "groups.csv").of(CELLS)
    except ParameterError as error:
        said, values = str(error), CELLS[[]]
    assert said == "" or "groups.csv cannot be used:\n  groups.csv" in said
    assert values.index.equals(CELLS.index)
    assert not {"file", "cell", "frame"} & {*values}


@pytest.mark.slow
def test_a_million_rows_take_seconds_and_no_loop(table: Write) -> None:
    number = 1_000_000
    cells = pd.DataFrame(
        {"source": "a.tif", "label": range(1, number + 1), "frame": 0, "cell": range(number)}
    )
    rows = "".join(f"{k},{'drug' if k % 3 else 'control'}\n" for k in range(number, 0, -1))
    found = table("cell,condition\n" + rows).of(cells)
    assert (found["condition"] == "control").sum() == number // 3
