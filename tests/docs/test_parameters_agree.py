"""A parameter is declared once: Python, TOML, flags, help and docs show the same names and defaults."""

import inspect
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import cytodisk as cd
from cytodisk.cli import app
from cytodisk.motion.demons_parameters import DemonsParameters
from cytodisk.parameter_words import default_words, flag_of, unit_of
from cytodisk.parameters import Parameters
from cytodisk.runs.parameters_file import parameters_from, write_parameters
from cytodisk.taking import fields_of

sys.path.insert(0, str(Path(__file__).parents[2] / "docs" / "extensions"))
from parameter_tables import MODELS, model_table

COMMANDS: dict[str, tuple[Callable[..., Any], tuple[type[Parameters], ...]]] = {
    "map": (cd.run_map, (cd.MapParameters, cd.MapOptions)),
    "movie": (cd.run_movie, (cd.MovieParameters, cd.RunOptions)),
    "shapes": (cd.run_shapes, (cd.ShapeParameters, cd.RunOptions)),
    "correlate": (cd.run_correlate, (cd.CorrelateParameters,)),
    "predict": (cd.run_predict, (cd.PredictParameters,)),
    "waves": (cd.run_waves, (cd.WavesParameters,)),
    "compare-windows": (
        cd.run_compare_windows,
        (
            cd.CompareWindowsParameters,
            cd.CompareMovieParameters,
            cd.CompareNucleiParameters,
            cd.RunOptions,
        ),
    ),
    "population": (cd.run_population, (cd.PopulationParameters, cd.FolderOptions)),
    "batch": (cd.run_batch, (cd.BatchOptions,)),
    "export": (cd.run_export, (cd.SpatialParameters, cd.ExportOptions)),
}
FUNCTIONS = (
    cd.map_to_disk,
    cd.polar_windows,
    cd.edge_windows,
    cd.spring_windows,
    cd.ring_windows,
    cd.nucleus_ring_windows,
    cd.interpolated_ring_windows,
    cd.sample,
    cd.sample_movie,
    cd.map_movie,
    cd.prepare_series,
    cd.cross_correlate,
    cd.peak_correlation,
    cd.correlate_pairs,
    cd.complexity_score,
    cd.average_around,
    cd.simulate.movie,
    cd.simulate.independent_series,
    cd.simulate.coupled_series,
    cd.simulate.predicting_series,
    cd.simulate.wave_series,
    cd.simulate.predicting_movie,
    cd.simulate.wave_movie,
)
UNITS = {"_um": "µm", "_s": "s", "_px": "px", "_px2": "px²"}


def all_models(base: type[Parameters] = Parameters) -> set[type[Parameters]]:
    return {base}.union(*(all_models(one) for one in base.__subclasses__())) - {Parameters}


@pytest.mark.parametrize("model", sorted(all_models(), key=lambda model: model.__name__))
def test_every_parameter_has_a_sentence_a_default_and_a_unit(model: type[Parameters]) -> None:
    assert model.__doc__
    for name, field in model.model_fields.items():
        assert not field.is_required(), name
        assert str(field.description).endswith("."), name
        for ending, unit in UNITS.items():
            assert not name.endswith(ending) or unit_of(field).split("/")[0] == unit, name
    model()  # the defaults are in their ranges


@pytest.mark.parametrize("command", COMMANDS)
def test_keywords_flags_and_help_are_those_of_the_models(command: str) -> None:
    function, models = COMMANDS[command]
    shown = inspect.signature(function).parameters
    options = {
        option.name: option
        for option in app.commands[command].loaded.params  # type: ignore[attr-defined]
    }
    for name, field in fields_of(models).items():
        assert shown[name].default == field.default, name
        assert f"{name} : " in (function.__doc__ or ""), name
        assert flag_of(name, field) in options[name].opts, name
        words = " ".join(options[name].help.split())
        assert str(field.description) in words
        assert default_words(field) in words


@pytest.mark.parametrize("command", MODELS)
def test_the_docs_table_and_the_file_have_the_fields_of_the_model(command: str, tmp_path: Path) -> None:
    model = MODELS[command]
    table = "\n".join(model_table(model))
    for name, field in model.model_fields.items():
        assert f"``{name}``" in table
        assert f"``{flag_of(name, field)}``" in table
    assert table.count("* - ") == 1 + len(model.model_fields)
    write_parameters(model(), tmp_path / "parameters.toml")
    written = tomllib.loads((tmp_path / "parameters.toml").read_text(encoding="utf-8"))
    assert set(written) == {name for name, field in model.model_fields.items() if field.default is not None}
    assert parameters_from({}, tmp_path / "parameters.toml", model) == model()


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: function.__name__)
def test_functions_refuse_names_that_they_do_not_show(function: Callable[..., Any]) -> None:
    own = [one for one in inspect.signature(function).parameters.values() if one.default is one.empty]
    with pytest.raises(cd.errors.CytodiskError, match="no parameter 'colour'"):
        function(**{one.name: cd.simulate.disk(5) for one in own}, colour="red")


def test_an_unknown_name_suggests_the_nearest() -> None:
    with pytest.raises(cd.errors.ParameterError, match=r"no parameter 'metod': did you mean method\?"):
        cd.map_to_disk(cd.simulate.disk(5), metod="harmonic")
    with pytest.raises(cd.errors.ParameterError, match=r"gvf_mu must be a number above 0 and at most 0\.25"):
        DemonsParameters(gvf_mu=0.3)


def test_positions_and_names_can_be_mixed_but_not_doubled() -> None:
    assert cd.polar_windows(3, sectors=7) == cd.polar_windows(layers=3, sectors=7, spacing="area")
    with pytest.raises(cd.errors.WindowError, match="layers is given twice"):
        cd.polar_windows(3, layers=3)


@pytest.mark.parametrize("command", ["map", "movie", "shapes", "compare-windows"])
def test_a_run_lists_its_parameters_and_options(command: str) -> None:
    run, _ = COMMANDS[command]
    with pytest.raises(cd.errors.ParameterError, match=r"no parameter 'bogus'.* resume, overwrite, workers"):
        run("masks.tif", "out", bogus=2)
    with pytest.raises(cd.errors.ParameterError, match=r"did you mean workers\?"):
        run("masks.tif", "out", worker=2)
    with pytest.raises(cd.errors.ParameterError, match="resume and overwrite exclude each other"):
        run("masks.tif", "out", resume=True, overwrite=True)
    with pytest.raises(cd.errors.ParameterError, match="masks must be a path, got NoneType"):
        run(None, "out", resume=False, overwrite=True)
