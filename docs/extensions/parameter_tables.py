"""Sphinx extension: write `reference/parameters.rst`, the parameters of each command, from their models."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from public_names import heading, write

from cytodisk.parameter_words import flag_of, range_words, unit_of, value_words
from cytodisk.parameters import Parameters
from cytodisk.runs.compare_windows.compare_parameters import (
    CompareMovieParameters,
    CompareNucleiParameters,
    CompareWindowsParameters,
)
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.population.population_parameters import PopulationParameters
from cytodisk.runs.population.power.power_parameters import PowerParameters
from cytodisk.runs.predict.predict_parameters import PredictParameters
from cytodisk.runs.run_options import BatchOptions, MapOptions, RunOptions
from cytodisk.runs.shapes.shape_parameters import ShapeParameters
from cytodisk.runs.waves.wave_run_parameters import WavesParameters
from cytodisk.store.spatial.place_parameters import SpatialParameters

if TYPE_CHECKING:
    from sphinx.application import Sphinx

MODELS: dict[str, type[Parameters]] = {
    "cytodisk map": MapParameters,
    "cytodisk movie": MovieParameters,
    "cytodisk correlate": CorrelateParameters,
    "cytodisk predict": PredictParameters,
    "cytodisk waves": WavesParameters,
    "cytodisk shapes": ShapeParameters,
    "cytodisk compare-windows": CompareWindowsParameters,
    "cytodisk compare-windows --movie": CompareMovieParameters,
    "cytodisk compare-windows --nuclei": CompareNucleiParameters,
    "cytodisk population": PopulationParameters,
    "cytodisk population --power": PowerParameters,
    "cytodisk export": SpatialParameters,
    "cytodisk batch": BatchOptions,
}
WORDS = """A parameter has one name: the keyword in Python, the key in ``parameters.toml`` and, with dashes,
the flag on the command line. ``--parameters out/parameters.toml`` reads a file; flags overrule it."""
OPTIONS_WORDS = """These options do not change the results. ``parameters.toml`` does not hold them."""


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("config-inited", write_page)
    return {"parallel_read_safe": True}


def write_page(app: Sphinx, _config: Any) -> None:
    lines = [*heading("Parameters", "="), WORDS, ""]
    lines += [*heading("How a run is done", "-"), OPTIONS_WORDS, "", *model_table(RunOptions)]
    lines += ["``cytodisk map`` also has", "", *model_table(MapOptions, beyond=RunOptions)]
    for command, model in MODELS.items():
        lines += [*heading(f"``{command}``", "-"), *model_table(model)]
    write(Path(app.srcdir) / "reference" / "parameters.rst", lines)


def model_table(model: type[Parameters], beyond: type[Parameters] = Parameters) -> list[str]:
    """A row for each field: name and flag, default, what it may be, what it does.

    Fields that `beyond` has are left out.
    """
    lines = [".. list-table::", "   :header-rows: 1", "   :class: small", "   :widths: 22 12 22 44", ""]
    lines += ["   * - Name, flag", "     - Default", "     - May be", "     - What it does"]
    for name, field in model.model_fields.items():
        if name in beyond.model_fields:
            continue
        unit = unit_of(field)
        default = "" if field.default in (None, (), "") else f"``{value_words(field.default)}``"
        allowed = range_words(field) + (f", in {unit}" if unit else "")
        flag = flag_of(name, field)
        flags = f"``{flag}``" if field.annotation is not bool else f"``{flag}``, ``--no-{flag[2:]}``"
        lines += [f"   * - | ``{name}``", f"       | {flags}", f"     - {default}"]
        lines += [f"     - {plain(allowed)}", f"     - {plain(field.description or '')}"]
    return [*lines, ""]


def plain(text: str) -> str:
    """Text in which reStructuredText finds no markup."""
    for character in "\\*`|_":
        text = text.replace(character, "\\" + character)
    return text
