"""The batch file: what it means, and what is said where it cannot be used."""

import os
import sys
from pathlib import Path

import pytest

from cytodisk.errors import ParameterError
from cytodisk.runs.batch.batch_file import Batch, read_batch
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.movie.movie_parameters import MovieParameters

LABELS = "[[inputs]]\nmasks = 'labels'\nkind = 'map'\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Mask files with the images that they belong to; nothing here looks into them."""
    for condition in ("control", "drug"):
        (tmp_path / condition).mkdir()
        for number in (1, 2, 10):
            (tmp_path / condition / f"cell{number}_masks.tif").touch()
            (tmp_path / condition / f"cell{number}.ome.tif").touch()
    (tmp_path / "labels").mkdir()
    return tmp_path


def batch_of(folder: Path, text: str) -> Batch:
    (folder / "study.toml").write_text(text, encoding="utf-8")
    return read_batch(folder / "study.toml")


def faults_of(folder: Path, text: str) -> list[str]:
    with pytest.raises(ParameterError) as caught:
        batch_of(folder, text)
    first, *faults = str(caught.value).split("\n  ")
    assert first == f"batch file {folder / 'study.toml'} cannot be used:"
    return faults


def test_a_pattern_gives_an_input_for_each_file_in_natural_order(folder: Path) -> None:
    batch = batch_of(
        folder,
        """
        [study]
        columns = ["dose"]
        [parameters]
        layers = 7
        [[inputs]]
        masks = "*/*_masks.tif"
        signal = "{folder}/{image}.ome.tif"
        condition = "{parent}"
        dose = 0.5
        pixel_size_um = 0.16
        parameters = {sectors = 12}
        """,
    )
    assert [item.name for item in batch.inputs] == [
        f"{condition}-cell{number}_masks" for condition in ("control", "drug") for number in (1, 2, 10)
    ]
    first, last = batch.inputs[0], batch.inputs[-1]
    assert batch.columns == ("condition", "experiment", "dose")
    assert first.columns == ("control", None, 0.5)
    assert last.columns == ("drug", None, 0.5)
    assert last.masks == folder / "drug" / "cell10_masks.tif"
    assert last.signal == folder / "drug" / "cell10.ome.tif"
    assert last.parameters == MovieParameters(layers=7, sectors=12, pixel_size_um=0.16)


def test_masks_beside_the_batch_file_are_in_its_folder(folder: Path) -> None:
    for name in ("a_masks.tif", "a.tif"):
        (folder / name).touch()
    batch = batch_of(folder, '[[inputs]]\nmasks = "a_masks.tif"\nsignal = "{folder}/{image}.tif"\n')
    assert (batch.inputs[0].name, batch.inputs[0].signal) == ("a_masks", folder / "a.tif")


def test_images_and_movies_in_one_file_take_the_parameters_that_they_know(folder: Path) -> None:
    batch = batch_of(
        folder,
        """
        [parameters]
        layers = 4
        tracker = "demons"
        [[inputs]]
        masks = "control/cell1_masks.tif"
        [[inputs]]
        masks = "labels"
        kind = "map"
        signal = "_img"
        name = "all-{name}"
        """,
    )
    movie, image = batch.inputs
    assert movie.parameters == MovieParameters(layers=4, tracker="demons")
    assert image.parameters == MapParameters(layers=4)
    assert type(image.parameters) is MapParameters
    assert (image.name, image.signal) == ("all-labels", Path("_img"))


