"""Names of any length and kind: they make files, or an error that names the argument."""

import os
from pathlib import Path

import pytest

from cytodisk.checks import is_path
from cytodisk.errors import ParameterError
from cytodisk.files import make_folder, replacing
from cytodisk.store.correlation_store import correlation_path
from cytodisk.store.provenance_file import read_provenance, write_json

NAMES = (
    "x" * 3000,
    "x" * 2999 + "y",
    "a/b\\c",
    "a\nb\x07\x1b[31mc",
    "..",
    "~",
    "ä" * 300,
    "\0",
    "CON",
    "\udcff",
)


def test_names_of_channels_of_any_kind_make_folders_of_their_own(tmp_path: Path) -> None:
    folders = {correlation_path(tmp_path, name, "velocity", NAMES[0]) for name in NAMES}
    assert len(folders) == len(NAMES)
    for folder in folders:
        assert folder.parent == tmp_path / "correlation"
        assert len(folder.name) < 255
        folder.mkdir(parents=True)


def test_a_folder_may_be_thousands_deep(tmp_path: Path) -> None:
    folder = tmp_path.joinpath(*["a"] * 1500)
    make_folder(folder)
    make_folder(folder)
    with replacing(folder / "file.txt") as temporary:
        temporary.write_text("there")
    assert (folder / "file.txt").read_text() == "there"
    for place in (folder, *folder.parents[:1499]):  # what removes folders calls itself for each
        (place / "file.txt").unlink(missing_ok=True)
        place.rmdir()


def test_a_name_as_long_as_the_system_has_them_is_written(tmp_path: Path) -> None:
    name = "n" * 251 + ".txt"
    with replacing(tmp_path / name) as temporary:
        temporary.write_text("there")
    assert [path.name for path in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize("name", [b"b\xff.tif", b"\xe4rger/a.tif", b"a\x80"])
def test_a_path_that_is_not_in_utf_8_is_refused_by_the_name_of_the_argument(name: bytes) -> None:
    with pytest.raises(ParameterError, match=r"masks '.*\\udc.*' is not in UTF-8: rename") as told:
        is_path("masks", os.fsdecode(name))
    assert str(told.value).isascii()
    with pytest.raises(ParameterError, match="null character"):
        is_path("masks", "a\0b")


def test_provenance_holds_a_name_that_is_not_in_utf_8(tmp_path: Path) -> None:
    name = os.fsdecode(b"b\xff.tif")
    write_json(tmp_path / "provenance.json", {"fingerprint": {}, "inputs": {"masks": {"path": name}}})
    found = read_provenance(tmp_path)
    assert found is not None
    assert found["inputs"]["masks"]["path"] == name
