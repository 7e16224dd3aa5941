"""A study that a widget made, in a folder of its own until it is saved."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar
from weakref import WeakKeyDictionary

from psygnal import Signal

from cytodisk.errors import StudyError
from cytodisk.files import make_folder, temporary_name
from cytodisk.napari.forms.command_line import command_line
from cytodisk.napari.given.given_layers import GivenFiles
from cytodisk.napari.work.background import Work
from cytodisk.napari.work.work_folder import INPUTS, WorkFolder
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.store.provenance_file import PROVENANCE, write_json
from cytodisk.store.study import Study, open_study
from cytodisk.store.study_kind import PARAMETERS

_AGAIN = "_again"  # behind the name of a folder: that of the shown command
_UNSAVED = "cytodisk_study"


@dataclass(eq=False)
class MadeStudy:
    """A study that a widget made.

    Attributes
    ----------
    command : {"map", "movie"}
        What does the same on the command line.
    study : Study
    work : WorkFolder or None
        Where it is; None once it is saved.
    files : GivenFiles
        What it was made from.
    values : dict
        Parameters, by name, that differ from their defaults.
    lines, losses : list of str
        What the command prints of the results, and of what was lost.
    fault : str
        What went wrong with the run as a whole; empty if nothing did.
    warnings : list of str
        What is wrong with the files.
    flags : list of QCFlag
    last_work : Work or None
        What was last done with it in a thread, as saving it or its report.
    saved : Signal
        Emitted when layers and widgets follow it to the folder where it was saved.
    """

    saved: ClassVar[Any] = Signal()

    command: str
    study: Study
    work: WorkFolder | None
    files: GivenFiles
    values: dict[str, Any]
    lines: list[str] = field(default_factory=list)
    losses: list[str] = field(default_factory=list)
    fault: str = ""
    warnings: list[str] = field(default_factory=list)
    flags: Sequence[QCFlag] = ()
    last_work: Work | None = None

    @property
    def is_in_use(self) -> bool:
        """Whether something is being done with it, so that its folder must stay as it is."""
        return self.last_work is not None and not self.last_work.done

    @property
    def is_saved(self) -> bool:
        """Whether it stays when the viewer is closed."""
        return self.work is None

    @property
    def usual_target(self) -> Path:
        """A new folder beside the file of masks, or in the current folder."""
        masks = self.files.masks
        folder = Path.cwd() if masks in self.files.written else masks.parent
        name = f"{masks.name.split('.')[0]}_study"
        names = [name, *(f"{name}_{number}" for number in range(2, 1000))]
        return next((folder / one for one in names if not (folder / one).exists()), folder / name)

    @property
    def needs_saving(self) -> bool:
        """Whether files that its command names go with the viewer."""
        return self.work is not None and bool(self.files.written)

    @property
    def command_line(self) -> str:
        """The line for a shell that makes the same study in another folder."""
        files = self.files
        arguments = [str(files.masks)]
        for flag, path in (("--signal", files.signal), ("--nuclei", files.nuclei)):
            arguments += [] if path is None else [flag, str(path)]
        out = f"{self.study.path}{_AGAIN}" if self.is_saved else _UNSAVED
        return command_line(self.command, [*arguments, "--out", out], self.values)

    def save(self, target: Path) -> None:
        """Copy the study, with the layers that were written, to a folder that is empty or new.

        The folder it was made in stays, so that layers which show it can be led to the new one first.

        Raises
        ------
        StudyError
            The folder holds something, cannot be written, or lies in the one that goes with the viewer.
        """
        assert self.work is not None  # it is saved once
        if target.resolve().is_relative_to(self.work.path.resolve()):
            raise StudyError(
                f"{target} lies in the folder {self.work.path}, which goes when you close the viewer: "
                "choose a folder elsewhere"
            )
        if target.exists() and (not target.is_dir() or any(target.iterdir())):
            raise StudyError(f"{target} is not empty: choose a new folder, so that nothing is replaced")
        new = target.with_name(temporary_name())
        try:
            make_folder(target.parent)
            shutil.copytree(self.study.path, new)
            if self.files.written:
                shutil.copytree(self.work.inputs, new / INPUTS)
            _tell_inputs(new, self.work.inputs)
            if target.exists():
                target.rmdir()
            new.replace(target)
        except OSError as error:
            raise StudyError(f"cannot write {target}: {error.strerror or error}") from error
        finally:
            shutil.rmtree(new, ignore_errors=True)
        before, after = self.work.inputs, target / INPUTS
        self.files = _moved(self.files, before, after)
        self.values = _elsewhere(before, after, self.values)
        self.study = open_study(target)
        self.work = None


_MADE: WeakKeyDictionary[Any, MadeStudy] = WeakKeyDictionary()


def keep_with(shown: Any, made: MadeStudy) -> None:
    """Keep a study, and the folder that it was made in, as long as its layers are shown.

    Parameters
    ----------
    shown : ShownStudy
    made : MadeStudy
    """
    _MADE[shown] = made


def made_of(shown: Any) -> MadeStudy | None:
    """The study that a widget made of layers that are shown; None for one that was opened."""
    return _MADE.get(shown)


def _tell_inputs(study: Path, before: Path) -> None:
    """Let a study name its inputs as they lie in it, so that it can be moved as a whole."""
    provenance = study / PROVENANCE
    told = json.loads(provenance.read_text(encoding="utf-8"))
    write_json(provenance, _elsewhere(before, Path(INPUTS), told))
    parameters = study / PARAMETERS
    if parameters.exists():
        text = parameters.read_text(encoding="utf-8")
        quoted = json.dumps(str(before), ensure_ascii=False)[1:-1]
        parameters.write_text(text.replace(quoted, INPUTS), encoding="utf-8")


def _elsewhere(before: Path, after: Path, told: Any) -> Any:
    """What is told, with paths in one folder as paths in another."""
    if isinstance(told, Mapping):
        return {name: _elsewhere(before, after, one) for name, one in told.items()}
    if isinstance(told, list):
        return [_elsewhere(before, after, one) for one in told]
    if isinstance(told, str) and Path(told).is_relative_to(before):
        return (after / Path(told).relative_to(before)).as_posix()
    return told


def _moved(files: GivenFiles, before: Path, after: Path) -> GivenFiles:
    def there(path: Path | None) -> Path | None:
        return path if path is None or not path.is_relative_to(before) else after / path.relative_to(before)

    masks = there(files.masks)
    assert masks is not None
    return replace(
        files,
        masks=masks,
        signal=there(files.signal),
        nuclei=there(files.nuclei),
        tracks=there(files.tracks),
        written=tuple(path for one in files.written if (path := there(one)) is not None),
    )
