"""What the pages of docs/source/speed have in common: their folder, and words about the machine."""

import os
import platform
import time
from collections.abc import Sequence
from pathlib import Path

from speed import median_seconds, yardstick

PAGES = Path(__file__).parents[1] / "docs" / "source" / "speed"


def machine_words() -> str:
    """What was measured on, and how fast that is at work that any machine can repeat."""
    unit = median_seconds(yardstick(), 5, time.process_time)
    return (
        f"Measured on a machine with {os.cpu_count()} cores, Python {platform.python_version()}, which needs "
        f"{1e3 * unit:.0f} ms of processor time to factorise the Laplacian of a 200 × 200 grid (SuperLU)."
    )


def write_words(path: Path, lines: Sequence[str]) -> None:
    """Write sentences that a page includes."""
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
