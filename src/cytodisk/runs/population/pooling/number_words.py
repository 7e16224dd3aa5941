"""Numbers of pooled results in words."""

from __future__ import annotations

import math


def digits(number: float, places: int = 3) -> str:
    """A number with some digits after the point, with a true minus; never minus nothing."""
    return f"{round(number, places) + 0.0:.{places}f}".replace("-", "−")


def significant(number: float, unit: str = "") -> str:
    """A number with two significant digits, three above 100, and its unit."""
    words = f"{number:.3g}" if abs(number) >= 100.0 else f"{number:.2g}"
    return words.replace("-", "−") + (f" {unit}" if unit not in ("", "1") else "")


def with_interval(mean: float, low: float, high: float, unit: str = "") -> str:
    """A mean with its 95 % interval, where that is known."""
    if math.isnan(low):
        return significant(mean, unit)
    return f"{significant(mean, unit)} (95 % interval {significant(low)} to {significant(high)})"


def cells_words(cells: int, experiments: int) -> str:
    """How many cells, and of how many experiments."""
    among = f"in {experiments} experiments" if experiments else "of unknown experiments"
    return f"{cells} cells {among}"
