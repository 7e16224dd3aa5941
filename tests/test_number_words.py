"""Numbers with a comma: the error says what to type."""

import pytest

import cytodisk as cd
from cytodisk.errors import ParameterError, WindowError
from cytodisk.number_words import comma_advice, comma_in_toml, without_comma
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
