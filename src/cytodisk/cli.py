"""The command line: reads flags, calls the library, prints what happened."""

import platform
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cytodisk.errors import CytodiskError

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.io.study_folder import Study
    from cytodisk.study.map_run import MapInputs
    from cytodisk.study.movie_run import MovieInputs

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    help="Map cells one to one onto the unit disk, divide them into windows and sample the signal in each.",
)

_MAP_HELP = """Map masks onto the disk and sample a signal in windows, into a study folder.

MASKS is one mask, a stack of masks, or a label image (each label a cell), as TIFF or PNG.

Examples:

  cytodisk map mask.tif -o out/

  cytodisk map masks.tif --signal image.ome.tif -o out/ --layers 10 --sectors 60 --workers 2

  cytodisk map labels.tif -o out/ --parameters other_study/parameters.toml --resume

Exit code: 0 when done (refused cells have a row with the reason), 2 if nothing could be mapped.
"""

_MOVIE_HELP = """Follow cells through a movie: maps, activity of a signal, edge velocity, into a study folder.

MASKS is a stack of masks of one cell, or label images in which a label is a cell in all frames, as TIFF.

Examples:

  cytodisk movie masks.tif --signal movie.ome.tif -o out/ --layers 10 --sectors 60 --workers 2

  cytodisk movie masks.tif --signal movie.tif -o out/ --pixel-size 0.16 --frame-interval 5 --depth-um 1.6

  cytodisk movie labels.tif -o out/ --link --resume

Exit code: 0 when done (frames without a map have a row with the reason), 2 if nothing could be mapped.
"""

Movie = Annotated[Path, typer.Argument(help="Masks or label images by frame: TIFF.", show_default=False)]
Masks = Annotated[
    Path, typer.Argument(help="Mask, stack of masks or label image: TIFF or PNG.", show_default=False)
]
Signal = Annotated[
    Path | None, typer.Option(help="Image to sample, of the same height and width: TIFF or PNG.")
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")]


@app.command("map", help=_MAP_HELP)
def map_command(
    masks: Masks,
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the results.", show_default=False)],
    signal: Signal = None,
    kind: Annotated[str | None, typer.Option(help="What MASKS is: auto, mask, stack or labels.")] = None,
    layers: Annotated[int | None, typer.Option(help="Windows from edge to centre (default 10).")] = None,
    sectors: Annotated[int | None, typer.Option(help="Windows around the edge (default 60).")] = None,
    spacing: Annotated[
        str | None, typer.Option(help="Layers of equal area or radius (default area).")
    ] = None,
    method: Annotated[
        str | None, typer.Option(help="newton (equal area) or harmonic (default newton).")
    ] = None,
    shape_weight: Annotated[
        float | None, typer.Option(help="Shape against area, above 0 (default 0.005).")
    ] = None,
    edge_length: Annotated[
        float | None, typer.Option(help="Mesh spacing at the edge, px (default 0.9).")
    ] = None,
    align: Annotated[
        str | None,
        typer.Option(help="upright, an angle in degrees, or a point ROW,COLUMN (default upright)."),
    ] = None,
    nan: Annotated[
        str | None, typer.Option(help="Windows with NaN pixels: propagate or omit (default propagate).")
    ] = None,
    pixel_size: Annotated[float | None, typer.Option(help="µm per pixel; overrules the file's own.")] = None,
    parameters: Annotated[
        Path | None, typer.Option(help="TOML file as in a study; flags overrule it.")
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes.")] = 1,
    figures: Annotated[int, typer.Option(help="Draw this many cells, from the first; -1 for all.")] = 8,
    geojson: Annotated[
        bool, typer.Option("--geojson", help="Write window outlines beside the maps.")
    ] = False,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with the same run in this folder.")] = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the study in this folder.")] = False,
    quiet: Quiet = False,
) -> None:
    from cytodisk.plot.study import draw_cell_figures
    from cytodisk.study.map_run import open_inputs, run_map
    from cytodisk.study.parameters import parameters_from

    given = {
        "kind": kind,
        "layers": layers,
        "sectors": sectors,
        "spacing": spacing,
        "method": method,
        "shape_weight": shape_weight,
        "edge_length": edge_length,
        "align": _align(align),
        "nan": nan,
        "pixel_size_um": pixel_size,
    }
    console = _console(quiet)
    inputs = open_inputs(masks, signal, parameters_from(given, parameters))
    _say_inputs(console, inputs)
    with _progress(quiet, "cells") as progress:
        study = run_map(
            inputs,
            out,
            workers=workers,
            resume=resume,
            overwrite=overwrite,
            draw=draw_cell_figures,
            draw_at_most=None if figures < 0 else figures,
            geojson=geojson,
            progress=progress,
        )
    _finish(console, study, figures)


