"""The inputs of a batch, checked."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias

from cytodisk.runs.map.map_parameters import WindowsOfMapsParameters

InputKind: TypeAlias = Literal["movie", "map"]
Value: TypeAlias = str | int | float | bool | None
"""What stands in a column that the user gives."""


@dataclass(frozen=True, slots=True)
class BatchInput:
    """One input: what `cytodisk movie` or `cytodisk map` takes, a name, and the columns of its rows.

    Attributes
    ----------
    name : str
        Name of its result folder; no other input has it.
    kind : {"movie", "map"}
    masks : Path
        A file, or for "map" also a folder of files.
    signal : Path or None
    parameters : WindowsOfMapsParameters
        For a movie `MovieParameters`; with the scale and the names of channels that were given.
    columns : tuple of value
        Condition, experiment and further columns; their names stand in the batch.
    signal_name : str
        What to call the channel of a signal whose file has no name for it: the same in all inputs.
    nuclei : Path or None
    """

    name: str
    kind: InputKind
    masks: Path
    signal: Path | None
    parameters: WindowsOfMapsParameters
    columns: tuple[Value, ...] = ()
    signal_name: str = ""
    nuclei: Path | None = None

    @property
    def files(self) -> dict[str, Path]:
        """What is read, by its role: "masks", and "signal" and "nuclei" where they are given."""
        found = {"masks": self.masks, "signal": self.signal, "nuclei": self.nuclei}
        return {role: path for role, path in found.items() if path is not None}

    @property
    def settings(self) -> str:
        """A hash of what decides the result beside the files."""
        content = [self.kind, self.parameters.model_dump(mode="json"), self.signal_name]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:16]
