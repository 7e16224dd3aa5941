"""`WorkFolder`: a temporary folder for what is written while nothing is saved yet."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from weakref import finalize

INPUTS = "inputs"
"""Folder, in that of a saved study, of layers that were written."""

_STUDY = "study"


class WorkFolder:
    """A folder for a study and its inputs that goes when nothing holds it any more."""

    def __init__(self) -> None:
        self.path = Path(tempfile.mkdtemp(prefix="cytodisk-"))
        self._remove = finalize(self, shutil.rmtree, self.path, ignore_errors=True)

    @property
    def inputs(self) -> Path:
        """Where layers are written."""
        return self.path / INPUTS

    @property
    def study(self) -> Path:
        """Where the study is made."""
        return self.path / _STUDY

    def remove(self) -> None:
        """Remove it now."""
        self._remove()
