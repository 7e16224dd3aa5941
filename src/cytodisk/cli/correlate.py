"""`cytodisk correlate` and `cytodisk report`."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, cast, get_args

import typer

from cytodisk.cli.console import Quiet, console_for, count, progress_bar

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.io.correlation_store import Correlation
    from cytodisk.io.study import Study

NOTHING_CHANGED = "Stopped; nothing was changed."
Format = Literal["png", "pdf", "svg"]

CORRELATE_HELP = """Correlate a signal with the motion of the edge, or with another signal, window by window.

STUDY is the folder of a movie, as cytodisk movie writes it. At a positive lag what comes second (--with)
follows the signal. Tables and figures go to STUDY/correlation/SIGNAL~WITH.

Examples:

  cytodisk correlate out/ --signal VASP --with velocity --max-lag 20

  cytodisk correlate out/ --signal Rac1 --with RhoA --pairs --format pdf,png

  cytodisk correlate out/ --signal Rac1 --with Rac1 --against edge --detrend linear

Exit code: 0 when done (a cell that cannot be correlated has a row with the reason), 2 if none could be.
"""

REPORT_HELP = """Write one HTML page that shows a study: red flags, windows, activity, velocity, correlation.

The page holds all it needs: it opens in any browser, without a network, and can be sent as one file.

Examples:

  cytodisk report out/

  cytodisk report out/ --cell 3
