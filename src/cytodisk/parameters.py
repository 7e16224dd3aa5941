"""`Parameters`: what a function or a command can be given, declared once and checked in one place."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Self, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, ValidationInfo, field_validator
from pydantic_core import PydanticCustomError

from cytodisk.errors import CytodiskError, ParameterError
from cytodisk.number_words import comma_advice, unit_advice
from cytodisk.parameter_words import choices, kinds, range_words, short_words, unknown_words, value_words

_IN_FULL = "in_full"
MOST_SEED = 2**128  # as long as those that NumPy draws itself

Group = TypeVar("Group", bound="Parameters")


def parameter(
    default: Any,
    sentence: str,
    *,
    above: float | None = None,
    least: float | None = None,
    most: float | None = None,
    unit: str = "",
    words: str = "",
    flag: str = "",
) -> Any:
    """Declare a parameter of a model.

    Parameters
    ----------
    default : object
    sentence : str
        What it does, for a user; ends with a full stop.
    above, least, most : float, optional
        Its range: more than, at least, at most.
    unit : str
        Unit of the number, such as "px".
    words : str
        What it may be, as "a point (row, column)", where type and range do not say it.
    flag : str
        Of the command line, without dashes in front, where it is not the name with dashes.
    """
    return Field(
        default,
        description=sentence,
        gt=above,
        ge=least,
        le=most,
        json_schema_extra={"unit": unit, "words": words, "flag": flag},
    )


class Parameters(BaseModel):
    """Parameters of a function or a command, each with its default, range, unit and sentence.

    Numbers of NumPy count as numbers, and 2.0 as 2; True and texts are no numbers.

    Raises
    ------
    ParameterError
        A name is unknown, a value is out of its range, or two exclude each other.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, defer_build=True)

    fault: ClassVar[type[CytodiskError]] = ParameterError
    """What a wrong value raises."""

    exclusive: ClassVar[tuple[tuple[str, str], ...]] = ()
    """Pairs of names of which only one can be given: the other has its default."""

    def __init__(self, **values: Any) -> None:
        self._check_exclusive(values, {})
        try:
            super().__init__(**values)
        except ValidationError as error:
            raise self.fault(_fault_words(error, type(self), {})) from None

    @classmethod
    def of(cls, *in_order: Any, **values: Any) -> Self:
        """Parameters from values; those without a name are in the order of the fields.

        Raises
        ------
        ParameterError
            A name is unknown or given twice, a value is out of its range, or two exclude each other.
        """
        names = list(cls.model_fields)
        if len(in_order) > len(names):
            raise cls.fault(f"got {len(in_order)} values without names, there are {', '.join(names)}")
        by_order = dict(zip(names, in_order, strict=False))
        if twice := sorted(by_order.keys() & values.keys()):
            raise cls.fault(f"{twice[0]} is given twice, by its position and by its name")
        return cls.called(by_order | values, {})

    @classmethod
    def called(cls, values: Mapping[str, Any], names: Mapping[str, str]) -> Self:
        """Parameters from values, which messages call by other names, such as flags.

        Parameters
        ----------
        values : mapping
        names : mapping of str to str
            What the user knows a parameter by, where that is not its name.

        Raises
        ------
        ParameterError
            As for `of`.
        """
        cls._check_exclusive(values, names)
        return cls._of_all(values, names)

    @classmethod
    def _of_all(cls, values: Mapping[str, Any], names: Mapping[str, str]) -> Self:
        """Parameters from values of which two may exclude each other, as those of another model."""
        made = cls.__new__(cls)
        try:
            cls.__pydantic_validator__.validate_python(dict(values), self_instance=made)
        except ValidationError as error:
            raise cls.fault(_fault_words(error, cls, names)) from None
        return made

    @classmethod
    def _check_exclusive(cls, values: Mapping[str, Any], names: Mapping[str, str]) -> None:
        for pair in cls.exclusive:
            if all(_is_given(values.get(name)) for name in pair):
                shown = [names.get(name, name) for name in pair]
                raise cls.fault(f"{shown[0]} and {shown[1]} exclude each other: pass one of them")

    @classmethod
    def chosen(cls, parameters: Parameters | None, values: Mapping[str, Any]) -> Self:
        """Given parameters, or the defaults, some of them with other values."""
        if parameters is None:
            return cls.of(**values)
        if not isinstance(parameters, cls):
            raise cls.fault(f"parameters must be {cls.__name__}, got {type(parameters).__name__}")
        return parameters.changed(**values)

    def changed(self, **values: Any) -> Self:
        """These parameters, some of them with other values; what a given one excludes has its default again.

        Raises
        ------
        ParameterError
            As for `of`.
        """
        if not values:
            return self
        self._check_exclusive(values, {})
        given = {name for name, value in values.items() if _is_given(value)}
        excluded = {name for pair in self.exclusive if given & set(pair) for name in pair}
        kept = {name: value for name, value in self if name not in excluded}
        return self._of_all(kept | values, {})

    def part(self, group: type[Group]) -> Group:
        """What a group of parameters shares with these."""
        own = dict(self)
        return group._of_all({name: own[name] for name in group.model_fields if name in own}, {})

    @field_validator("*", mode="before")
    @classmethod
    def _plain(cls, value: Any, info: ValidationInfo) -> Any:
        """A value as Python's own types; True and "1" are not taken for numbers."""
        plain = value.tolist() if hasattr(value, "tolist") else value
        annotation = cls.model_fields[str(info.field_name)].annotation
        wanted, words = kinds(annotation), choices(annotation)
        is_meant = type(plain) in wanted and (plain in words or not words)
        if wanted & {int, float, bool} and isinstance(plain, bool | str) and not is_meant:
            raise PydanticCustomError("no_number", "this is no number")
        return plain