@app.command("movie", help=_MOVIE_HELP)
def movie_command(
    masks: Movie,
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the results.", show_default=False)],
    signal: Signal = None,
    kind: Annotated[
        str | None, typer.Option(help="What MASKS is: auto, stack (one cell) or labels (a label a cell).")
    ] = None,
    link: Annotated[
        bool | None,
        typer.Option(
            "--link", help="Labels differ from frame to frame: link them by overlap.", show_default=False
        ),
    ] = None,
    layers: Annotated[int | None, typer.Option(help="Windows from edge to centre (default 10).")] = None,
    depth_um: Annotated[
        float | None, typer.Option(help="Instead of --layers: thickness of the first layer, µm.")
    ] = None,
    sectors: Annotated[int | None, typer.Option(help="Windows around the edge (default 60).")] = None,
    spacing: Annotated[
        str | None, typer.Option(help="Layers of equal area or radius (default area).")
    ] = None,
    tracker: Annotated[str | None, typer.Option(help="matching or demons (default matching).")] = None,
    tension: Annotated[
        float | None,
        typer.Option(help="Boundary points: 0 stay with matter … 1 equidistant (default 0.01)."),
    ] = None,
    register: Annotated[
        bool | None,
        typer.Option(
            "--register/--no-register",
            help="Take out rigid motion before tracking (default yes).",
            show_default=False,
        ),
    ] = None,
    frame_interval: Annotated[
        float | None, typer.Option(help="Seconds between frames; overrules the file's own.")
    ] = None,
    pixel_size: Annotated[float | None, typer.Option(help="µm per pixel; overrules the file's own.")] = None,
    method: Annotated[
        str | None, typer.Option(help="newton (equal area) or harmonic (default newton).")
    ] = None,
    align: Annotated[
        str | None,
        typer.Option(
            help="First frame's disk: upright, an angle in degrees, or ROW,COLUMN (default upright)."
        ),
    ] = None,
    nan: Annotated[
        str | None, typer.Option(help="Windows with NaN pixels: propagate or omit (default propagate).")
    ] = None,
    jitter_px: Annotated[
        float | None,
        typer.Option(help="How uncertain the masks' edges are, px, for the velocity's error (default 0.5)."),
    ] = None,
    parameters: Annotated[
        Path | None, typer.Option(help="TOML file as in a study; flags overrule it.")
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes.")] = 1,
    figures: Annotated[int, typer.Option(help="Draw this many cells, from the first; -1 for all.")] = 4,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with the same run in this folder.")] = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the study in this folder.")] = False,
    quiet: Quiet = False,
) -> None:
    from cytodisk.errors import ParameterError
    from cytodisk.study.movie_run import open_movie, run_movie
    from cytodisk.study.parameters import MovieParameters, parameters_from

    if layers is not None and depth_um is not None:
        raise ParameterError("layers and depth_um exclude each other: pass --layers or --depth-um")
    given = {
        "kind": kind,
        "link": link,
        "layers": layers,
        "depth_um": depth_um,
        "sectors": sectors,
        "spacing": spacing,
        "tracker": tracker,
        "tension": tension,
        "registration": register,
        "frame_interval_s": frame_interval,
        "pixel_size_um": pixel_size,
        "method": method,
        "align": _align(align),
        "nan": nan,
        "jitter_px": jitter_px,
    }
    console = _console(quiet)
    inputs = open_movie(masks, signal, parameters_from(given, parameters, MovieParameters))
    _say_movie(console, inputs)
    with _progress(quiet, "frames") as progress:
        study = run_movie(inputs, out, workers=workers, resume=resume, overwrite=overwrite, progress=progress)
    _draw_movie(quiet, study, inputs, figures)
    _finish_movie(console, study)


