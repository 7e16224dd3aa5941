"""Numbers that were typed with a comma, as much of Europe writes them, or with a unit: what to type."""

import re
from itertools import pairwise

_COMMA = re.compile(r"[+-]?[0-9]+,[0-9]+([eE][+-]?[0-9]+)?")
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}(,[0-9]{3})+(\.[0-9]*)?")
_POINTS = re.compile(r"[+-]?[1-9][0-9]{0,2}(\.[0-9]{3})+,[0-9]+")  # as 1.234,5
_WITH_UNIT = re.compile(r"([+-]?[0-9]+(?:[.,][0-9]+)?(?:[eE][+-]?[0-9]+)?)\s*([^\W\d_][\w/ .]*)")
_MICRO = {
    "um": 1.0,
    "micron": 1.0,
    "microns": 1.0,
    "micrometer": 1.0,
    "micrometre": 1.0,
    "nm": 1e-3,
    "mm": 1e3,
}
_SECONDS = {"s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "min": 60.0, "minutes": 60.0, "h": 3600.0}
_UNITS = {"um": ("µm", _MICRO), "s": ("seconds", _SECONDS)}  # by the ending of a parameter's name
_LINE = re.compile(r"\s*([\w-]+)\s*=\s*([^#\s\"'\[\]{}]+,[^#\s\"'\[\]{}]+)\s*(#.*)?")


def without_comma(text: str, whole: bool = False) -> str:
    """A number with a comma as it should be typed; empty for other texts.

    Parameters
    ----------
    text : str
    whole : bool
        A whole number is wanted, so that 1,000 is a thousand; else both ways to read it are given.
    """
    given = text.strip()
    if _POINTS.fullmatch(given):
        return given.replace(".", "").replace(",", ".")
    thousands = given.replace(",", "") if _THOUSANDS.fullmatch(given) else ""
    point = given.replace(",", ".") if _COMMA.fullmatch(given) and not (whole and thousands) else ""
    return " or ".join(words for words in (point, thousands) if words)


def comma_advice(value: object, whole: bool = False) -> str:
    """What to do about a value that was refused, if it is a number with a comma, or several; else empty.

    Parameters
    ----------
    value : object
        As it was typed, or what came out of a list.
    whole : bool
        A whole number is wanted.
    """
    if isinstance(value, tuple):
        return _advice_on_pairs(value)
    if not isinstance(value, str):
        return ""
    if right := without_comma(value, whole):
        return f"write {right}: numbers have a point, not a comma"
    parts = [part for part in re.split(r"[;\s]+", value.strip()) if part]
    if len(parts) > 1 and all(_COMMA.fullmatch(part) for part in parts):
        right = ",".join(without_comma(part) for part in parts)
        return f"write {right}: numbers have a point, and commas stand between them"
    return ""


def unit_advice(value: object, name: str) -> str:
    """What to do about a value that was refused, if it is a number with a unit behind it; else empty.

    Parameters
    ----------
    value : object
        As it was typed.
    name : str
        Of the parameter, which ends in its unit: "pixel_size_um".
    """
    found = _WITH_UNIT.fullmatch(value.strip()) if isinstance(value, str) else None
    if found is None:
        return ""
    number, unit = float(found[1].replace(",", ".")), found[2].strip().replace("µ", "u").replace("μ", "u")
    wanted, known = _UNITS.get(name.rsplit("_", 1)[-1], ("", {}))
    if not wanted:
        return f"write {number:.12g}: a number without a unit"
    factor = known.get(unit, known.get(unit.lower()))
    if factor is None:
        return f"write the number alone, in {wanted}"
    return f"write {number * factor:.12g}: it is in {wanted}, without the unit"


def _advice_on_pairs(values: tuple[object, ...]) -> str:
    """What to do if 0,5,1,2 was typed for 0.5 and 1.2, so that four whole numbers came out."""
    numbers = [int(value) for value in values if isinstance(value, float) and value >= 0 and value % 1 == 0]
    if len(numbers) != len(values) or not numbers:
        return ""
    if len(numbers) % 2:
        return _advice_on_odd(numbers)
    right = ",".join(f"{one}.{two}" for one, two in zip(numbers[::2], numbers[1::2], strict=True))
    return f"if these are numbers with a comma, write {right}"


def _advice_on_odd(numbers: list[int]) -> str:
    """What to do if 0,5,1 was typed for 0.5 and 1: one of the numbers is whole, and they increase."""
    if all(one < two for one, two in pairwise([0, *numbers])):
        return ""  # as it should be
    readings = []
    for whole in range(0, len(numbers), 2):
        before, after = numbers[:whole], numbers[whole + 1 :]
        words = [f"{one}.{two}" for one, two in zip(before[::2], before[1::2], strict=True)]
        words += [str(numbers[whole])]
        words += [f"{one}.{two}" for one, two in zip(after[::2], after[1::2], strict=True)]
        if len(words) > 1 and all(float(a) < float(b) for a, b in pairwise(["0", *words])):
            readings.append(",".join(words))
    return f"if these are numbers with a comma, write {' or '.join(readings)}" if readings else ""


def comma_in_toml(text: str) -> str:
    """What is wrong with the first line of a TOML file that has a number with a comma; empty if none has."""
    for number, line in enumerate(text.splitlines(), 1):
        found = _LINE.fullmatch(line)
        if found is not None and (right := without_comma(found[2])):
            name = found[1]
            return f"line {number} has a number with a comma, {name} = {found[2]}: write {name} = {right}"
    return ""


def rounded(value: float, digits: int = 3) -> str:
    """A measured number with so many digits that count, without a power of ten up to a million.

    Examples
    --------
    >>> from cytodisk.number_words import rounded
    >>> rounded(2534.1), rounded(0.0412345), rounded(103.2, digits=2)
    ('2530', '0.0412', '100')
    """
    return f"{float(f'{value:.{digits}g}'):g}"


def counted(number: int, one: str, many: str | None = None) -> str:
    """A number with its noun, as "1 cell" and "2 cells"."""
    return f"{number} {one if number == 1 else many or one + 's'}"
