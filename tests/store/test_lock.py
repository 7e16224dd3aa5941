"""Two runs are never in one folder at once, tried with real processes."""

import subprocess
import sys
from pathlib import Path

import pytest

from cytodisk.errors import StudyError
from cytodisk.files import lock, unlock
from cytodisk.store.removal import LOCK
from cytodisk.store.study_room import alone_in

RACE = """
import sys, time
from pathlib import Path
from cytodisk.errors import StudyError
from cytodisk.store.study_room import alone_in
out, end, entered = Path(sys.argv[1]), time.monotonic() + 2.0, 0
inside = out / "inside"
while time.monotonic() < end:
    try:
        with alone_in(out):
            inside.touch(exist_ok=False)
            entered += 1
            inside.unlink()
    except StudyError:
        pass
print(entered)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="a file that is open cannot be removed there")
def test_a_lock_whose_file_was_removed_is_no_lock(tmp_path: Path) -> None:
    """One waits with the file open while another lets go: a third must not get a file of its own."""
    path = tmp_path / LOCK
    first = lock(path)
    with pytest.raises(BlockingIOError):
        lock(path)
    path.unlink()  # as the first does when it ends; it still holds what others have opened
    second = lock(path)
    with pytest.raises(BlockingIOError):
        lock(path)
    unlock(second, path)
    first.close()
    assert not path.exists()


@pytest.mark.slow
def test_processes_that_race_for_a_folder_are_never_in_it_together(tmp_path: Path) -> None:
    command = [sys.executable, "-c", RACE, str(tmp_path / "out")]
    racers = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(4)]
    entered = [racer.communicate(timeout=60)[0] for racer in racers]
    assert [racer.returncode for racer in racers] == [0] * 4
    assert all(int(count) > 0 for count in entered)
    assert not any((tmp_path / "out").iterdir())


def test_a_lock_of_a_killed_process_is_free_and_one_by_a_link_is_the_same(tmp_path: Path) -> None:
    held = "import sys, pathlib, cytodisk.files as files; file = files.lock(pathlib.Path(sys.argv[1]))"
    command = [sys.executable, "-c", f"{held}; print('held', flush=True); input()", str(tmp_path / LOCK)]
    (tmp_path / "link").symlink_to(tmp_path)
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "held\n"
        for path in (tmp_path, tmp_path / "link"):
            with pytest.raises(StudyError, match="another run is writing there"), alone_in(path):
                pass
        process.kill()
    with alone_in(tmp_path / "link"):
        assert (tmp_path / LOCK).exists()
    assert not (tmp_path / LOCK).exists()
