"""Numbers with a comma: the error says what to type."""

import pytest

import cytodisk as cd
from cytodisk.errors import ParameterError, WindowError
from cytodisk.number_words import comma_advice, comma_in_toml, unit_advice, without_comma
from cytodisk.runs.map.map_parameters import MapParameters


@pytest.mark.parametrize(
    ("text", "right"),
    [
        ("0,2", "0.2"),
        (" -1,5 ", "-1.5"),
        ("1,5e-3", "1.5e-3"),
        ("1,000", "1.000 or 1000"),
        ("1,234,567", "1234567"),
        ("1.234,5", "1234.5"),
        ("0.2", ""),
        ("Rac1,RhoA", ""),
        ("1,2,3", ""),
        ("", ""),
    ],
)
def test_what_to_type(text: str, right: str) -> None:
    assert without_comma(text) == right


def test_a_whole_number_with_a_comma_is_in_thousands() -> None:
    assert comma_advice("1,000", whole=True) == "write 1000: numbers have a point, not a comma"


def test_lists() -> None:
    assert comma_advice("0,5;1,2").startswith("write 0.5,1.2: numbers have a point")
    assert comma_advice((0.0, 5.0, 1.0, 2.0)) == "if these are numbers with a comma, write 0.5,1.2"
    assert comma_advice((0.5, 5.0)) == comma_advice((1.0, 2.0, 3.0)) == comma_advice(3.0) == ""


def test_toml() -> None:
    text = 'layers = 3\npixel_size_um = 0,2  # µm\nname = "1,2"\nlist = [0.5, 1]\n'
    assert (
        comma_in_toml(text)
        == "line 2 has a number with a comma, pixel_size_um = 0,2: write pixel_size_um = 0.2"
    )
    assert comma_in_toml('name = "1,2"\nlist = [0,5, 1]') == ""


def test_parameters_name_the_remedy() -> None:
    with pytest.raises(ParameterError, match=r"pixel_size_um must be .*got '0,2': write 0\.2: numbers"):
        MapParameters(pixel_size_um="0,2")
    with pytest.raises(WindowError, match=r"depth_um must be .*: if these are .* write 0\.5"):
        cd.polar_windows(depth_um=(0.0, 5.0))


@pytest.mark.parametrize(
    ("text", "name", "words"),
    [
        ("0.2um", "pixel_size_um", "write 0.2: it is in µm"),
        ("153 nm", "pixel_size_um", "write 0.153: it is in µm"),
        ("0,2 µm", "pixel_size_um", "write 0.2: it is in µm"),
        ("5min", "frame_interval_s", "write 300: it is in seconds"),
        ("200 ms", "frame_interval_s", "write 0.2: it is in seconds"),
        ("3 parsecs", "pixel_size_um", "write the number alone, in µm"),
        ("5px", "layers", "write 5: a number without a unit"),
    ],
)
def test_a_number_with_a_unit(text: str, name: str, words: str) -> None:
    assert unit_advice(text, name).startswith(words)


@pytest.mark.parametrize("value", ["0.2", "1e-3", "five", "um", "", 0.2, None])
def test_no_unit_no_advice(value: object) -> None:
    assert unit_advice(value, "pixel_size_um") == ""


def test_the_unit_is_named_where_a_parameter_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"pixel_size_um must be .*got '153nm': write 0\.153"):
        MapParameters(pixel_size_um="153nm")
    with pytest.raises(ParameterError, match=r"layers must be .*got '5px': write 5:"):
        MapParameters(layers="5px")


def test_an_odd_list_with_a_decimal_comma() -> None:
    assert comma_advice((0.0, 5.0, 1.0)) == "if these are numbers with a comma, write 0.5,1"
    assert comma_advice((5.0, 0.0, 1.0)) == ""
    assert comma_advice((0.0, 5.0, 1.0, 2.0, 3.0)).endswith("write 0.5,1,2.3 or 0.5,1.2,3")