def test_a_table_gives_the_rows_of_a_spreadsheet(folder: Path) -> None:
    lines = [
        "masks;signal;name;condition;experiment;plate;dose;channels;frame_interval_s",
        "control/cell1_masks.tif;control/cell1.ome.tif;a;1_2;1;007;1;Rac1, RhoA;5",
        ";;;;;;;;",
        "drug/cell2_masks.tif;;b;3;2;12;2.5e-1;;",
    ]
    (folder / "inputs.csv").write_text("\ufeff" + "\n".join(lines), encoding="utf-8")
    batch = batch_of(folder, '[study]\ntable = "inputs.csv"\ncolumns = ["plate", "dose"]')
    first, second = batch.inputs
    assert first.columns == ("1_2", "1", "007", 1.0)
    assert second.columns == ("3", "2", "12", 0.25)
    assert first.parameters == MovieParameters(channels=("Rac1", "RhoA"), frame_interval_s=5.0)
    assert second.signal is None


def test_all_faults_are_said_at_once_each_with_its_place(folder: Path) -> None:
    faults = faults_of(
        folder,
        """
[study]
kind = "movie"
[[inputs]]
masks = "control/*_masks.tif"
conditon = "control"
signal = "{foldr}/{image}.tif"
[[inputs]]
masks = "nothing*.tif"
parameters = {layer = 3}
[[inputs]]
masks = "drug/cell2_masks.tif"
name = "a b"
pixel_size_um = -1
[[inputs]]
masks = "drug/cell1_masks.tif"
signal = "drug/missing.tif"
kind = "film"
[[inputs]]
masks = "drug/cell1_masks.tif"
signal = "drug/missing.tif"
""",
    )
    assert faults == [
        "[[inputs]] 1 (line 4): unknown column 'conditon': did you mean 'condition'?",
        "[[inputs]] 1 (line 4): unknown field in signal 'foldr': did you mean 'folder'?",
        "[[inputs]] 2 (line 8): unknown parameter 'layer': did you mean 'layers'?",
        f"[[inputs]] 2 (line 8): masks 'nothing*.tif' match nothing in {folder}",
        "[[inputs]] 3 (line 11): pixel_size_um must be a number from 0.000001 to 1000000, got -1",
        "[[inputs]] 3 (line 11), cell2_masks.tif: name 'a b' cannot be that of a folder: use letters, "
        "digits, '_', '-' and '.' (at most 120 bytes)",
        "[[inputs]] 4 (line 15): kind must be movie or map, got 'film'",
        f"[[inputs]] 5 (line 19), cell1_masks.tif: signal {folder / 'drug' / 'missing.tif'} does not exist",
    ]


def test_one_name_or_one_mask_file_stands_for_one_input(folder: Path) -> None:
    faults = faults_of(
        folder,
        """
        [[inputs]]
        masks = "*/cell1_masks.tif"
        name = "{stem}"
        [[inputs]]
        masks = "labels/../control/cell1_masks.tif"
        name = "another"
        """,
    )
    assert faults == [
        "[[inputs]] 1 (line 2), cell1_masks.tif: the name 'cell1_masks' is taken by [[inputs]] 1 (line 2), "
        'cell1_masks.tif: give a name, as name = "{folder}-{stem}"',
        f"[[inputs]] 2 (line 5), cell1_masks.tif: the masks {folder}/labels/../control/cell1_masks.tif are "
        "an input already, in [[inputs]] 1 (line 2)",
    ]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[study]\nkinds = 'map'", "[study]: unknown name 'kinds': did you mean 'kind'?"),
        ("[[inputs]]\nmasks='*/cell1_*'\nsignal='labels/../{folder}/{name}'", "is the mask file itself"),
        ("[study]\ncolumns = ['mean']", "[study]: column 'mean' is one that the tables have anyway"),
        (f"{LABELS}replicate = 1", "column 'replicate' is called experiment: rename it"),
        ("[study]\ncolumns = ['replicate']", "[study]: column 'replicate' is called experiment: rename it"),
        ("[study]\ncolumns = ['a', 'a']", "[study]: column 'a' stands twice"),
        ("[study]\ncolumns = 'a'", "[study]: columns must be a list of names, got 'a'"),
        ("[parameters]\nlayer = 3", "[parameters]: unknown parameter 'layer': did you mean 'layers'?"),
        ("[study]\nkind = ['map']", "[study]: kind must be movie or map, got ['map']"),
        (f"{LABELS}condition = '{{stem:5}}'", "unknown field in condition 'stem:5'"),
        ("[[input]]\nmasks = 'a.tif'", "top: unknown table 'input': did you mean 'inputs'?"),
        ("[inputs]\nmasks = 'a.tif'", "[[inputs]]: must be tables"),
        ("[[inputs]]\nname = 'a'", "[[inputs]] 1 (line 1): masks must be a path or a pattern"),
        (f"{LABELS}frame_interval_s = 5", "frame_interval_s is for movies"),
        (f"{LABELS}condition = '{{'", "condition '{' is no template"),
        (f"{LABELS}condition = [1]", "condition must be a text or a number"),
    ],
)
def test_a_fault_names_what_came_and_what_to_do(folder: Path, text: str, words: str) -> None:
    assert [fault for fault in faults_of(folder, text) if words in fault]


