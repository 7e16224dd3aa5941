"""Whether studies measured the same thing, so that their windows can be compared one by one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from cytodisk.analysis.shape.score_parameters import ScoreParameters
from cytodisk.errors import PopulationError
from cytodisk.images.file_parameters import MovieKindParameters
from cytodisk.images.nuclei.nuclei_parameters import NucleiFileParameters
from cytodisk.images.short_lists import shortened
from cytodisk.parameter_words import value_words
from cytodisk.parameters import Parameters
from cytodisk.runs.cells.cell_parameters import FileParameters, PlainCellParameters
from cytodisk.runs.cells.nuclei_given import ONLY_WITH_NUCLEI
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.shapes.shape_parameters import ShapeParameters
from cytodisk.scale_parameters import ScaleParameters
from cytodisk.store.provenance_file import command_of, maps_version

MODELS: dict[str, type[Parameters]] = {
    "map": MapParameters,
    "movie": MovieParameters,
    "shapes": ShapeParameters,
}
_READING = (
    MovieKindParameters,
    FileParameters,
    NucleiFileParameters,
    PlainCellParameters,
    ScaleParameters,
)
ALIGN = "align"
_MAY_DIFFER = {name for model in (*_READING, ScoreParameters) for name in model.model_fields} - {"z"} | {
    ALIGN
}
_GRID = ("layers", "sectors", "spacing", "depth_um", "nucleus_layers", "nucleus_radius")


def check_alike(studies: Sequence[FoundStudy]) -> list[str]:
    """Refuse studies whose windows, or features, do not go together.

    Parameters
    ----------
    studies : sequence of FoundStudy

    Returns
    -------
    list of str
        What a user should know of them all the same.

    Raises
    ------
    PopulationError
        They differ in the kind of run, nuclei, units, version of the maps, grid, or anything else that
        decides values; the message names it, and the studies.
    """
    _same(studies, "the kind of run", command_of_study, "put studies of one command together")
    _same(
        studies,
        "nuclei",
        lambda study: "with nuclei" if study.has_nuclei else "without",
        "run all of them with --nuclei, or none",
    )
    _same(
        studies,
        "the unit of lengths",
        lambda study: study.length_unit,
        "run all of them again with --pixel-size",
    )
    _same(
        studies,
        "the version of their maps",
        lambda study: str(maps_version(study.provenance)),
        "windows lie at other places; run the older ones again with --overwrite",
    )
    for name in sorted(_deciding(studies[0]), key=lambda name: name not in _GRID):
        _same(studies, name, _setting(name), _remedy(studies[0], name))
    return list(_warnings(studies))


def setting_of(study: FoundStudy, name: str) -> Any:
    """Value of a parameter of a study; of one that an earlier version did not have, the default."""
    field = MODELS[study.run].model_fields.get(name)
    default = None if field is None else field.get_default()
    return study.parameters.get(name, default)


def common_scale(studies: Sequence[FoundStudy]) -> dict[str, Any]:
    """Unit of lengths, and µm per pixel and seconds per frame: None where unknown, or where studies differ.

    Parameters
    ----------
    studies : sequence of FoundStudy
        With one unit of lengths.
    """
    found: dict[str, Any] = {"length_unit": studies[0].length_unit}
    for name in ("pixel_size_um", "frame_interval_s"):
        values = {study.provenance.get(name) for study in studies}
        found[name] = values.pop() if len(values) == 1 else None
    return found


def command_of_study(study: FoundStudy) -> str:
    """The command that wrote a study."""
    return command_of(study.provenance)


def _deciding(study: FoundStudy) -> Iterator[str]:
    """Parameters that values depend on."""
    for name in MODELS[study.run].model_fields:
        if name not in _MAY_DIFFER and (study.has_nuclei or name not in ONLY_WITH_NUCLEI):
            yield name


def _setting(name: str) -> Callable[[FoundStudy], str]:
    def words(study: FoundStudy) -> str:
        value = setting_of(study, name)
        return "none" if value is None else value_words(value)

    return words


def _remedy(study: FoundStudy, name: str) -> str:
    extra: Any = MODELS[study.run].model_fields[name].json_schema_extra
    flag = extra["flag"] or name.replace("_", "-")
    what = "windows of one number lie at other places" if name in _GRID else "values mean something else"
    return f"{what}; run them again with the same --{flag}"


def _same(studies: Sequence[FoundStudy], what: str, of: Callable[[FoundStudy], str], remedy: str) -> None:
    """Raise PopulationError where studies differ, with which has what."""
    found: dict[str, list[str]] = {}
    for study in studies:
        found.setdefault(of(study), []).append(study.name)
    if len(found) > 1:
        words = "; ".join(f"{value} in {shortened(names)}" for value, names in found.items())
        raise PopulationError(f"studies differ in {what}: {words}: {remedy}")


def _warnings(studies: Sequence[FoundStudy]) -> Iterator[str]:
    aligned = {_setting(ALIGN)(study) for study in studies if study.run != "shapes"}
    if len(aligned) > 1:
        yield (
            f"studies differ in align ({', '.join(sorted(aligned))}): sector 0 is not the same place in "
            "their cells; align the population, as by nucleus or axis, or compare without sectors"
        )
