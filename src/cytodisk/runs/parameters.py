"""Parameters of a run, from flags or a file; the file in every study can be fed back."""

import json
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from cytodisk.errors import ParameterError
from cytodisk.files import replacing
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.store.provenance_file import command_of, read_provenance
from cytodisk.store.study_folder import PARAMETERS


class MapParameters(BaseModel):
    """What decides the result of `cytodisk map`, beside the input files.

    Lengths in pixels unless the name says otherwise; see `map_to_disk`, `polar_windows` and `sample`.
    `channels` are the names of the signal's channels, in the place of the file's own.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    kind: Literal["auto", "mask", "stack", "labels"] = "auto"
    channels: tuple[str, ...] | None = None
    method: Literal["newton", "harmonic", "advection"] = "newton"
    shape_weight: Annotated[float, Field(gt=0)] = 0.005
    edge_length: Annotated[float, Field(ge=0.25, le=10)] = 0.9
    align: Literal["upright"] | tuple[float, float] | float = "upright"
    layers: Annotated[int, Field(ge=1)] = 10
    sectors: Annotated[int, Field(ge=1)] = 60
    spacing: Literal["area", "radius"] = "area"
    nan: Literal["propagate", "omit"] = "propagate"
    pixel_size_um: Annotated[float, Field(gt=0)] | None = None

    @field_validator("channels")
    @classmethod
    def _names(cls, channels: tuple[str, ...] | None) -> tuple[str, ...] | None:
        if channels is None:
            return None
        if not channels or any(not name.strip() or not name.isprintable() for name in channels):
            raise ValueError("every channel needs a name that can be printed")
        if len(set(channels)) < len(channels):
            raise ValueError("two channels have one name")
        taken = [name for name in channels if name in VELOCITIES]
        if taken:
            raise ValueError(f"{taken[0]} is the name of the edge's velocity")
        return channels


class MovieParameters(MapParameters):
    """What decides the result of `cytodisk movie`, beside the input files.

    See `map_movie` and `edge_changes`. `depth_um` takes the place of `layers`: thickness of the first layer
    in the first frame.
    """

    kind: Literal["auto", "stack", "labels"] = "auto"
    link: bool = False
    tracker: Literal["matching", "demons"] = "matching"
    tension: Annotated[float, Field(ge=0, le=1)] = 0.01
    registration: bool = True
    renew_every: Annotated[int, Field(ge=1)] = 5
    inertia: Annotated[float, Field(ge=0)] = 1.0
    depth_um: Annotated[float, Field(gt=0)] | None = None
    jitter_px: Annotated[float, Field(ge=0)] = 0.5
    repeats: Annotated[int, Field(ge=2)] = 8
    seed: Annotated[int, Field(ge=0)] = 0
    frame_interval_s: Annotated[float, Field(gt=0)] | None = None


AnyParameters = TypeVar("AnyParameters", bound=BaseModel)


def parameters_from(
    values: dict[str, Any],
    path: Path | None = None,
    of: type[AnyParameters] = MapParameters,  # type: ignore[assignment]
) -> AnyParameters:
    """Parameters from a file, overruled by given values.

    Parameters
    ----------
    values : dict
        By name; None means not given.
    path : Path, optional
        A TOML file as `parameters.toml` of a study.
    of : type
        Such as `MapParameters` or `MovieParameters`.

    Returns
    -------
    BaseModel
        Of that type.

    Raises
    ------
    ParameterError
        The file cannot be read, or a value is unknown or out of range.
    """
    merged: dict[str, Any] = {}
    if path is not None:
        try:
            merged = tomllib.loads(path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
            raise ParameterError(f"parameters file {path} cannot be read: {error}") from error
        _check_names(merged, of, path)
    if values.get("layers") is not None:
        merged.pop("depth_um", None)  # the two exclude each other, and what is given now counts
    merged |= {name: value for name, value in values.items() if value is not None}
    try:
        return of(**merged)
    except ValidationError as error:
        faults = [_fault_words(fault) for fault in error.errors()]
        raise ParameterError("parameters: " + "; ".join(dict.fromkeys(faults))) from error


def _check_names(found: dict[str, Any], of: type[BaseModel], path: Path) -> None:
    """Raise ParameterError for names that a command does not know, such as those of another command."""
    unknown = sorted(set(found) - set(of.model_fields))
    if not unknown:
        return
    study = read_provenance(path.parent) if path.name == PARAMETERS else None
    origin = (
        "perhaps it is that of another command" if study is None else f"it is that of {command_of(study)}"
    )
    raise ParameterError(
        f"parameters file {path} has names that are no parameters of this command ({', '.join(unknown)}): "
        f"{origin}; use that command, or take these out"
    )


def _fault_words(fault: Any) -> str:
    name = fault["loc"][0] if fault["loc"] else "?"
    return f"{name}: {fault['msg'].removeprefix('Value error, ')}, got {repr(fault['input'])[:40]}"


def write_parameters(parameters: BaseModel, path: Path) -> None:
    """Write parameters as TOML; those that are not set are left out.

    Parameters
    ----------
    parameters : BaseModel
    path : Path
    """
    with replacing(path) as temporary:
        temporary.write_text("\n".join(toml_lines(parameters.model_dump())) + "\n", encoding="utf-8")


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
