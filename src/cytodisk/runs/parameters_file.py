"""Parameters in files: the one in every study can be fed back."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cytodisk.errors import ParameterError
from cytodisk.files import replacing
from cytodisk.parameters import Group, Parameters
from cytodisk.store.provenance_file import command_of, read_provenance
from cytodisk.store.study_kind import PARAMETERS


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
    """
    given = {name: value for name, value in values.items() if value is not None}
    found = {} if path is None else _read(path, of)
    for one, other in of.exclusive:
        found = {name: value for name, value in found.items() if not _overruled(name, one, other, given)}
        if one in found and other in found and path is not None and _of_study(path):
            found.pop(one)  # studies of earlier versions have both, of which the second counts
    shown = {name: shown for name, shown in (names or {}).items() if name in given}
    return of.called(found | given, shown)


def _overruled(name: str, one: str, other: str, given: Mapping[str, Any]) -> bool:
    """Whether a name of the file excludes one that is given."""
    return (name == one and other in given) or (name == other and one in given)


def _of_study(path: Path) -> bool:
    return path.name == PARAMETERS and read_provenance(path.parent) is not None


def _read(path: Path, of: type[Parameters]) -> dict[str, Any]:
    """Content of a file that has no other names than those of the parameters."""
    try:
        found = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ParameterError(f"parameters file {path} cannot be read: {error}") from error
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

    Parameters
    ----------
    parameters : Parameters
    path : Path
    """
    with replacing(path) as temporary:
        temporary.write_text("\n".join(toml_lines(_without_excluded(parameters))) + "\n", encoding="utf-8")


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
        return json.dumps(value, ensure_ascii=False)  # its escapes are those of TOML
    if isinstance(value, tuple):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    return repr(value)
