"""A file of results, a line each, to which a run that was stopped adds what is missing."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import asdict
from hashlib import sha256
from pathlib import Path
from typing import Any


class StoredTrials:
    """Results in a file of lines; the first line says which version of the package they belong to.

    Parameters
    ----------
    path : Path or None
        The file, which need not exist; None keeps nothing.
    package : Path
        Folder of the package that is measured.
    choice : str
        What else the results depend on, such as the method.
    """

    def __init__(self, path: Path | None, package: Path, choice: str = "") -> None:
        self.path = path
        self.version = " ".join([version_of(package), choice]).strip()

    def read(self) -> Iterator[dict[str, Any]]:
        """Results that stand in the file; a last line that a stopped run left unfinished is taken off.

        Raises
        ------
        SystemExit
            The file belongs to another version of the package.
        """
        if self.path is None or not self.path.exists():
            return
        text = self.path.read_text(encoding="utf-8")
        whole = text[: text.rfind("\n") + 1]
        if whole != text:
            self.path.write_text(whole, encoding="utf-8")
        head, *lines = whole.splitlines() or [""]
        if head and json.loads(head) != {"version": self.version}:
            raise SystemExit(
                f"{self.path} holds results of another version of the package: name another file"
            )
        yield from map(json.loads, lines)

    @contextmanager
    def writing(self) -> Iterator[Callable[[Any], None]]:
        """A function that adds a result, a dataclass."""
        with nullcontext() if self.path is None else self.path.open("a", encoding="utf-8") as stream:

            def write(trial: Any) -> None:
                if stream is not None:
                    stream.write(json.dumps(asdict(trial)) + "\n")
                    stream.flush()

            if stream is not None and stream.tell() == 0:
                stream.write(json.dumps({"version": self.version}) + "\n")
                stream.flush()  # before processes are forked
            yield write


def version_of(package: Path) -> str:
    """What stands for the package's files as they are."""
    digest = sha256()
    for path in sorted(package.rglob("*.py")):
        digest.update(path.relative_to(package).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