@app.command("check")
def check_command(
    masks: Masks,
    signal: Signal = None,
    kind: Annotated[str, typer.Option(help="What MASKS is: auto, mask, stack or labels.")] = "auto",
) -> None:
    """Say what is wrong with masks before a run: a line a cell.

    Exit code: 0 when all can be used, 1 if any cannot, 2 if the file cannot be read at all.

    Example: cytodisk check labels.tif
    """
    from cytodisk.study.map_run import check_cells, open_inputs
    from cytodisk.study.parameters import parameters_from

    inputs = open_inputs(masks, signal, parameters_from({"kind": kind}))
    console = _console(False)
    _say_inputs(console, inputs)
    unusable = doubtful = count = 0
    print("cell\tframe\tlabel\tusable\tremarks")
    for found, reason, notes, doubts in check_cells(inputs):
        count += 1
        unusable += bool(reason)
        doubtful += bool(doubts)
        remarks = reason or "; ".join([*doubts, *notes])
        usable = "no" if reason else "doubtful" if doubts else "yes"
        print(f"{found.cell}\t{found.frame}\t{found.label}\t{usable}\t{remarks}")
    console.print(
        f"{_count(count)}: {count - unusable} usable ({doubtful} of them doubtful), {unusable} not usable"
    )
    raise typer.Exit(1 if unusable else 0)


@app.command("info")
def info_command() -> None:
    """Print versions, and which optional parts are there."""
    from cytodisk.study.provenance import PACKAGES, installed

    print(f"python\t{platform.python_version()} on {platform.platform()}")
    for name, found in installed(PACKAGES).items():
        print(f"{name}\t{found}")
    print("image formats\tTIFF, OME-TIFF, ImageJ TIFF, PNG")
    print(f"compressed TIFF\t{'yes' if find_spec('imagecodecs') else 'no: pip install imagecodecs'}")


@app.command("demo")
def demo_command(
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the demo.")] = Path("cytodisk_demo"),
    seed: Annotated[int, typer.Option(help="Seed of the simulated movie.")] = 0,
    workers: Annotated[int, typer.Option(help="Processes.")] = 1,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the study in OUT/study.")] = False,
    quiet: Quiet = False,
) -> None:
    """Simulate a moving cell with two signals, follow it, and compare with the known answer.

    Nothing is downloaded. OUT/input holds the simulated files, OUT/study the results.
    """
    from cytodisk.study.demo import compare_with_truth, write_demo_input
    from cytodisk.study.movie_run import open_movie, run_movie
    from cytodisk.study.parameters import MovieParameters

    console = _console(quiet)
    truth, masks, signal = write_demo_input(out / "input", seed, overwrite=overwrite)
    console.print(f"A simulated cell in {len(truth.masks)} frames, with two signals, is in {masks.parent}.")
    console.print(f"The same by hand: cytodisk movie {masks} --signal {signal} -o {out / 'study'}\n")
    inputs = open_movie(masks, signal, MovieParameters())
    _say_movie(console, inputs)
    with _progress(quiet, "frames") as progress:
        study = run_movie(
            inputs,
            out / "study",
            workers=workers,
            resume=not overwrite,
            overwrite=overwrite,
            progress=progress,
        )
    _draw_movie(quiet, study, inputs, 1)
    _finish_movie(console, study)
    for what, answer in compare_with_truth(study, truth).items():
        console.print(f"{what}: {answer}")


def main() -> None:
    """Run the command line; errors that a user can mend end in exit code 2."""
    try:
        app()
    except CytodiskError as error:
        _fail(str(error))


