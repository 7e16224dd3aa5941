"""What kind of folder a command was given."""

from pathlib import Path


def is_batch(folder: Path) -> bool:
    """Whether `cytodisk batch` wrote a folder; what else is wrong with it is found where it is opened."""
    return is_run(folder, "batch")


def is_run(folder: Path, run: str) -> bool:
    """The same of any run, by its name in the provenance."""
    from cytodisk.errors import CytodiskError
    from cytodisk.store.provenance_file import read_provenance

    try:
        there = read_provenance(folder)
    except CytodiskError:
        return False
    return there is not None and there.get("run") == run
