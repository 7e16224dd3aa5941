"""Every number that a user can give has a range in its declaration; beyond it the words say what can be."""

from importlib import import_module
from pkgutil import walk_packages

import pytest

import cytodisk
from cytodisk.disk.circle import parse_align
from cytodisk.errors import CytodiskError, ParameterError
from cytodisk.parameter_words import kinds
from cytodisk.parameters import Parameters
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.run_options import BatchOptions, MapOptions
from cytodisk.scale import Scale

_ANY = {"depth_px"}  # a cell is one layer where layers are thicker than it is deep


def _models(of: type[Parameters] = Parameters) -> list[type[Parameters]]:
    return [model for below in of.__subclasses__() for model in (below, *_models(below))]


def test_every_number_has_limits_on_both_sides() -> None:
    for module in walk_packages(cytodisk.__path__, "cytodisk."):
        if module.name.endswith(("_parameters", "_options")):
            import_module(module.name)
    without = {
        name
        for model in _models()
        for name, field in model.model_fields.items()
        if model.__module__.startswith("cytodisk.")
        and "simulate" not in model.__module__
        and kinds(field.annotation) & {int, float}
        and name not in ("align", "nucleus_radius")  # held by their own checks
        for sides in (("gt", "ge"), ("lt", "le"))
        if not any(hasattr(part, side) for part in field.metadata for side in sides)
    }
    assert without <= _ANY


@pytest.mark.parametrize(
    ("model", "name", "value", "words"),
    [
        (MapParameters, "pixel_size_um", 1e200, "from 0.000001 to 1000000, got 1e+200"),
        (MapParameters, "pixel_size_um", 1e-200, "from 0.000001 to 1000000, got 1e-200"),
        (MapParameters, "pixel_size_um", float("nan"), "from 0.000001 to 1000000, got nan"),
        (MapParameters, "shape_weight", 1e308, "above 0 and at most 1000000, got 1e+308"),
        (MapParameters, "layers", 10**400, "from 1 to 100000, got 1000000"),
        (MapParameters, "sectors", -3, "from 1 to 100000, got -3"),
        (MapParameters, "depth_um", (1e200,), "got (1e+200,)"),
        (MovieParameters, "frame_interval_s", float("inf"), "from 0.000001 to 1000000, got inf"),
        (MovieParameters, "renew_every", 10**30, "from 1 to 1000000, got 1000000000"),
        (MovieParameters, "inertia", 1e300, "from 0 to 1000000, got 1e+300"),
        (CorrelateParameters, "surrogates", 10**6, "from 0 to 100000, got 1000000"),
        (CorrelateParameters, "max_lag", 2**70, "from 0 to 1000000, got 1180591620717411303424"),
        (CorrelateParameters, "seed", -1, f"from 0 to {2**128}, got -1"),
        (MapOptions, "workers", 10**6, "from 1 to 1024, got 1000000"),
        (BatchOptions, "time_limit", 1e300, "got 1e+300"),
    ],
)
def test_beyond_it_the_words_say_what_can_be(
    model: type[Parameters], name: str, value: object, words: str
) -> None:
    with pytest.raises(CytodiskError) as caught:
        model.of(**{name: value})
    assert f"{name} must be " in str(caught.value)
    assert words in str(caught.value)


def test_more_windows_than_memory_holds_are_refused() -> None:
    with pytest.raises(CytodiskError, match="layers × sectors must be at most 10000000, got 9000 × 90000"):
        MapParameters.of(layers=9000, sectors=90000)


@pytest.mark.parametrize("value", [1e200, (1.0, 1e308), float("nan"), -1e7])
def test_the_disk_is_turned_by_a_number_in_reach(value: object) -> None:
    with pytest.raises(ParameterError, match=r"align must be .* at most 1000000, got"):
        parse_align(value)


@pytest.mark.parametrize("value", [1e200, 5e-324, -1.0, float("inf"), "1", True])
def test_a_scale_by_itself_is_held_to_the_same(value: object) -> None:
    with pytest.raises(
        ParameterError, match=r"pixel_size_um must be a number from 0\.000001 to 1000000, got"
    ):
        Scale(value)  # type: ignore[arg-type]