def _fail(message: str) -> None:
    print(f"Error: {message}", file=sys.stderr)
    raise SystemExit(2)


def _count(cells: int) -> str:
    return "1 cell" if cells == 1 else f"{cells} cells"


def _align(text: str | None) -> Any:
    from cytodisk.errors import ParameterError

    if text is None or text == "upright":
        return text
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 2):
        raise ParameterError(f"align must be upright, an angle in degrees or ROW,COLUMN, got {text!r}")
    return numbers[0] if len(numbers) == 1 else tuple(numbers)


def _console(quiet: bool) -> "Console":
    from rich.console import Console

    return Console(quiet=quiet, highlight=False, soft_wrap=True, markup=False)


@contextmanager
def _progress(quiet: bool, unit: str) -> Iterator[Callable[[int, int], None]]:
    """A bar on stderr with rate and time left; gives a function to call with (done, in all)."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), disable=quiet, transient=True) as bar:
        task = bar.add_task(unit, total=None, rate="")

        def report(done: int, total: int) -> None:
            speed = bar.tasks[task].speed
            rate = f"{speed:.1f} {unit}/s" if speed else ""
            bar.update(task, completed=done, total=total, rate=rate)

        try:
            yield report
        except KeyboardInterrupt:
            done, total = bar.tasks[task].completed, bar.tasks[task].total
            of_all = f" ({done:.0f} of {total:.0f} {unit})" if total else ""
            print(f"Stopped; what was done is kept{of_all}: run it again with --resume.", file=sys.stderr)
            raise typer.Exit(130) from None
        if not bar.tasks[task].total and not quiet:
            print("this study is complete already: nothing was run or drawn again", file=sys.stderr)


def _say_inputs(console: "Console", inputs: "MapInputs") -> None:
    for role, words in inputs.understood.items():
        console.print(f"{role}: {words}")
    size = inputs.pixel_size_um
    console.print(f"pixel size: {size:g} µm" if size else "pixel size: unknown, results are in px")


def _say_movie(console: "Console", inputs: "MovieInputs") -> None:
    for role, words in inputs.understood.items():
        console.print(f"{role}: {words}")
    pixel, interval = inputs.scale.pixel_size_um, inputs.scale.frame_interval_s
    console.print(f"pixel size: {pixel:g} µm" if pixel else "pixel size: unknown, lengths are in px")
    console.print(
        f"frame interval: {interval:g} s" if interval else "frame interval: unknown, times are in frames"
    )


def _draw_movie(quiet: bool, study: "Study", inputs: "MovieInputs", figures: int) -> None:
    """Draw cells that have no figures yet, so that a run that was stopped while drawing goes on."""
    from cytodisk.plot.movie import draw_movie_figures

    signal = inputs.signal
    image = None if signal is None else lambda time: signal.frame(time)
    cells = sorted(study.cells["cell"].unique())
    wanted = cells if figures < 0 else cells[:figures]
    missing = [cell for cell in wanted if not any((study.path / "figures").glob(f"cell_{cell:05d}*.gif"))]
    with _progress(quiet, "drawings") as progress:
        for number, cell in enumerate(missing):
            progress(number, len(missing))
            draw_movie_figures(study, int(cell), image)
        progress(len(wanted), len(wanted))


def _finish_movie(console: "Console", study: "Study") -> None:
    """Say what came out; exit code 2 if that is nothing, or a frame is damaged."""
    frames = study.cells
    mapped = frames[frames["status"] == "ok"]
    cells = frames["cell"].nunique()
    console.print(f"{len(mapped)} of {len(frames)} frames of {_count(cells)} mapped, each one to one")
    if len(mapped):
        _say_measures(console, study, mapped)
    for status in ("refused", "missing", "unreadable"):
        lost = frames[frames["status"] == status]
        for _, row in lost.head(10).iterrows():
            print(f"cell {row['cell']}, frame {row['time']} {status}: {row['reason']}", file=sys.stderr)
        if len(lost) > 10:
            print(f"… and {len(lost) - 10} more {status}: column 'reason' of cells.parquet", file=sys.stderr)
    console.print(f"results: {study.path}")
    if not len(mapped):
        _fail(f"no frame could be mapped: {frames['reason'].iloc[0]}")
    unreadable = int((frames["status"] == "unreadable").sum())
    if unreadable:
        _fail(f"damaged frames of the input: {unreadable}; all others are in {study.path}")


def _say_measures(console: "Console", study: "Study", mapped: Any) -> None:
    if study.edge is None or study.consistency is None:
        return
    speed, unit = study.edge["velocity"], study.edge.attrs["units"]["velocity"]
    length = study.consistency.attrs["units"]["centroid_displacement"]
    console.print(
        f"edge velocity: {speed.min():.3g} to {speed.max():.3g} {unit}, error of one sector "
        f"{study.edge['velocity_error'].median():.2g} {unit}"
    )
    console.print(
        f"window centroids move {study.consistency['centroid_displacement'].mean():.3g} {length} a frame; "
        f"consecutive frames correlate by {study.consistency['correlation'].mean():.2f}; "
        f"empty windows {int(mapped['empty_windows'].sum())}"
    )
    for name, words in (
        ("restarted", "tracking started anew"),
        ("doubts", "look at the mask"),
    ):
        marked = mapped[mapped[name] != ""]
        for _, row in marked.head(10).iterrows():
            console.print(f"cell {row['cell']}, frame {row['time']}: {words}: {row[name]}")
        if len(marked) > 10:
            console.print(f"… and {len(marked) - 10} more frames: column '{name}' of cells.parquet")
    border = mapped.groupby("cell")["touches_border"].sum()
    if border.any():
        console.print(
            f"{_count(int((border > 0).sum()))} on the image's border in {int(border.sum())} frames: "
            "that part of the edge has no velocity"
        )


def _finish(console: "Console", study: "Study", figures: int) -> None:
    """Draw the overview and say what came out; exit code 2 if that is nothing, or a frame is damaged."""
    from cytodisk.plot.study import draw_overview

    cells = study.cells
    if len(cells) > 1:
        draw_overview(study.path / "figures" / "overview.png", cells)
    mapped = cells[cells["status"] == "ok"]
    console.print(f"{len(mapped)} of {_count(len(cells))} mapped{', one to one' if len(mapped) else ''}")
    if len(mapped):
        console.print(
            f"median {mapped['seconds'].median():.2f} s a cell; median area distortion (mean |log λ|) "
            f"{mapped['area_distortion'].median():.3f}; empty windows {int(mapped['empty_windows'].sum())}"
        )
    remarks = mapped[mapped["notes"] != ""]
    if len(remarks):
        console.print(f"{_count(len(remarks))} with remarks: column 'notes' of cells.parquet")
    doubtful = mapped[mapped["doubts"] != ""]
    for _, row in doubtful.head(20).iterrows():
        console.print(f"look at cell {row['cell']} (frame {row['time']}): {row['doubts']}")
    if len(doubtful) > 20:
        console.print(f"… and at {len(doubtful) - 20} more: column 'doubts' of cells.parquet")
    lost = cells[cells["status"] != "ok"]
    for _, row in lost.head(20).iterrows():
        print(f"cell {row['cell']} (frame {row['time']}) {row['status']}: {row['reason']}", file=sys.stderr)
    if len(lost) > 20:
        print(f"… and {len(lost) - 20} more: column 'reason' of cells.parquet", file=sys.stderr)
    if 0 <= figures < len(mapped):
        console.print(f"figures drawn for the first {_count(figures)}: --figures -1 draws all")
    console.print(f"results: {study.path}")
    unreadable = int((cells["status"] == "unreadable").sum())
    if not len(mapped):
        _fail(f"no cell could be mapped: {lost['reason'].iloc[0] if len(lost) else 'the file holds no cell'}")
    if unreadable:
        _fail(f"damaged frames of the input: {unreadable}; all others are in {study.path}")


__all__ = ["app", "main"]
