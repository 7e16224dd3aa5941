"""Options of the command line: those of parameters from their models, and those that commands share."""

import inspect
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer
from pydantic.fields import FieldInfo

from cytodisk.cli.console import earlier_version_lines
from cytodisk.parameter_words import (
    choices,
    default_words,
    flag_of,
    help_words,
    kinds,
    tuple_items,
    value_of_text,
)
from cytodisk.parameters import Group, Parameters
from cytodisk.taking import fields_of

MaskFiles = Annotated[
    Path,
    typer.Argument(
        metavar="MASKS",
        help="Masks or label images (TIFF, PNG, _seg.npy, OME-Zarr, ND2, CZI, LIF) or outlines (.roi, .zip, "
        ".geojson): a file, a folder, or a pattern in quotes, such as 'day1/*.tif'.",
        show_default=False,
    ),
]
MovieFile = Annotated[
    Path,
    typer.Argument(
        metavar="MASKS",
        help="Masks or label images by frame: one file; or a folder, or a pattern in quotes such as "
        "'t*.tif', of one file a frame.",
        show_default=False,
    ),
]
MovieStudyOrBatch = Annotated[
    Path,
    typer.Argument(metavar="STUDY", help="Folder of a movie's study, or of a batch.", show_default=False),
]
Signal = Annotated[
    Path | None,
    typer.Option(
        metavar="PATH",
        help="Image to measure, of the same height and width: one file; or a folder, or a pattern in quotes, "
        "of one file a frame.",
    ),
]
SignalFiles = Annotated[
    Path | None,
    typer.Option(
        metavar="PATH",
        help="Image to measure, of the same height and width, in any of these formats. For a folder of "
        "masks: a folder of images with the same names, or how their names end, such as _img.",
    ),
]
NucleiFiles = Annotated[
    Path | None,
    typer.Option(
        metavar="PATH",
        help="Nuclei of the cells, of the same height, width and frames: label image or 0/1 mask, in any of "
        "these formats; each goes to the cell that holds most of it. For a folder of masks: a folder with "
        "the same names, or how their names end, such as _nuclei.",
    ),
]
MovieNuclei = Annotated[
    Path | None,
    typer.Option(
        metavar="PATH",
        help="Nuclei of the cells, of the same height, width and frames: label images or 0/1 masks, in any "
        "of these formats; in each frame a nucleus goes to the cell that holds most of it.",
    ),
]
GroupsFile = Annotated[
    Path | None,
    typer.Option(
        metavar="TABLE",
        help="What was done to which cell: a CSV table with the columns file, cell (its label) or frame, and "
        "condition, experiment or your own. Those become columns of the table of cells.",
    ),
]
OutFolder = Annotated[
    Path,
    typer.Option("--out", "-o", metavar="FOLDER", help="Folder for the results.", show_default=False),
]
ParametersFile = Annotated[
    Path | None,
    typer.Option(
        metavar="PATH",
        help="File with parameters, such as parameters.toml of an earlier study. Flags overrule it.",
    ),
]
Figures = Annotated[
    int, typer.Option(metavar="NUMBER", help="Number of cells to draw, from the first; -1 for all.")
]
CellFigures = Annotated[
    int,
    typer.Option(
        metavar="NUMBER",
        help="Number of cells with a page of their own, from the first; -1 for all, 0 for none: the overview "
        "of several cells, and that of their nuclei, are drawn all the same.",
    ),
]
NoReport = Annotated[
    bool, typer.Option("--no-report", help="Do without the page report.html, which takes a second or two.")
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")]


@dataclass(frozen=True)
class Given:
    """Parameters as they were given on the command line.

    Attributes
    ----------
    values : dict
        By name, only those with a flag.
    file : Path or None
        That of `--parameters`.
    flags : dict of str to str
        By name.
    groups : Path or None
        That of `--groups`.
    """

    values: dict[str, Any]
    file: Path | None
    flags: dict[str, str]
    groups: Path | None = None

    def of(self, model: type[Group]) -> Group:
        """The parameters that a command works with; errors name the flags."""
        from cytodisk.runs.parameters_file import parameters_from

        with earlier_version_lines(lambda words: print(f"Warning: {words}", file=sys.stderr)):
            return parameters_from(self._those_of(model), self.file, model, self.flags)

    def options(self, model: type[Group]) -> Group:
        """Options of a run, which no file holds; errors name the flags."""
        return model.called(self._those_of(model), self.flags)

    def formats(self, figures: int) -> tuple[str, ...]:
        """Formats of the figures that a command draws, none where it draws none.

        Raises
        ------
        ParameterError
            A format is unknown, or one is given where no figure is drawn.
        """
        from cytodisk.errors import ParameterError
        from cytodisk.runs.run_options import FigureOptions

        chosen = self.options(FigureOptions).format
        if not figures and "format" in self.values:
            none = "--no-figures" if figures is False else "--figures 0"
            raise ParameterError(f"--format says how to write figures, {none} to draw none: leave one out")
        return chosen if figures else ()

    def _those_of(self, model: type[Parameters]) -> dict[str, Any]:
        return {name: value for name, value in self.values.items() if name in model.model_fields}

    def beyond(self, *models: type[Parameters]) -> list[str]:
        """Flags of parameters that none of the models has."""
        known = fields_of(models)
        return [self.flags[name] for name in self.values if name not in known]


def with_parameters(
    *models: type[Parameters],
    modes: Mapping[str, type[Parameters]] | None = None,
    file: bool = True,
    groups: Any = None,
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command an option for every field of its models, in the place of its parameter `given`.

    Parameters
    ----------
    *models : type of Parameters
        Of a field that several have, the first counts.
    modes : mapping of str to type of Parameters, optional
        By a flag, such as `--movie`, the model of the command with it, which has more fields or other
        defaults; the help says which.
    file : bool
        Whether there is `--parameters`, too.
    groups : annotation, optional
        Of `--groups`, for commands that have it, as `GroupsFile`.

    Returns
    -------
    callable
        A decorator. The command gets what was given as `given`, a `Given`.
    """
    modes = {} if modes is None else modes
    fields = fields_of((*models, *modes.values()))
    more = _with_modes(fields_of(models), modes)
    flags = {name: flag_of(name, field) for name, field in fields.items()}

    def show(command: Callable[..., None]) -> Callable[..., None]:
        def run(**values: Any) -> None:
            texts = {name: values.pop(name) for name in fields}
            given = {
                name: value_of_text(fields[name], value) if isinstance(value, str) else value
                for name, value in texts.items()
                if value is not None
            }
            path, of_groups = values.pop("parameters", None), values.pop("groups", None)
            if path is not None and given.get("overwrite") and "out" in values:
                from cytodisk.store.removal import refuse_removal_of

                refuse_removal_of(path, values["out"])
            command(**values, given=Given(given, path, flags, of_groups))

        shown: list[inspect.Parameter] = []
        for one in inspect.signature(command).parameters.values():
            if one.name != "given":
                shown.append(one.replace(kind=inspect.Parameter.KEYWORD_ONLY))
                continue
            shown += [_option(name, field, more.get(name, "")) for name, field in fields.items()]
            if file:
                shown.append(_keyword("parameters", ParametersFile))
            if groups is not None:
                shown.append(_keyword("groups", groups))
        run.__signature__ = inspect.Signature(shown)  # type: ignore[attr-defined]
        run.__annotations__ = {one.name: one.annotation for one in shown}
        run.__doc__, run.__name__ = command.__doc__, command.__name__
        return run

    return show


def _with_modes(fields: dict[str, FieldInfo], modes: Mapping[str, type[Parameters]]) -> dict[str, str]:
    """What flags such as `--movie` change, by field: that there is one, or its default."""
    only: dict[str, list[str]] = {}
    other: dict[str, list[str]] = {}
    for flag, model in modes.items():
        for name, field in model.model_fields.items():
            if name not in fields:
                only.setdefault(name, []).append(flag)
            elif field.default != fields[name].default:
                other.setdefault(name, []).append(f"with {flag} {default_words(field)}")
    needed = {name: f"only with {' or '.join(flags)}" for name, flags in only.items()}
    return needed | {name: "; ".join(words) for name, words in other.items()}


def _option(name: str, field: FieldInfo, more: str) -> inspect.Parameter:
    """The option of one field: its flag, and its help with range and default."""
    wanted, flag = kinds(field.annotation), flag_of(name, field)
    kind: Any = str
    if bool in wanted:
        kind, flag = bool, f"{flag}/--no-{flag.removeprefix('--')}"
    words = choices(field.annotation)
    numbers = ["NUMBER"] * (float in wanted)  # as "NUMBER|area"
    metavar = "|".join([*numbers, *words]) if words and tuple not in wanted else None
    if metavar is not None and len(metavar) > _LONGEST_CHOICE:  # the help lists them
        metavar = _TEXTS.get(name, "NAME")
    if not wanted & {bool, str, tuple}:  # a text for the parser, so that errors are the model's
        metavar = "NUMBER"
    if tuple in wanted and not words:
        metavar = "FIRST:LAST" if tuple_items(field.annotation) == (int, int) else "A,B,…"
    if str in wanted and (not words or tuple in wanted):
        metavar = _TEXTS.get(name, "TEXT")
    option = typer.Option(flag, help=help_words(field, more), metavar=metavar, show_default=False)
    return _keyword(name, Annotated[kind | None, option])


_LONGEST_CHOICE = 66  # letters
_TEXTS = {"scene": "NAME", "mask_channel": "NAME", "z": "SLICE", "tracks": "PATH", "align": "ANGLE"}
"""What stands behind a flag in its help where that is more than some text."""


def _keyword(name: str, annotation: Any) -> inspect.Parameter:
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=annotation)
