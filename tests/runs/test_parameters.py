import os
import tomllib
import warnings
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cytodisk.disk.mapping_parameters import MAPS_VERSION
from cytodisk.errors import EarlierVersionWarning, ParameterError
from cytodisk.runs.batch.batch_file import read_batch
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.parameters_file import parameters_from, write_parameters
from cytodisk.runs.shapes.shape_parameters import ShapeParameters
from cytodisk.store.provenance_file import MAPS

POSITIVE = st.floats(1e-6, 1e6)
NAMES = st.text(min_size=1, max_size=9).filter(lambda name: name.isprintable() and name.strip())
NUMBER = st.floats(-1e6, 1e6)


@given(
    given_values=st.fixed_dictionaries(
        {},
        optional={
            "kind": st.sampled_from(["auto", "mask", "stack", "labels"]),
            "method": st.sampled_from(["newton", "harmonic"]),
            "shape_weight": POSITIVE,
            "edge_length": st.floats(0.25, 10),
            "align": st.just("upright") | NUMBER | st.tuples(NUMBER, NUMBER),
            "layers": st.integers(1, 1000),
            "sectors": st.integers(1, 1000),
            "spacing": st.sampled_from(["area", "radius"]),
            "nan": st.sampled_from(["propagate", "omit"]),
            "pixel_size_um": st.none() | POSITIVE,
            "channels": st.none() | st.lists(NAMES, min_size=1, max_size=4, unique=True).map(tuple),
        },
    )
)
def test_parameters_survive_the_file(
    tmp_path_factory: pytest.TempPathFactory, given_values: dict[str, object]
) -> None:
    path = tmp_path_factory.mktemp("run") / "parameters.toml"
    parameters = parameters_from(given_values, None, MapParameters)
    write_parameters(parameters, path)
    assert parameters_from({}, path, MapParameters) == parameters


def test_every_parameter_that_is_set_stands_in_the_file(tmp_path: Path) -> None:
    write_parameters(MapParameters(), tmp_path / "a.toml")
    names = set(tomllib.loads((tmp_path / "a.toml").read_text(encoding="utf-8")))
    assert names == {name for name, field in MapParameters.model_fields.items() if field.default is not None}


