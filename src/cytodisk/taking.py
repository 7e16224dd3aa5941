"""`takes`: a function's keywords, their defaults and their docs from a model of parameters."""

from __future__ import annotations

import inspect
import re
import textwrap
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from pydantic.fields import FieldInfo

from cytodisk.parameter_words import choices, kinds, limits, unit_of
from cytodisk.parameters import Parameters

AnyFunction = TypeVar("AnyFunction", bound=Callable[..., Any])

_MARK = re.compile(r"^( *)\*\*settings\n(?:\1 +.*\n)*", re.MULTILINE)
_WIDTH = 100


def takes(*models: type[Parameters]) -> Callable[[AnyFunction], AnyFunction]:
    """Show the fields of models as keywords of a function that takes `**settings`.

    The signature names them with their defaults, and their sentences take the place of the entry
    `**settings` in the docstring's section "Parameters". A function that takes `*in_order` too can be given
    them without names.

    Parameters
    ----------
    *models : type of Parameters
        The function makes them from its settings, as `model.of(**settings)`, which checks them.

    Returns
    -------
    callable
        A decorator; the function itself stays as it is.
    """

    def show(function: AnyFunction) -> AnyFunction:
        own = list(inspect.signature(function).parameters.values())
        by_order = any(one.kind is inspect.Parameter.VAR_POSITIONAL for one in own)
        kind = inspect.Parameter.POSITIONAL_OR_KEYWORD if by_order else inspect.Parameter.KEYWORD_ONLY
        fields = [
            inspect.Parameter(name, kind, default=field.get_default(), annotation=field.annotation)
            for name, field in fields_of(models).items()
        ]
        before = [one for one in own if one.kind is inspect.Parameter.POSITIONAL_OR_KEYWORD]
        after = [one for one in own if one.kind is inspect.Parameter.KEYWORD_ONLY]
        returned = inspect.signature(function).return_annotation
        function.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
            [*before, *fields, *after], return_annotation=returned
        )
        if function.__doc__:
            function.__doc__ = _MARK.sub(lambda mark: entries(models, mark[1]), function.__doc__)
        return function

    return show


def fields_of(models: Sequence[type[Parameters]]) -> dict[str, FieldInfo]:
    """The fields of models, by name; of a name that several have, the first model's."""
    found: dict[str, FieldInfo] = {}
    for model in models:
        found |= {name: field for name, field in model.model_fields.items() if name not in found}
    return found


def entries(models: Sequence[type[Parameters]], indent: str = "") -> str:
    """Fields of models as entries of a numpydoc section.

    Parameters
    ----------
    models : sequence of type of Parameters
    indent : str
        Spaces before each line.
    """
    lines = []
    for name, field in fields_of(models).items():
        lines.append(f"{name} : {_type_words(field)}")
        lines += textwrap.wrap(sentence(field), _WIDTH, initial_indent="    ", subsequent_indent="    ")
    return textwrap.indent("\n".join(lines) + "\n", indent)


def sentence(field: FieldInfo) -> str:
    """What a parameter does, with its unit."""
    unit = unit_of(field)
    return f"{field.description} In {unit}." if unit else str(field.description)


def _type_words(field: FieldInfo) -> str:
    """As "float above 0" or '{"area", "radius"}'."""
    words = choices(field.annotation)
    found = kinds(field.annotation)
    names = [name for kind, name in _NAMES.items() if kind in found and not (kind is str and words)]
    listed = ["{" + ", ".join(f'"{word}"' for word in words) + "}"] if words else []
    optional = ", optional" if type(None) in found else ""
    return " or ".join([*listed, *names]) + limits(field) + optional


_NAMES = {int: "int", float: "float", bool: "bool", str: "str", tuple: "tuple"}