def test_of_many_faults_the_first_are_shown(folder: Path) -> None:
    faults = faults_of(folder, "".join(f"[[inputs]]\nmasks = 'no{number}'\n" for number in range(30)))
    assert len(faults) == 21
    assert faults[-1] == "… and 10 more"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[study", "is no TOML"),
        ("[study]", "has no inputs"),
        ("[study]\ntable = 'none.csv'", r"table of inputs .*none\.csv cannot be read: No such"),
    ],
)
def test_a_file_that_is_none_is_refused(folder: Path, text: str, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        batch_of(folder, text)


@pytest.mark.parametrize(
    ("table", "fault"),
    [
        (
            "masks,name\ncontrol/cell1_masks.tif,a,b\n",
            "2: has more fields than the 2 of the first line: put quotes around a field with a comma, and "
            "write numbers with a point (0.2)",
        ),
        ("\nmasks,name, name\ncontrol/cell1_masks.tif,a,b\n", "2: column 'name' stands twice"),
        (
            ",masks\n0,control/cell1_masks.tif\n",
            "2: '0' stands in a column without a name: name or remove it",
        ),
    ],
)
def test_a_table_with_fields_of_no_column_is_refused(folder: Path, table: str, fault: str) -> None:
    (folder / "inputs.csv").write_text(table, encoding="utf-8")
    assert faults_of(folder, '[study]\ntable = "inputs.csv"') == [f"inputs.csv line {fault}"]


def test_a_field_of_a_table_may_have_any_sign(folder: Path) -> None:
    table = '\n\nmasks;condition\n\ncontrol/cell1_masks.tif;"a\nb"\ncontrol/cell2_masks.tif;c\u2028d\n'
    (folder / "inputs.csv").write_text(table, encoding="utf-8-sig")
    inputs = batch_of(folder, '[study]\ntable = "inputs.csv"').inputs
    assert [item.columns[0] for item in inputs] == ["a\nb", "c\u2028d"]


@pytest.mark.skipif(sys.platform != "linux", reason="only there names of files have any bytes")
def test_names_that_no_table_or_folder_can_hold_are_faults(folder: Path) -> None:
    Path(os.fsdecode(os.fsencode(folder / "drug") + b"/m\xe9.tif")).touch()
    (folder / "drug" / f"{'日' * 60}.tif").touch()
    (not_text, long) = faults_of(folder, '[[inputs]]\nmasks = "drug/[m日]*.tif"')
    assert not_text.endswith("m\\udce9.tif' is not in UTF-8: rename the file")
    assert long.endswith("(at most 120 bytes)")
    (missing,) = faults_of(folder, f'[[inputs]]\nmasks = "{300 * "m"}.tif"')
    assert "match nothing" in missing


def test_the_example_of_the_documentation_is_a_batch_file(tmp_path: Path) -> None:
    for place in ("control/day_1", "drug/day_1", "drug/day_2"):
        (tmp_path / place).mkdir(parents=True)
        (tmp_path / place / "a_masks.tif").touch()
        (tmp_path / place / "a.ome.tif").touch()
    example = Path(__file__).parents[2] / "docs" / "source" / "getting_started" / "study.toml"
    batch = batch_of(tmp_path, example.read_text(encoding="utf-8"))
    names = [item.name for item in batch.inputs]
    assert names == ["control-day_1-a_masks", "drug-day_1-a_masks", "drug-day_2-a_masks"]
    assert batch.inputs[0].columns == ("control", "day_1", None)
    assert [item.columns for item in batch.inputs[1:]] == [("drug", f"day_{k}", 50) for k in (1, 2)]


@pytest.mark.parametrize(
    ("of_all", "own"), [("layers = 4", "depth_um = 1.5"), ("depth_um = 1.5", "layers = 4")]
)
def test_a_row_overrules_what_excludes_its_own_parameter(folder: Path, of_all: str, own: str) -> None:
    text = f"[parameters]\n{of_all}\n[[inputs]]\nmasks = 'drug/cell1_masks.tif'\nparameters = {{{own}}}"
    found = batch_of(folder, text).inputs[0].parameters
    assert isinstance(found, MovieParameters)
    assert (found.layers, found.depth_um) == ((10, (1.5,)) if "depth" in own else (4, None))


def test_of_both_in_the_file_the_depth_counts_as_in_a_studys_parameters(folder: Path) -> None:
    text = "[parameters]\nlayers = 4\ndepth_um = 1.5\n[[inputs]]\nmasks = 'drug/cell1_masks.tif'"
    found = batch_of(folder, text).inputs[0].parameters
    assert isinstance(found, MovieParameters)
    assert (found.layers, found.depth_um) == (10, (1.5,))


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (("masks;pixel_size_um", "a.tif;0,2"), r"pixel_size_um must be .*got '0,2': write 0\.2"),
        (("masks,pixel_size_um", 'a.tif,"0,2"'), r"pixel_size_um must be .*got '0,2': write 0\.2"),
        (("masks,pixel_size_um", "a.tif,0,2"), r"more fields than the 2 of the first line.*point \(0\.2\)"),
        (("masks;dose", "a.tif;1,5", "b.tif;2"), r"dose '1,5': write 1\.5"),
        (("masks\tdose", "a.tif\t1", "b.tif\t2,5"), r"dose '2,5': write 2\.5"),
    ],
)
def test_a_comma_in_a_number_of_a_table_is_named(tmp_path: Path, lines: tuple[str, ...], words: str) -> None:
    for name in ("a.tif", "b.tif"):
        (tmp_path / name).touch()
    (tmp_path / "table.csv").write_text("\n".join(lines))
    (tmp_path / "batch.toml").write_text('[study]\nkind = "map"\ntable = "table.csv"\ncolumns = ["dose"]\n')
    with pytest.raises(ParameterError, match=words):
        read_batch(tmp_path / "batch.toml")


def test_a_column_of_words_may_have_commas(tmp_path: Path) -> None:
    (tmp_path / "a.tif").touch()
    (tmp_path / "table.csv").write_text("masks;dose\na.tif;1,5 and more\n")
    (tmp_path / "batch.toml").write_text('[study]\nkind = "map"\ntable = "table.csv"\ncolumns = ["dose"]\n')
    assert read_batch(tmp_path / "batch.toml").inputs[0].columns[-1] == "1,5 and more"


@pytest.mark.parametrize("number", ["9" * 5000, "1" * 200 + ".5", "1e" + "9" * 5000])
def test_a_number_that_no_table_holds_stays_a_text(folder: Path, number: str) -> None:
    (folder / "inputs.csv").write_text(f"masks,mouse\nlabels,{number}\n")
    (folder / "batch.toml").write_text("[study]\ntable = 'inputs.csv'\ncolumns = ['mouse']\nkind = 'map'\n")
    [item] = read_batch(folder / "batch.toml").inputs
    assert item.columns[-1] == number
