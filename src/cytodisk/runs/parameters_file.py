"""Parameters in files: the one in every study can be fed back."""

from __future__ import annotations

import json
import re
import tomllib
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cytodisk.disk.mapping_parameters import MAPS_VERSION
from cytodisk.errors import CytodiskError, EarlierVersionWarning, ParameterError
from cytodisk.files import replacing
from cytodisk.number_words import comma_in_toml
from cytodisk.parameters import Group, Parameters
from cytodisk.reading_files import text_of
from cytodisk.store.provenance_file import (
    MAPS,
    command_of,
    maps_version,
    read_provenance,
    writer_of,
)
from cytodisk.store.study_kind import PARAMETERS

_FOR_MAPS = re.compile(rf"^# {MAPS} (\d+)", re.MULTILINE)
_EARLIER_DEFAULTS = {"shape_weight": 0.005, "edge_length": 0.9}
"""Of version 1 of maps, whose files hold all values, given or not."""


def parameters_from(
    values: Mapping[str, Any], path: Path | None, of: type[Group], names: Mapping[str, str] | None = None
) -> Group:
    """Parameters from a file, overruled by given values.

    Parameters
    ----------
    values : mapping
        By name; None means not given.
    path : Path or None
        A TOML file as `parameters.toml` of a study.
    of : type of Parameters
        Such as `MapParameters` or `MovieParameters`.
    names : mapping of str to str, optional
        What messages call given values, such as their flags.

    Returns
    -------
    Parameters
        Of that type.

    Raises
    ------
    ParameterError
        The file cannot be read, or a value is unknown or out of range.

    Warns
    -----
    EarlierVersionWarning
        The file is that of a study of an earlier version, in which some of its values meant other maps.
    """
    given = {name: value for name, value in values.items() if value is not None}
    found = {} if path is None else _read(path, of)
    for one, other in of.exclusive:
        found = {name: value for name, value in found.items() if not _overruled(name, one, other, given)}
        if one in found and other in found and path is not None and _of_study(path):
            found.pop(one)  # studies of earlier versions have both, of which the second counts
    shown = {name: shown for name, shown in (names or {}).items() if name in given}
    if path is not None:
        _check_alone({name: value for name, value in found.items() if name not in given}, path, of)
    chosen = of.called(found | given, shown)
    if path is not None and (words := _meant_otherwise(path, found, given)):
        warnings.warn(words, EarlierVersionWarning, stacklevel=2)
    return chosen


def _check_alone(found: Mapping[str, Any], path: Path, of: type[Parameters]) -> None:
    """What a file says and no flag overrules must be right by itself; the message names the file."""
    try:
        of.called(found, {})
    except CytodiskError as error:
        raise type(error)(f"parameters file {path}: {error}") from None


def _meant_otherwise(path: Path, found: Mapping[str, Any], given: Mapping[str, Any]) -> str:
    """Words for values that are those of earlier maps, where a study of such maps wrote the file.

    A file that says which maps it is for, or stands in no study, is taken as it reads.
    """
    study = read_provenance(path.parent) if path.name == PARAMETERS else None
    if study is None or _FOR_MAPS.search(path.read_text(encoding="utf-8")):
        return ""
    if maps_version(study) >= MAPS_VERSION:
        return ""
    left = {name: value for name, value in found.items() if name not in given}
    method = given.get("method", found.get("method"))
    relaxes = method not in ("harmonic", "advection")
    counts = {"shape_weight": relaxes, "edge_length": method != "advection"}
    old = [name for name, value in _EARLIER_DEFAULTS.items() if counts[name] and left.get(name) == value]
    meant = ['method "newton" meant areas by triangle then ("newton-triangles" now)']
    meant = meant if left.get("method") == "newton" else []
    if old:
        values = " and ".join(f"{name} = {left[name]}" for name in old)
        meant.append(f"{values} {'are the defaults' if len(old) > 1 else 'is the default'} of that version")
    if not meant:
        return ""
    lines = [*(["method"] if left.get("method") == "newton" else []), *old]
    return (
        f"parameters file {path} is for maps by {writer_of(study)}: {'; '.join(meant)}. Read as they stand, "
        "they give maps that are neither those of then nor those of today: for today's maps copy the file "
        f"and leave the {_lines(lines)} out"
    )


def _lines(names: list[str]) -> str:
    """As "three lines method, shape_weight and edge_length"."""
    listed = " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))
    return f"{('', 'line', 'two lines', 'three lines')[len(names)]} {listed}"


def _overruled(name: str, one: str, other: str, given: Mapping[str, Any]) -> bool:
    """Whether a name of the file excludes one that is given."""
    return (name == one and other in given) or (name == other and one in given)


def _of_study(path: Path) -> bool:
    return path.name == PARAMETERS and read_provenance(path.parent) is not None


def _read(path: Path, of: type[Parameters]) -> dict[str, Any]:
    """Content of a file that has no other names than those of the parameters."""
    text = ""
    try:
        text = text_of(path)
        found = tomllib.loads(text)
    except (OSError, ValueError, RecursionError) as error:  # numbers of thousands of digits, deep nesting
        if words := comma_in_toml(text):
            raise ParameterError(f"parameters file {path}: {words}") from error
        raise ParameterError(f"parameters file {path} cannot be read: {error}") from error
    if not text.strip():
        raise ParameterError(
            f"parameters file {path} is empty: it was not written to its end; copy it again, or leave "
            "--parameters out"
        )
    unknown = sorted(set(found) - set(of.model_fields))
    if not unknown:
        return found
    study = read_provenance(path.parent) if path.name == PARAMETERS else None
    origin = (
        "perhaps it is that of another command" if study is None else f"it is that of {command_of(study)}"
    )
    raise ParameterError(
        f"parameters file {path} has names that are no parameters of this command ({', '.join(unknown)}): "
        f"{origin}, maybe of an earlier version: take these names out, or use that command"
    )


def write_parameters(parameters: Parameters, path: Path) -> None:
    """Write parameters as TOML; those that are not set are left out.

    A comment says which maps they are for.

    Parameters
    ----------
    parameters : Parameters
    path : Path
    """
    told = f"# {MAPS} {MAPS_VERSION}; a later cytodisk reads this line"
    with replacing(path) as temporary:
        lines = [told, *toml_lines(_without_excluded(parameters))]
        temporary.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _without_excluded(parameters: Parameters) -> dict[str, Any]:
    """Values without those of which another one takes the place, as `layers` where there is `depth_um`."""
    values = parameters.model_dump()
    for one, other in type(parameters).exclusive:
        default = type(parameters).model_fields[other].default
        if default is None and values.get(other) is not None:
            values.pop(one, None)
    return values


def toml_lines(values: Mapping[str, Any]) -> list[str]:
    """Values as lines of TOML; those that are None are left out."""
    return [f"{name} = {_toml(value)}" for name, value in values.items() if value is not None]


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")  # else its escapes are TOML's
    if isinstance(value, tuple):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    return repr(value)