"""

StudyFolder = Annotated[Path, typer.Argument(help="Folder of a movie's study.", show_default=False)]


def correlate_command(
    study: StudyFolder,
    signal: Annotated[
        str | None, typer.Option(help="Channel of the study; not needed if it has but one.")
    ] = None,
    with_: Annotated[
        str, typer.Option("--with", help="velocity, velocity_cell_frame or a channel.")
    ] = "velocity",
    max_lag: Annotated[
        int | None, typer.Option(help="Longest lag, frames (default a quarter of the movie, at most 20).")
    ] = None,
    against: Annotated[
        str | None,
        typer.Option(
            help="Of another signal: the same window, or the edge's of the sector (default window)."
        ),
    ] = None,
    rule: Annotated[
        str | None,
        typer.Option(
            help="Peak: nearest to lag 0 of what chance does not give, or largest (default nearest)."
        ),
    ] = None,
    detrend: Annotated[str | None, typer.Option(help="none, linear or median (default none).")] = None,
    detrend_frames: Annotated[
        int | None, typer.Option(help="Frames of the moving median (default 4 × max lag + 1).")
    ] = None,
    difference: Annotated[
        bool | None,
        typer.Option("--difference", help="Correlate changes between frames.", show_default=False),
    ] = None,
    skip_lags: Annotated[
        str | None, typer.Option(help="Lags that do not count, such as -1,0 where masks jitter.")
    ] = None,
    surrogates: Annotated[int | None, typer.Option(help="0 for no significance (default 1999).")] = None,
    null: Annotated[
        str | None, typer.Option(help="Surrogates by random phase or circular shift (default phase).")
    ] = None,
    min_pairs: Annotated[int | None, typer.Option(help="Fewest frames at a lag (default 10).")] = None,
    seed: Annotated[int | None, typer.Option(help="Of the surrogates (default 0).")] = None,
    pairs: Annotated[
        bool | None,
        typer.Option("--pairs", help="Also every window with every other, by distance.", show_default=False),
    ] = None,
    frames: Annotated[str | None, typer.Option(help="First and last frame that count, as 10:80.")] = None,
    without_frames: Annotated[
        str | None, typer.Option(help="Frames that do not count, such as 17,24 where the mask is wrong.")
    ] = None,
    sectors: Annotated[
        str | None, typer.Option(help="First and last sector that count, as 40:55, or 50:5 around 0.")
    ] = None,
    cell: Annotated[list[int] | None, typer.Option(help="Only this cell; can be given again.")] = None,
    name: Annotated[
        str | None, typer.Option(help="Keeps the result beside others of the same signals.")
    ] = None,
    figures: Annotated[int, typer.Option(help="Draw this many cells, from the first; -1 for all.")] = 4,
    formats: Annotated[str, typer.Option("--format", help="Of figures: png, pdf, svg, or several.")] = "png",
    quiet: Quiet = False,
) -> None:
    from cytodisk.io.study import open_study
    from cytodisk.study.correlate import channels_of, correlate_study

    wanted = _formats(formats)
    there = open_study(study)
    given = {
        "max_lag": max_lag,
        "against": against,
        "rule": rule,
        "detrend": detrend,
        "detrend_frames": detrend_frames,
        "difference": difference,
        "surrogates": surrogates,
        "null": null,
        "min_pairs": min_pairs,
        "skip_lags": numbers("skip_lags", skip_lags),
        "frames": first_and_last("frames", frames),
        "without_frames": numbers("without_frames", without_frames),
        "sectors": first_and_last("sectors", sectors),
        "name": name,
        "seed": seed,
        "pairs": pairs,
    }
    settings = {name: value for name, value in given.items() if value is not None}
    chosen = signal if signal is not None else _only(channels_of(there))
    console = console_for(quiet)
    before = earlier_settings(there, chosen, with_, name or "")
    with progress_bar(quiet, "percent", stopped=NOTHING_CHANGED) as progress:
        found = correlate_study(there, chosen, with_, cells=cell, progress=progress, **settings)
    draw_correlation(quiet, there, found, figures, wanted)
    say_correlation(console, found)
    say_replaced(console, before, found.settings)


def report_command(
    study: StudyFolder,
    cell: Annotated[
        int | None, typer.Option(help="The cell to show (default that with the most frames).")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="The page (default STUDY/report.html).")
    ] = None,
    signal: Annotated[
        Path | None, typer.Option(help="The movie's image, if it is no longer where it was.")
    ] = None,
    quiet: Quiet = False,
) -> None:
    from cytodisk.io.study import open_study

    write_page(console_for(quiet), quiet, open_study(study), out, cell, signal)


def write_page(
    console: "Console",
    quiet: bool,
    study: "Study",
    out: Path | None = None,
    cell: int | None = None,
    signal: Path | None = None,
) -> None:
    """Write the report and say where it is and what is wrong with the study."""
    from cytodisk.io.frames import open_frames
    from cytodisk.report.page import page_flags, write_report

    image = open_frames(signal) if signal is not None else None
    with progress_bar(quiet, "frames", stopped=NOTHING_CHANGED) as progress:
        page = write_report(study, out, cell=cell, signal=image, progress=progress)
    flags = page_flags(study, image)
    for flag in flags:
        console.print(f"red flag: {flag.what}")
    if not flags:
        console.print("no red flags")
    console.print(f"report: {page} ({page.stat().st_size / 1e6:.1f} MB), open it in a browser")


def draw_correlation(
    quiet: bool, study: "Study", found: "Correlation", figures: int, formats: tuple[Format, ...]
) -> None:
    """Draw the first cells that were correlated."""
    from cytodisk.plot.correlation_figures import draw_correlation_figures

    done = [int(cell) for cell in found.windows["cell"].unique()]
    cells = done if figures < 0 else done[:figures]
    if cells:
        stopped = f"Stopped while drawing; the tables are in {found.path}."
        with progress_bar(quiet, "cells drawn", total=len(cells), stopped=stopped) as progress:
            for place, cell in enumerate(cells):
                draw_correlation_figures(study, found, cell=cell, formats=formats)
                progress(place + 1, len(cells))


def say_correlation(console: "Console", found: "Correlation") -> None:
    """Peaks by layer, and how many windows are significant."""
    settings = found.settings
    console.print(
        f"signal {found.signal!r} with {found.with_}, lags to {settings['max_lag']} frames: "
        f"at a positive lag {found.with_} follows the signal, at a negative one it comes first"
    )
    layers, windows = found.layers, found.windows
    for cell, rows in layers.groupby("cell"):
        of_cell = windows[windows["cell"] == cell]
        console.print(f"cell {cell}, mean over sectors by layer:")
        for layer in rows.itertuples():
            console.print(_layer_words(layer, of_cell[of_cell["layer"] == layer.layer]))
    for _, row in found.cells.iterrows():
        for words in _doubts(row, settings):
            console.print(f"cell {row['cell']}{words}")
    _say_power(console, found.cells, windows)
    console.print(f"{count(layers['cell'].nunique())} correlated: {found.path}")


def _doubts(row: Any, settings: dict[str, Any]) -> Iterator[str]:
    """What speaks against a cell's correlations."""
    from cytodisk.analysis.series import DRIFTING_SHARE
    from cytodisk.study.correlation_settings import VELOCITIES

    if row["status"] != "ok":
        yield f" left out: {row['reason']}"
        return
    if row["restarts"]:
        yield (
            f": tracking started anew {row['restarts']:.0f} times; sectors need not be the same places "
            "before and after, so correlate the stretches one by one with --frames"
        )
    if settings["with"] in VELOCITIES and not math.isfinite(row["jitter"]):
        yield ": too few frames to see whether masks jitter, which correlates by itself at lags -1 and 0"
    elif abs(row["jitter"]) > 0:
        lags = "-2,-1,0,1" if settings["difference"] else "-1,0"
        yield (
            f": masks that jitter make {row['jitter']:+.2f} of the correlation at lag 0, and "
            f"{-row['jitter']:+.2f} at lag -1, in some layer: see what --skip-lags={lags} says"
        )
    if max(row["drifting_signal"], row["drifting_with"]) > DRIFTING_SHARE:
        yield (
            f": the level drifts, as by bleaching, in {row['drifting_signal']:.0%} of the signal's series "
            f"and {row['drifting_with']:.0%} of the others (chance gives 5 %): see whether --detrend linear "
            "or --difference says the same"
        )


