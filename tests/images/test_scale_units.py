"""Units as people type them, and numbers as files give them."""

import pytest

from cytodisk.images.formats.measured_scale import agreed_interval, pixel_size_of
from cytodisk.images.formats.said_scale import duration, length, print_resolution
from cytodisk.images.scale_units import is_no_unit, micrometres, number, seconds
from cytodisk.images.spots.track_units import frame_interval_s, pixel_size_um

LENGTHS = {
    1.0: [
        "µm",
        "μm",
        "um",
        "UM",
        "micron",
        "Microns",
        "micrometer",
        "Micrometres",
        "\\u00B5m",
        "Âµm",
        " um. ",
    ],
    1e-3: ["nm", "NM", "nanometer", "nanometres"],
    1e3: ["mm", "millimeters", "Millimetre"],
    1e4: ["cm", "centimetres"],
    1e6: ["m", "meter", "Metres"],
    1e-4: ["Å", "A\u030a", "\u212b", "angstrom", "Ångströms"],
    25400.0: ["inch", "inches", "in", '"', "Inch"],
}
TIMES = {
    1.0: ["s", "S", "sec", "secs", "second", "Seconds", "sec."],
    1e-3: ["ms", "msec", "millisecond", "Milliseconds", "msecs"],
    1e-6: ["µs", "us", "microseconds"],
    60.0: ["min", "mins", "minute", "Minutes"],
    3600.0: ["h", "hr", "hrs", "hour", "HOURS"],
    86400.0: ["d", "day", "days"],
}


@pytest.mark.parametrize(("factor", "unit"), [(f, unit) for f, units in LENGTHS.items() for unit in units])
def test_lengths(factor: float, unit: str) -> None:
    assert micrometres(unit) == pytest.approx(factor)


@pytest.mark.parametrize(("factor", "unit"), [(f, unit) for f, units in TIMES.items() for unit in units])
def test_times(factor: float, unit: str) -> None:
    assert seconds(unit) == pytest.approx(factor)


@pytest.mark.parametrize("unit", ["furlong", "µ", "bananas", "meters per second", None, 3, "s2"])
def test_what_is_no_unit_is_not_guessed(unit: object) -> None:
    assert micrometres(unit) is None
    assert seconds(unit) is None


@pytest.mark.parametrize("unit", ["", "pixel", "Pixels", "px", "reference frame", " frames "])
def test_files_say_that_they_have_none(unit: str) -> None:
    assert is_no_unit(unit)
    assert length("1", unit, "PhysicalSizeX") == (None, ())


@pytest.mark.parametrize(
    ("text", "value"),
    [("0,2", 0.2), ("12,5", 12.5), ("0,250", 0.25), ("1e-3", 1e-3), (" 2 ", 2.0), (3, 3.0)],
)
def test_numbers(text: object, value: float) -> None:
    assert number(text) == value


@pytest.mark.parametrize("text", ["1,000", "0.2 µm", "", "nan", "inf", "1.000,5", None, "two"])
def test_what_may_be_another_number_is_none(text: object) -> None:
    assert number(text) is None


def test_what_cannot_be_read_is_named_with_the_flag() -> None:
    value, (note,) = length("0.2", "furlong", "PhysicalSizeX")
    assert value is None
    assert "PhysicalSizeX is '0.2' 'furlong', which is no known unit of length" in note
    assert note.endswith("pass --pixel-size, in µm")
    value, (note,) = duration("fast", "s", "TimeIncrement")
    assert value is None
    assert "TimeIncrement is 'fast', which is no number above 0" in note
    assert note.endswith("pass --frame-interval, in seconds")
    for value, unit in [("1e308", "m"), ("1e300", "µm"), ("1e-300", "µm"), ("2", "km")]:
        size, (note,) = length(value, unit, "PhysicalSizeX")
        assert size is None
        assert note.endswith("is beyond all measure; the pixel size is unknown: pass --pixel-size, in µm")
    assert duration("1e-9", "s", "TimeIncrement")[0] is None
    assert length("-1", "µm", "PhysicalSizeX")[0] is None
    assert length("0", "µm", "PhysicalSizeX") == (None, ())  # how programs say that they do not know


@pytest.mark.parametrize("size", [0.0, 1e-300, 1e300, float("inf"), float("nan")])
def test_what_a_microscope_cannot_have_measured_is_not_believed(size: float) -> None:
    value, (note,), fault = pixel_size_of([size, size])
    assert (value, fault) == (None, "")
    assert "makes no sense; give it with --pixel-size" in note


@pytest.mark.parametrize("step", [1e-300, 1e300])
def test_intervals_that_no_movie_has_are_not_believed(step: float) -> None:
    for times, planned in [((), step), ((0.0, step, 2 * step), None), ((0.0, step, 2 * step), step)]:
        value, (note,) = agreed_interval(times, planned, 3)
        assert value is None
        assert "makes no sense" in note
        assert note.endswith("--frame-interval")
    assert frame_interval_s(str(step), "s") is None
    assert pixel_size_um((step, step), "µm") is None


@pytest.mark.parametrize("dpi", [72, 96, 300])
def test_resolutions_for_printing_are_no_scale(dpi: int) -> None:
    assert print_resolution(25400 / dpi) == dpi
    assert print_resolution(0.16) is None
