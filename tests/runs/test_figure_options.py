"""Formats of figures, as all commands that draw take them."""

import pytest

from cytodisk.cli.options import Given
from cytodisk.errors import ParameterError
from cytodisk.pages.figure_formats import FORMATS
from cytodisk.runs.run_options import FigureOptions


def given(*formats: str) -> Given:
    return Given({"format": formats} if formats else {}, None, {"format": "--format"})


def test_formats_are_those_that_pages_write() -> None:
    assert FigureOptions(format=FORMATS).format == FORMATS


def test_formats_are_each_taken_once_in_small_letters() -> None:
    assert given("PDF", "svg", "pdf").formats(4) == ("pdf", "svg")
    assert given().formats(4) == ("png",)


def test_no_figures_have_no_format() -> None:
    assert given().formats(0) == ()
    with pytest.raises(ParameterError, match="--format says how to write figures, --figures 0 to draw none"):
        given("pdf").formats(0)
    with pytest.raises(ParameterError, match="--no-figures to draw none: leave one out"):
        given("pdf").formats(False)


@pytest.mark.parametrize(
    ("wrong", "came"),
    [(("jpg",), "'jpg'"), (("",), "''"), (("png", "eps", "gif"), "'eps', 'gif'"), ((), "none")],
)
def test_formats_are_known(wrong: tuple[str, ...], came: str) -> None:
    words = f"--format must be png, pdf, svg or several with commas between, got {came}"
    with pytest.raises(ParameterError) as refused:
        Given({"format": wrong}, None, {"format": "--format"}).formats(4)
    assert str(refused.value) == words