def in_full(words: str) -> PydanticCustomError:
    """An error for the validator of a field whose words, after the name, say all: what came, too."""
    return PydanticCustomError(_IN_FULL, "{words}", {"words": words})


def _is_given(value: Any) -> bool:
    """Whether a value excludes another: None and a switch that is off do not."""
    return value is not None and value is not False


def _fault_words(error: ValidationError, model: type[Parameters], names: Mapping[str, str]) -> str:
    """All faults in one line, each parameter by its name in `names`, if it has one there."""
    words = []
    for fault in error.errors(include_url=False):
        message = str(fault["msg"]).removeprefix("Value error, ")
        name = str(fault["loc"][0]) if fault["loc"] else ""
        field = model.model_fields.get(name)
        if not name:
            words.append(message)
        elif field is None:
            words.append(unknown_words(name, model.model_fields))
        elif fault["type"] == _IN_FULL:
            words.append(f"{names.get(name, name)} {message}")
        elif fault["type"] == "value_error":
            colon = "" if message.startswith("must") else ":"
            advice = comma_advice(fault["input"])
            said = f"{message}, got {short_words(fault['input'])}" + (f": {advice}" if advice else "")
            words.append(f"{names.get(name, name)}{colon} {said}")
        else:
            default = "" if field.default is None else f"{value_words(field.default)} is the default"
            numeric = kinds(field.annotation) & {int, float}
            advice = comma_advice(fault["input"], numeric == {int})
            advice = advice or (unit_advice(fault["input"], name) if numeric else "") or default
            must = f"must be {range_words(field)}, got {short_words(fault['input'])}"
            must += f": {advice}" if advice else ""
            words.append(f"{names.get(name, name)} {must}")
    return "; ".join(dict.fromkeys(words))


def from_zero(numbers: tuple[int, ...] | None) -> tuple[int, ...] | None:
    """Numbers of cells, frames or sectors as they are; a ValueError, for a validator, if one is below 0."""
    if numbers is not None and any(number < 0 for number in numbers):
        raise ValueError("must be numbers from 0")
    return numbers


def in_order(frames: tuple[int, int] | None) -> tuple[int, int] | None:
    """First and last frame as they are; a ValueError, for a validator, if the last is before the first."""
    if frames is not None and frames[1] < frames[0]:
        raise ValueError("must go from the first to the last")
    return frames