def test_given_values_overrule_the_file(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text("layers = 3\nsectors = 7\n")
    parameters = parameters_from({"layers": 5, "sectors": None}, tmp_path / "a.toml", MapParameters)
    assert (parameters.layers, parameters.sectors) == (5, 7)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"layers": 0}, "layers must be a whole number from 1 to 100000, got 0"),
        ({"sectors": -2}, "sectors must be a whole number from 1 to 100000, got -2"),
        ({"layers": 2.5}, "layers must be a whole number.*got 2.5"),
        ({"layers": True}, "layers must be a whole number.*got True"),
        ({"layers": 4000, "sectors": 4000}, "layers × sectors must be at most 10000000, got 4000 × 4000"),
        (
            {"shape_weight": 0.0},
            "shape_weight must be a number above 0 and at most 1000000, got 0.0: 0.003 is the default",
        ),
        ({"edge_length": 0.1}, "edge_length must be a number from 0.25 to 10, got 0.1"),
        ({"edge_length": "0.5"}, "edge_length must be a number from 0.25 to 10, got '0.5'"),
        ({"method": "demons"}, "method must be one of newton, newton-triangles, .*, got 'demons'"),
        ({"kind": "cells"}, "kind must be one of auto, mask, stack, labels, got 'cells'"),
        ({"align": "left"}, "align must be 'upright', 'nucleus', a point .* got 'left'"),
        ({"pixel_size_um": -1.0}, "pixel_size_um must be a number from 0.000001 to 1000000, got -1.0"),
        ({"channels": ()}, r"channels: every channel needs a name that can be printed, got \(\)"),
        ({"channels": ("Rac1", " ")}, "channels: every channel needs a name"),
        ({"channels": ("Rac1", "a\nb")}, "channels: every channel needs a name"),
        ({"channels": ("a", "b", "a")}, r"channels: two channels have one name, got \('a', 'b', 'a'\)"),
        ({"channels": ("a", "velocity")}, "channels: velocity is the name of the edge's velocity"),
        ({"channels": ("velocity_cell_frame",)}, "channels: velocity_cell_frame is the name of the edge's"),
        ({"channels": "Rac1"}, "channels must be names, .* got 'Rac1'"),
        ({"channels": (1, 2)}, "channels must be names, .* got 1"),
        ({"laier": 2}, "no parameter 'laier': did you mean layers"),
    ],
)
def test_values_out_of_range_are_named(values: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        parameters_from(values, None, MapParameters)


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
@pytest.mark.parametrize("name", ["shape_weight", "edge_length", "align", "pixel_size_um"])
def test_numbers_must_be_finite(name: str, value: float) -> None:
    with pytest.raises(ParameterError, match=name):
        parameters_from({name: value}, None, MapParameters)


def test_all_faults_are_named_at_once() -> None:
    with pytest.raises(ParameterError, match=r"layers must .*; sectors must "):
        parameters_from({"layers": 0, "sectors": 0}, None, MapParameters)


@pytest.mark.parametrize("name", ['say "Rac1"', "back\\slash", "µ ~/.:", "#1 = [x]"])
def test_any_name_of_a_channel_survives_the_file(tmp_path: Path, name: str) -> None:
    parameters = parameters_from({"channels": (name, "other")}, None, MapParameters)
    write_parameters(parameters, tmp_path / "a.toml")
    assert parameters_from({}, tmp_path / "a.toml", MapParameters).channels == (name, "other")


@pytest.mark.parametrize("content", [b"layers = ", b"\xff\xfe", None])
def test_a_file_that_cannot_be_read_is_named(tmp_path: Path, content: bytes | None) -> None:
    if content is not None:
        (tmp_path / "a.toml").write_bytes(content)
    with pytest.raises(ParameterError, match=r"parameters file .*a\.toml cannot be read"):
        parameters_from({}, tmp_path / "a.toml", MapParameters)


def test_a_file_of_another_command_is_called_so(tmp_path: Path) -> None:
    write_parameters(MovieParameters(), tmp_path / "parameters.toml")
    words = (
        r"no parameters of this command \(frame_interval_s, tension\): perhaps it is that of another command"
    )
    (tmp_path / "mine.toml").write_text("layers = 3\ntension = 0.1\nframe_interval_s = 2.0\n")
    with pytest.raises(ParameterError, match=words):
        parameters_from({}, tmp_path / "mine.toml", MapParameters)
    (tmp_path / "provenance.json").write_text('{"fingerprint": {}, "run": "movie"}')
    with pytest.raises(ParameterError, match=r"tension, tracker.*cytodisk movie"):
        parameters_from({}, tmp_path / "parameters.toml", MapParameters)
    write_parameters(MapParameters(), tmp_path / "parameters.toml")
    (tmp_path / "provenance.json").write_text('{"fingerprint": {}}')
    with pytest.raises(ParameterError, match=r"layers, .*cytodisk map"):
        parameters_from({}, tmp_path / "parameters.toml", ShapeParameters)


def test_a_given_parameter_overrules_the_one_that_it_excludes() -> None:
    by_depth = MovieParameters.of(depth_um=2.0)
    assert by_depth.changed(layers=5).depth_um is None
    assert MovieParameters.of(layers=5).changed(depth_um=2.0).layers == MovieParameters().layers
    assert by_depth.changed(sectors=7).depth_um == (2.0,)
    with pytest.raises(ParameterError, match="exclude each other"):
        by_depth.changed(layers=5, depth_um=1.0)


def test_the_constructor_takes_one_of_two_that_exclude_each_other() -> None:
    with pytest.raises(ParameterError, match="layers and depth_um exclude each other: pass one of them"):
        MovieParameters(layers=10, depth_um=2.0)  # the default counts, too, where it is given
    assert MovieParameters(layers=4, depth_um=None).layers == 4
    assert MovieParameters(depth_um=2.0).changed(sectors=9).depth_um == (2.0,)
    assert MovieParameters(depth_um=2.0).part(MapParameters).layers == MapParameters().layers


def test_a_file_with_a_depth_has_no_layers_and_can_be_fed_back(tmp_path: Path) -> None:
    path, written = tmp_path / "parameters.toml", MovieParameters(depth_um=2.0, sectors=8)
    write_parameters(written, path)
    lines = path.read_text().splitlines()
    assert "depth_um = [2.0]" in lines
    assert not any(line.startswith(("layers", "spacing")) for line in lines)
    assert parameters_from({}, path, MovieParameters) == written


def test_a_file_with_layers_and_a_depth_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("layers = 5\ndepth_um = [0.3, 0.7]\n")
    with pytest.raises(ParameterError, match="layers and depth_um exclude each other"):
        parameters_from({}, path, MovieParameters)
    assert parameters_from({"layers": 3}, path, MovieParameters).layers == 3


EARLIER = 'layers = 4\nmethod = "newton"\nshape_weight = 0.005\nedge_length = 0.9\n'


def earlier_study(folder: Path, content: str = EARLIER, maps: str = "") -> Path:
    """The parameters file in a study's folder; without a version of the maps it is that of the first."""
    (folder / "provenance.json").write_text(
        f'{{"fingerprint": {{{maps}}}, "run": "map", "versions": {{"cytodisk": "0.1.0"}}}}'
    )
    (folder / "parameters.toml").write_text(content)
    return folder / "parameters.toml"


def test_values_of_earlier_maps_are_told(tmp_path: Path) -> None:
    path = earlier_study(tmp_path)
    with pytest.warns(EarlierVersionWarning) as told:
        assert parameters_from({}, path, MapParameters).shape_weight == 0.005
    assert [str(one.message) for one in told] == [
        f'parameters file {path} is for maps by cytodisk 0.1.0: method "newton" meant areas by triangle then '
        '("newton-triangles" now); shape_weight = 0.005 and edge_length = 0.9 are the defaults of that '
        "version. Read as they stand, they give maps that are neither those of then nor those of today: for "
        "today's maps copy the file and leave the three lines method, shape_weight and edge_length out"
    ]


@pytest.mark.parametrize(
    ("content", "given_values", "words"),
    [
        (EARLIER.replace("0.005", "0.1"), {}, "two lines method and edge_length out"),
        (EARLIER.replace("newton", "harmonic"), {}, "0.9 is the default of .* the line edge_length out"),
        (EARLIER, {"method": "newton-triangles"}, "two lines shape_weight and edge_length out"),
    ],
)
def test_only_what_meant_other_maps_is_named(
    tmp_path: Path, content: str, given_values: dict[str, object], words: str
) -> None:
    with pytest.warns(EarlierVersionWarning, match=words):
        parameters_from(given_values, earlier_study(tmp_path, content), MapParameters)


@pytest.mark.parametrize(
    ("content", "given_values", "maps"),
    [
        (EARLIER, {"method": "newton-triangles", "shape_weight": 0.005, "edge_length": 0.9}, ""),
        (EARLIER.replace("newton", "advection"), {}, ""),
        ("layers = 4\n", {}, ""),
        (f"# {MAPS} {MAPS_VERSION}\n{EARLIER}", {}, ""),
        (EARLIER, {}, f'"{MAPS}": {MAPS_VERSION}'),
    ],
)
def test_a_file_that_means_what_it_says_is_read_without_a_word(
    tmp_path: Path, content: str, given_values: dict[str, object], maps: str
) -> None:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        parameters_from(given_values, earlier_study(tmp_path, content, maps), MapParameters)
    assert not told


def test_a_file_says_which_maps_it_is_for_and_a_file_by_hand_need_not(tmp_path: Path) -> None:
    write_parameters(MapParameters(), tmp_path / "a.toml")
    assert (tmp_path / "a.toml").read_text().startswith(f"# {MAPS} {MAPS_VERSION};")
    (tmp_path / "parameters.toml").write_text(EARLIER)
    assert parameters_from({}, tmp_path / "parameters.toml", MapParameters).edge_length == 0.9


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in the file system")
@pytest.mark.parametrize("read", [lambda path: parameters_from({}, path, MapParameters), read_batch])
def test_a_pipe_is_no_file_of_parameters(tmp_path: Path, read: Callable[[Path], object]) -> None:
    os.mkfifo(tmp_path / "a.toml")  # of which a look that does not wait would read nothing, so no parameters
    with pytest.raises(ParameterError, match=r"a\.toml cannot be read: it is a pipe or a device, not a file"):
        read(tmp_path / "a.toml")


@pytest.mark.parametrize("path", ['a"b.xml', "a\\b.xml", "a\x7fb.xml", "ä\t.xml"])
def test_texts_with_any_characters_survive_the_file(tmp_path: Path, path: str) -> None:
    write_parameters(MovieParameters(tracks=path), tmp_path / "a.toml")
    assert parameters_from({}, tmp_path / "a.toml", MovieParameters).tracks == path


def test_an_empty_file_is_one_that_was_not_written_to_its_end(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text("\n")
    with pytest.raises(ParameterError, match=r"a\.toml is empty: .*leave --parameters out"):
        parameters_from({}, path, MapParameters)
    path.write_text("# all as by default\n")
    assert parameters_from({}, path, MapParameters) == MapParameters()
