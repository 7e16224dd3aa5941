"""Draw the pictures of the page "What can go wrong", and write what the tool says in each case.

    docs/draw_going_wrong.py [CASE …]

Every case is a simulated movie with a known fault, run as a user runs it. Writes a PNG and a text file for
each case into `docs/source/guides/what_can_go_wrong`; the page includes both.
"""

import argparse
import sys
import tempfile
import textwrap
from contextlib import chdir
from pathlib import Path

from matplotlib.figure import Figure

from cytodisk.files import replacing
from cytodisk.plot.style import MM_PER_INCH, paper_style

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "going_wrong"))
import correlation_cases  # noqa: E402
import edge_cases  # noqa: E402
import signal_cases  # noqa: E402

TARGET = HERE / "source" / "guides" / "what_can_go_wrong"
CASES = edge_cases.CASES | signal_cases.CASES | correlation_cases.CASES
WIDTH_MM, HEIGHT_MM, DPI = 120.0, 48.0, 200
LINE = 100  # characters


def _wrapped(line: str) -> str:
    return textwrap.fill(line, LINE, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)


def main() -> None:
    """Draw the cases that are named, or all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", nargs="*", metavar="CASE", help=", ".join(CASES))
    for name in parser.parse_args().cases or CASES:
        with paper_style(), tempfile.TemporaryDirectory() as folder:
            figure = Figure(figsize=(WIDTH_MM / MM_PER_INCH, HEIGHT_MM / MM_PER_INCH), layout="constrained")
            with chdir(folder):  # so that commands name files as a user does who is there
                said = CASES[name](figure, Path())
            with replacing(TARGET / f"{name}.png") as temporary:
                figure.savefig(temporary, dpi=DPI, pil_kwargs={"optimize": True})
        with replacing(TARGET / f"{name}.txt") as temporary:
            temporary.write_text("\n".join(map(_wrapped, said)) + "\n", encoding="utf-8")
        print(f"{name}: {said[0]}", flush=True)


if __name__ == "__main__":
    main()
