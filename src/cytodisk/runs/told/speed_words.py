"""How fast a run goes, and how long it still takes, in words."""

from collections.abc import Iterator

PERCENT = "percent"
"""What is counted where the steps have no name."""

_FEWEST_FOR_TIME = 2  # steps after the first that was told


def rate_words(a_second: float, unit: str) -> str:
    """As "1.2 cells/s", or with a longer time where that would be a small number."""
    rates = {"s": a_second, "min": 60 * a_second, "h": 3600 * a_second}
    time, rate = next((pair for pair in rates.items() if pair[1] >= 0.1), ("h", rates["h"]))
    return f"{rate:{'.0f' if rate >= 10 else '.2g'}} {unit.split()[0]}/{time}"


def speed_words(a_second: float, unit: str, done: int, left: int) -> Iterator[str]:
    """The rate, and the time left: the first steps compile, and say nothing of those that follow."""
    if not (done and a_second):
        return
    if unit != PERCENT:
        yield rate_words(a_second, unit)
    if left > 0 and done >= _FEWEST_FOR_TIME:
        yield f"{_duration(left / a_second)} left"


def _duration(seconds: float) -> str:
    """As "3 min"."""
    for unit, name in ((86400, "days"), (3600, "h"), (60, "min")):
        if seconds >= 2 * unit:
            return f"{seconds / unit:.0f} {name}"
    return f"{seconds:.0f} s"
