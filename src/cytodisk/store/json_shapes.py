"""What the JSON files of a study hold, as types: whoever reads one checks it against them."""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, Literal, Required

from pydantic import ConfigDict, Field, TypeAdapter, with_config
from typing_extensions import TypedDict

from cytodisk.checks import LARGEST_SCALE, SMALLEST_SCALE
from cytodisk.parameters import MOST_SEED

_MOST_SIDE = 1_000_000  # pixels
_Whole = Annotated[int, Field(strict=True, ge=-(2**53), le=2**53)]
_Count = Annotated[int, Field(strict=True, ge=0, le=2**53)]
_Seed = Annotated[int, Field(strict=True, ge=0, le=MOST_SEED)]
_Text = Annotated[str, Field(strict=True)]
_Truth = Annotated[bool, Field(strict=True)]
_Scale = Annotated[float, Field(strict=True, ge=SMALLEST_SCALE, le=LARGEST_SCALE)]
_Seconds = Annotated[float, Field(ge=0, le=1e12, allow_inf_nan=False)]
_Side = Annotated[int, Field(strict=True, ge=1, le=_MOST_SIDE)]
_Two = Field(min_length=2, max_length=2)
_Kind = Literal["int64", "double", "string", "large_string", "bool", "null"]
_ANYTHING_ELSE = ConfigDict(extra="allow")

_With = TypedDict("_With", {"with": Required[_Text]})


@with_config(_ANYTHING_ELSE)
class _Settings(_With, total=False):
    signal: Required[_Text]
    name: _Text
    tables: dict[str, dict[str, _Kind]]
    max_lag: _Count
    min_pairs: _Count
    surrogates: _Count
    seed: _Seed
    against: Literal["window", "edge"]
    detrend: Literal["none", "linear", "median"]
    detrend_frames: _Count | None
    statistic: Literal["pearson", "spearman"]
    null: Literal["phase", "shift"]
    rule: Literal["nearest", "largest"]
    geometry: _Truth
    clusters: _Truth
    pairs: _Truth
    difference: _Truth
    control: list[_Text]
    skip_lags: list[_Whole]
    without_frames: list[_Whole]
    frames: Annotated[list[_Count], _Two] | None
    sectors: Annotated[list[_Count], _Two] | None
    given: dict[str, Any]
    surrogates_made: _Count
    pair_surrogates: _Count


@with_config(_ANYTHING_ELSE)
class _PredictionSettings(TypedDict, total=False):
    source: Required[_Text]
    target: Required[_Text]
    signals: Required[list[_Text]]
    name: _Text
    tables: dict[str, dict[str, _Kind]]
    given: list[_Text] | None
    max_order: _Count
    surrogates: _Count
    seed: _Seed
    geometry: _Truth
    without_frames: list[_Whole]
    frames: Annotated[list[_Count], _Two] | None
    sectors: Annotated[list[_Count], _Two] | None
    asked: dict[str, Any]


@with_config(_ANYTHING_ELSE)
class _WaveSettings(TypedDict, total=False):
    signal: Required[_Text]
    name: _Text
    tables: dict[str, dict[str, _Kind]]
    layer: _Count
    surrogates: _Count
    seed: _Seed
    geometry: _Truth
    without_frames: list[_Whole]
    frames: Annotated[list[_Count], _Two] | None
    given: dict[str, Any]
    surrogates_made: _Count


@with_config(_ANYTHING_ELSE)
class _Input(TypedDict, total=False):
    path: Required[_Text]
    sha256: _Text
    files: dict[str, _Text]


@with_config(_ANYTHING_ELSE)
class _Provenance(TypedDict, total=False):
    fingerprint: Required[dict[str, Any]]
    status: _Text
    run: _Text
    command: _Text
    reader: _Text
    format: _Whole
    files: list[_Text] | dict[str, Any]
    inputs: dict[str, _Input]
    parameters: dict[str, Any]
    versions: dict[str, _Text]
    warnings: list[_Text]
    started: _Text
    finished: _Text
    pixel_size_um: _Scale | None
    frame_interval_s: _Scale | None
    length_unit: Literal["px", "µm"]
    velocity_unit: _Text
    seed: _Seed | None
    layers: Annotated[int, Field(strict=True, ge=1, le=_MOST_SIDE)]
    image_shape: Annotated[list[_Side], _Two]
    writes: list[_Text]


@with_config(ConfigDict(extra="forbid"))
class _Row(TypedDict, total=False):
    input: Required[_Text]
    kind: Required[Literal["movie", "map"]]
    status: Required[_Text]
    reason: Required[_Text]
    settings: Required[_Text]
    files: Required[_Text]
    complete: _Truth
    cells: _Count
    frames: _Count
    mapped: _Count
    qc_flags: _Count
    flags: _Text
    pixel_size_um: _Scale | None
    frame_interval_s: _Scale | None
    length_unit: Literal["px", "µm", ""]
    velocity_unit: _Text
    seconds: _Seconds
    log: _Text
    worker: dict[str, Any] | None


@cache
def correlation_settings() -> TypeAdapter[Any]:
    """Of `settings.json` of a correlation."""
    return TypeAdapter(_Settings)


@cache
def prediction_settings() -> TypeAdapter[Any]:
    """Of `settings.json` of a prediction."""
    return TypeAdapter(_PredictionSettings)


@cache
def wave_settings() -> TypeAdapter[Any]:
    """Of `settings.json` of waves."""
    return TypeAdapter(_WaveSettings)


@cache
def provenance_fields() -> TypeAdapter[Any]:
    """Of `provenance.json` of a study."""
    return TypeAdapter(_Provenance)


@cache
def input_row() -> TypeAdapter[Any]:
    """Of the row of an input of a batch."""
    return TypeAdapter(_Row)
