"""A finished study moves to its place, and what a user keeps there stays, whatever happens."""

import os
import shutil
from pathlib import Path

import pytest

from cytodisk.errors import StudyError
from cytodisk.store.provenance_file import read_provenance, write_json
from cytodisk.store.targets import FolderStore


@pytest.fixture
def new(tmp_path: Path) -> Path:
    """A study that another one is to be replaced by."""
    return study(tmp_path / "new", "a.txt", "maps/new.txt")


def study(folder: Path, *names: str) -> Path:
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(folder.name)
    files = dict.fromkeys(names, "")
    write_json(folder / "provenance.json", {"fingerprint": {}, "status": "complete", "files": files})
    return folder


def there(folder: Path) -> dict[str, str]:
    files = (path for path in folder.rglob("*") if path.is_file() and path.name != "provenance.json")
    return {path.relative_to(folder).as_posix(): path.read_text() for path in files}


@pytest.mark.parametrize("mine", [[], ["notes.txt"], ["maps/mine/notes.txt", ".hidden"]])
def test_a_study_takes_the_place_of_another(tmp_path: Path, new: Path, mine: list[str]) -> None:
    target = study(tmp_path / "out" / "inputs" / "one", "a.txt", "maps/old.txt")
    for name in mine:
        (target / name).parent.mkdir(exist_ok=True)
        (target / name).write_text("mine")
    FolderStore(tmp_path / "out").put_folder(new, "inputs/one")
    assert there(target) == {"a.txt": "new", "maps/new.txt": "new"} | dict.fromkeys(mine, "mine")
    assert [path.name for path in target.parent.iterdir()] == ["one"]
    assert (read_provenance(target) or {})["status"] == "complete"


def test_a_file_of_the_user_is_not_written_over(tmp_path: Path, new: Path) -> None:
    target = study(tmp_path / "out" / "inputs" / "one", "a.txt")
    (target / "maps").mkdir()
    (target / "maps" / "new.txt").write_text("mine")
    with pytest.raises(StudyError, match=r"new\.txt is in the way, .*: move it"):
        FolderStore(tmp_path / "out").put_folder(new, "inputs/one")
    assert there(target) == {"a.txt": "one", "maps/new.txt": "mine"}
    assert (read_provenance(target) or {})["status"] == "complete"


@pytest.mark.parametrize("step", range(1, 5))
def test_files_of_the_user_outlast_a_stop_at_any_step(
    tmp_path: Path, new: Path, step: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = study(tmp_path / "out" / "inputs" / "one", "a.txt", "maps/old.txt")
    (target / "maps" / "mine.txt").write_text("mine")
    replace, moved = os.replace, []

    def stops(*paths: object) -> None:
        moved.append(paths)
        if len(moved) == step:
            raise KeyboardInterrupt
        replace(*paths)  # type: ignore[call-overload]

    monkeypatch.setattr(Path, "replace", stops)
    copy = shutil.copytree(new, tmp_path / "copy")
    with pytest.raises(KeyboardInterrupt):
        FolderStore(tmp_path / "out").put_folder(new, "inputs/one")
    assert there(target)["maps/mine.txt"] == "mine"
    assert step == 1 or (read_provenance(target) or {})["status"] == "being replaced"
    monkeypatch.undo()
    FolderStore(tmp_path / "out").put_folder(copy, "inputs/one")
    assert there(target) == {"a.txt": "new", "maps/new.txt": "new", "maps/mine.txt": "mine"}
