"""Forms have what the command line has: the same parameters, headings, ranges and words."""

import shlex
import sys
from collections.abc import Callable
from typing import Any

import pytest

from cytodisk.cli import app, main
from cytodisk.cli.help_groups import flag_name
from cytodisk.errors import ParameterError
from cytodisk.parameters import Parameters
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.run_options import MapOptions, RunOptions
from cytodisk.taking import fields_of

pytestmark = pytest.mark.slow

TYPED = {
    "map": {
        "pixel_size_um": 0.16,
        "channels": ("Rac1", "Rho A"),
        "kind": "labels",
        "label": True,
        "nucleus_radius": "area",
        "depth_um": (0.5, 1.0, 2.0),
        "align": -30.0,
        "nan": "omit",
        "shape_weight": 0.01,
        "edge_length": 0.8,
    },
    "movie": {
        "frame_interval_s": 5.0,
        "link": False,
        "nucleus_radius": 0.4,
        "align": (12.5, 30.0),
        "registration": False,
        "tension": 0.02,
        "renew_every": 7,
    },
    "correlate": {
        "max_lag": 12,
        "frames": (3, 80),
        "sectors": (50, 5),
        "without_frames": (17, 24),
        "skip_lags": (-1, 0),
        "control": ("GFP",),
        "geometry": False,
        "statistic": "spearman",
        "name": "it's mine",
    },
}
MODELS: dict[str, type[Parameters]] = {
    "map": MapParameters,
    "movie": MovieParameters,
    "correlate": CorrelateParameters,
}


@pytest.fixture
def form(qtbot: Any) -> Callable[..., Any]:
    from cytodisk.napari.forms.parameter_form import ParameterForm

    def make(*models: type[Parameters], **settings: Any) -> Any:
        made = ParameterForm(*models, **settings)
        qtbot.addWidget(made)
        return made

    return make


def parameters_of(monkeypatch: pytest.MonkeyPatch, command: str, line: str) -> Parameters:
    """The parameters that the command line gives to the library."""
    seen: list[Parameters] = []

    def stop(*_: Any, **__: Any) -> Any:
        seen.extend(one for one in (*_, *__.values()) if isinstance(one, MODELS[command]))
        raise SystemExit(0)

    monkeypatch.setattr("cytodisk.runs.cells.cell_inputs.open_inputs", stop)
    monkeypatch.setattr("cytodisk.runs.movie.movie_inputs.open_movie", stop)
    monkeypatch.setattr("cytodisk.runs.correlate.correlate_study.correlate_study", stop)
    monkeypatch.setattr("cytodisk.cli.correlate_command.opened", lambda *_: None)
    monkeypatch.setattr("cytodisk.cli.correlate_command.earlier_settings", lambda *_: None)
    monkeypatch.setattr(sys, "argv", shlex.split(line))
    with pytest.raises(SystemExit):
        main()
    return seen[0]


@pytest.mark.parametrize("command", TYPED)
def test_the_line_of_a_form_gives_the_same_parameters(
    command: str, form: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    from cytodisk.napari.forms.command_line import command_line

    there = form(MODELS[command])
    there.set_values(TYPED[command])
    files = ["some masks.tif", "-o", "out"] if command != "correlate" else ["study", "--signal", "Rac1"]

    line = command_line(command, files, there.values())

    assert there.values() == TYPED[command]
    parsed = parameters_of(monkeypatch, command, line)
    assert parsed == there.model(MODELS[command]) == MODELS[command](**TYPED[command])


@pytest.mark.parametrize(
    ("command", "model", "options", "beside"),
    [
        ("map", MapParameters, MapOptions, ()),
        ("movie", MovieParameters, RunOptions, ()),
        ("correlate", CorrelateParameters, None, ("with",)),
    ],
)
def test_headings_are_those_of_the_help(
    command: str, model: Any, options: Any, beside: Any, form: Callable[..., Any]
) -> None:
    models = [model] if options is None else [model, options]
    there = form(*models, beside=beside)
    real = app.commands[command].loaded
    arguments = ["x"] if command == "correlate" else ["x", "-o", "y"]
    help_text = real.get_help(real.make_context(command, arguments))

    assert set(there.editors) == set(fields_of(models))
    headings = [section.heading for section in there.sections]
    assert [line[:-1] for line in help_text.splitlines() if line[:-1] in headings] == headings
    assert [section.is_open for section in there.sections] == [True] + [False] * (len(headings) - 1)
    flags = {f"--{flag_name(one)}" for one in real.params}
    assert set(there.flags.values()) <= flags


def test_an_empty_form_has_the_defaults(form: Callable[..., Any]) -> None:
    there = form(MovieParameters, main=("sectors", "layers"), without=("tracks",))

    assert there.values() == {}
    assert there.model(MovieParameters) == MovieParameters()
    assert "tracks" not in there.editors
    assert there.sections[0].heading == "Main settings"
    assert there.editors["sectors"].lineEdit().placeholderText() == "60"
    tip = there.editors["smoothness_px2"].toolTip()
    assert "px²" in tip
    assert "default 64" in tip
    assert "--smoothness-px2" in tip


def test_wrong_values_are_refused_with_the_words_of_the_command_line(form: Callable[..., Any]) -> None:
    there = form(MapParameters)
    there.editors["sectors"].lineEdit().setText("0")
    there.editors["depth_um"].setText("1,x")

    with pytest.raises(ParameterError, match=r"--sectors must be a whole number from 1 to 100000, got 0"):
        there.model(MapParameters)
    assert "--depth-um must be a list of numbers" in there.fault_words("depth_um")
    there.editors["sectors"].lineEdit().setText("")
    assert there.fault_words("sectors") == ""


def test_two_that_exclude_each_other_are_told_by_their_flags(form: Callable[..., Any]) -> None:
    there = form(MapParameters, RunOptions)
    there.set_values({"resume": True, "overwrite": True})

    with pytest.raises(ParameterError, match="--resume and --overwrite exclude each other"):
        there.model(RunOptions)


def test_arrows_keep_to_the_range(form: Callable[..., Any]) -> None:
    box = form(MapParameters).editors["layers"]

    box.stepBy(1)
    assert box.value() == 11
    box.stepBy(-20)
    assert box.value() == 1

    weight = form(MapParameters).editors["shape_weight"]
    weight.stepBy(-1)
    assert weight.value() == 0.002
    for _ in range(12):
        weight.stepBy(-1)
    assert weight.value() == pytest.approx(0.00009, rel=0.2)


def test_changed_values_are_told(form: Callable[..., Any], qtbot: Any) -> None:
    there = form(MapParameters)

    with qtbot.waitSignal(there.changed, timeout=1000):
        there.editors["label"].setChecked(True)
    assert there.values() == {"label": True}
