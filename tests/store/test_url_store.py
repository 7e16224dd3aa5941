import json
from pathlib import Path

import pytest

from cytodisk.errors import StudyError
from cytodisk.store.url_store import UrlStore, is_url


def test_a_folder_arrives_whole_in_the_place_of_another(tmp_path: Path) -> None:
    store = UrlStore(f"file://{tmp_path}/there/")
    for names in (["a.txt", "maps/old.txt"], ["a.txt", "maps/new.txt"]):
        for name in names:
            file = tmp_path / "here" / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(f"{names}")
        (tmp_path / "here" / "provenance.json").write_text(
            json.dumps({"fingerprint": {}, "files": dict.fromkeys(names, "")})
        )
        (tmp_path / "there" / "inputs" / "one").mkdir(parents=True, exist_ok=True)
        (tmp_path / "there" / "inputs" / "one" / "mine.txt").write_text("mine")
        store.put_folder(tmp_path / "here", "inputs/one")
        assert not (tmp_path / "here").exists()
    assert store.read_text("inputs/one/a.txt") == "['a.txt', 'maps/new.txt']"
    assert list(store.names("inputs/one/maps")) == ["new.txt"]
    with store.open("inputs/one/maps/new.txt") as file:
        assert file.read() == b"['a.txt', 'maps/new.txt']"
    names = ["inputs/one/a.txt", "inputs/one/maps/new.txt"]
    store.remove(names)
    store.remove(names)
    assert sorted(store.names("inputs/one")) == ["maps", "mine.txt", "provenance.json"]
    assert store.read_text("inputs/one/a.txt") is None


def test_a_place_that_cannot_be_used_is_named(tmp_path: Path) -> None:
    assert is_url("s3://bucket/batch")
    assert not is_url("C:/batch")
    with pytest.raises(StudyError, match="nowhere://batch"):
        UrlStore("nowhere://batch")
    with pytest.raises(StudyError, match="would be gone with the process"):
        UrlStore("memory://batch")
    (tmp_path / "file").touch()
    with pytest.raises(StudyError, match=r"file/rows/a.json cannot be written"):
        UrlStore(f"file://{tmp_path}/file").write_text("rows/a.json", "")