def _say_power(console: "Console", cells: Any, windows: Any) -> None:
    """How many windows must be beyond all surrogates for any q to be below 0.05."""
    surrogates = int(cells["surrogates"].max())
    if not surrogates:
        return
    tested = windows.groupby("cell").size().max()
    fewest = math.ceil(tested / (0.05 * (surrogates + 1)))
    if fewest > tested:
        console.print(
            f"{surrogates} surrogates are too few for any p to reach 0.05: see --null and --max-lag"
        )
    elif fewest > 1:
        console.print(
            f"of {tested} windows, q < 0.05 takes {fewest} beyond all {surrogates} surrogates; a smaller "
            "patch needs more --surrogates, or --sectors"
        )


def _layer_words(row: Any, windows: Any) -> str:
    layer = f"  layer {row.layer:>2}"
    if not math.isfinite(row.correlation):
        return f"{layer}  no correlation: too few frames, or a signal that does not vary"
    seconds = f" ({row.lag_s:+.4g} s)" if math.isfinite(row.lag_s) else ""
    words = f"{layer}  {row.correlation:+.2f} at lag {row.lag:+.0f}{seconds}"
    if "q" not in windows:
        return words
    share = (windows["q"] < 0.05).mean()
    return f"{words}, q = {row.q:.2g}; q < 0.05 in {share:.0%} of its windows"


def earlier_settings(study: "Study", *names: str) -> dict[str, Any] | None:
    """Settings of a correlation that the next one will replace."""
    there = {(*one, "")[:3] for one in study.correlations}
    return study.correlation(*names).settings if names in there else None


def say_replaced(console: "Console", before: dict[str, Any] | None, now: dict[str, Any]) -> None:
    """Say which settings the replaced correlation had, if others."""
    if before is None:
        return
    changed = [f"{name} {before[name]!r}" for name in now if name in before and before[name] != now[name]]
    if changed:
        console.print(f"this replaced the correlation with {', '.join(changed)}: --name NAME keeps both")


def numbers(name: str, text: str | None) -> tuple[int, ...] | None:
    from cytodisk.errors import ParameterError

    if text is None:
        return None
    try:
        return tuple(int(part) for part in text.split(","))
    except ValueError:
        raise ParameterError(f"{name} must be whole numbers with commas between, got {text!r}") from None


def first_and_last(name: str, text: str | None) -> tuple[int, int] | None:
    from cytodisk.errors import ParameterError

    if text is None:
        return None
    try:
        first, last = (int(part) for part in text.split(":"))
    except ValueError:
        raise ParameterError(f"{name} must be FIRST:LAST, such as 10:80, got {text!r}") from None
    return first, last


def _formats(text: str) -> tuple["Format", ...]:
    from cytodisk.errors import ParameterError

    wanted = tuple(dict.fromkeys(part.strip().lower() for part in text.split(",")))
    if not set(wanted) <= set(get_args(Format)):
        raise ParameterError(f"format must be png, pdf, svg or several with commas between, got {text!r}")
    return cast(tuple[Format, ...], wanted)


def _only(names: list[str]) -> str:
    from cytodisk.errors import ParameterError

    if len(names) == 1:
        return names[0]
    raise ParameterError(f"signal is not given: pass --signal with one of {', '.join(map(repr, names))}")
