"""Options of a run that do not change its results, beside what decides them."""

from collections.abc import Callable, Mapping
from typing import Any, ClassVar, Literal, Self, TypeAlias

from pydantic import field_validator

from cytodisk.parameter_words import unknown_words
from cytodisk.parameters import Parameters, in_full, parameter

Progress: TypeAlias = Callable[[int, int], None]
"""Called with (done, in all)."""


def silent(done: int, total: int) -> None:
    """Report nothing."""


class Options(Parameters):
    """Options of a run, which its results do not depend on."""

    @classmethod
    def split(cls, settings: Mapping[str, Any], model: type[Parameters]) -> tuple[Self, dict[str, Any]]:
        """These options out of some settings, and the settings that are left for a model.

        Raises
        ------
        ParameterError
            A name is neither an option nor one of the model's, or an option is out of its range.
        """
        known = [*model.model_fields, *cls.model_fields]
        if unknown := [unknown_words(name, known) for name in settings if name not in known]:
            raise cls.fault("; ".join(unknown))
        own = {name: value for name, value in settings.items() if name in cls.model_fields}
        return cls(**own), {name: value for name, value in settings.items() if name not in own}


class TableOptions(Options):
    """How tables are written."""

    csv: bool = parameter(False, "Write every table as CSV too, for Excel and other programs.")


class FigureOptions(Parameters):
    """How figures are written."""

    format: tuple[Literal["png", "pdf", "svg"], ...] = parameter(
        ("png",), "Of figures; text stays text in pdf and svg. Animations are always GIFs."
    )

    @field_validator("format", mode="before")
    @classmethod
    def _each_once(cls, value: Any) -> Any:
        """In small letters, each once."""
        given = [value] if isinstance(value, str) else value
        names = tuple(dict.fromkeys(str(name).strip().lower() for name in given))
        wrong = [name for name in names if name not in ("png", "pdf", "svg")]
        if wrong or not names:
            came = ", ".join(map(repr, wrong)) or "none"
            raise in_full(f"must be png, pdf, svg or several with commas between, got {came}")
        return names


class FolderOptions(TableOptions):
    """How a run treats the folder that it writes."""

    exclusive: ClassVar[tuple[tuple[str, str], ...]] = (("resume", "overwrite"),)

    resume: bool = parameter(False, "Go on with the same run in this folder.")
    overwrite: bool = parameter(False, "Replace the results in this folder.")

    @property
    def again(self) -> dict[str, bool]:
        """What to do with results that are there; see `StudyFolder.start`."""
        return {"resume": self.resume, "overwrite": self.overwrite}


class PopulationOptions(FolderOptions):
    """How a run of `cytodisk population` is done."""

    h5ad: bool = parameter(
        False, "Write the cells and their windows as population.h5ad too, for scanpy; needs anndata."
    )


class ExportOptions(Options):
    """How files for other programs are written."""

    overwrite: bool = parameter(False, "Replace files of the same names.")


class RunOptions(FolderOptions):
    """How a run is done."""

    workers: int = parameter(1, "Number of processes. The results do not depend on it.", least=1, most=1024)


class MapOptions(RunOptions):
    """How a run of `cytodisk map` is done."""

    maps: bool = parameter(True, "Keep the map of each cell. Without them the study takes less disk space.")
    geojson: bool = parameter(False, "Write the outlines of windows beside the maps.")

    @property
    def writes(self) -> dict[str, str]:
        """What is written for each cell, and how to do without; see `StudyRun`."""
        wanted = {"maps": (self.maps, "pass --no-maps")}
        wanted["outlines of windows"] = (self.geojson, "leave --geojson out")
        return {what: instead for what, (is_wanted, instead) in wanted.items() if is_wanted}


class BatchOptions(RunOptions):
    """How a batch is done."""

    csv: bool = parameter(
        False,
        "Write every merged table as CSV too, for Excel and other programs; inputs.csv is always there.",
    )
    time_limit: float | None = parameter(
        None, "Longest time that one input may take; without it any.", above=0, most=1e9, unit="s"
    )
    scheduler: str | None = parameter(
        None, "Address of a Dask scheduler, such as tcp://host:8786, whose workers do the inputs."
    )
