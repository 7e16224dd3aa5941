"""Measure and draw what the page "Do waves run along the edge?" shows: waves that run, stand, and go inwards.

    docs/draw_waves.py

Writes into `docs/source/guides/waves`: `waves.png`; `said.txt` and `inside.txt`, the lines of `cytodisk
waves` for the edge and for a signal of a simulated cell; and `truth.txt`, what was put in.
"""

import os
from pathlib import Path
from tempfile import TemporaryDirectory

from draw_populations import shrink
from draw_predictions import CHANNEL, command, renamed, wrapped
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import cytodisk as cd

REPOSITORY = Path(__file__).resolve().parents[1]
TARGET = REPOSITORY / "docs" / "source" / "guides" / "waves"
LAYERS, SECTORS = 5, 36
WIDTH_MM, HEIGHT_MM, DPI = 119.0, 42.0, 260
SHOWN_FRAME = 40
CELL = {"frames": 70, "radius_px": 36.0, "edge_speed_px": 0.6, "noise": 1.0}


def main() -> None:
    """Write the picture and the lines of the command."""
    os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    TARGET.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as place:
        here = Path(place)
        running = cd.simulate.wave_movie("spiral", 1, mode=2, wavelength_um=6.0, **CELL)
        standing = cd.simulate.wave_movie("standing", 1, mode=3, **CELL)
        for name, cell in (("running", running), ("standing", standing)):
            store(cell, here, name)
        said = command(here, "waves running --figures 0")
        inside = command(here, f"waves running --signal {CHANNEL} --figures 0")
        command(here, "waves standing --figures 0")
        print(said, inside, sep="\n")
        (TARGET / "said.txt").write_text(wrapped(said), encoding="utf-8")
        (TARGET / "inside.txt").write_text(wrapped(inside), encoding="utf-8")
        words = "{:.1f} µm/min around in layer 0, {:.1f} µm/min inwards\n"
        put_in = [60.0 * running.truth[name] for name in ("speed_um_s", "inward_speed_um_s")]
        (TARGET / "truth.txt").write_text(words.format(*put_in), encoding="utf-8")
        draw(cd.open_study(here / "running"), cd.open_study(here / "standing"))


def store(cell: cd.simulate.DrivenMovie, here: Path, name: str) -> None:
    """Masks and images as files, and their study."""
    masks, signal = renamed(cell).write(here / f"files_{name}")
    grid = f"--layers {LAYERS} --sectors {SECTORS} --out {name} --figures 0"
    command(here, f"movie {masks} --signal {signal} {grid}")


def draw(running: cd.Study, standing: cd.Study) -> None:
    """Velocity of both, and the phase of the signal on the disk."""
    with cd.plot.paper_style():
        figure = Figure(figsize=(WIDTH_MM / 25.4, HEIGHT_MM / 25.4), layout="constrained")
        axes = figure.subplots(1, 3, width_ratios=(1.3, 1.3, 1.0))
        draw_edge(axes[0], running, "a wave that runs", crests=True)
        draw_edge(axes[1], standing, "a wave that stands", crests=False)
        axes[1].set_ylabel("")
        draw_inside(axes[2], running)
        with TemporaryDirectory() as place:
            picture = Path(place) / "waves.png"
            figure.savefig(picture, dpi=DPI)
            shrink(picture, TARGET / "waves.png")


def draw_edge(ax: Axes, study: cd.Study, title: str, *, crests: bool) -> None:
    """Velocity by time and sector, with lines along the crests of a wave that runs."""
    velocity = study.activity(0)["velocity"]
    phase = cd.edge_waves(velocity, study.scale.frame_interval_s)["wave_phase"] if crests else None
    cd.plot.draw_wave_kymograph(ax, velocity, phase, by_velocity=True)
    ax.set(ylabel="sector", title=title)


def draw_inside(ax: Axes, study: cd.Study) -> None:
    """Phase of the signal on the disk at one time."""
    signal = study.activity(0)["mean"].sel(channel=CHANNEL)
    found = cd.disk_waves(signal, study.scale.frame_interval_s)
    grid = cd.polar_windows(layers=LAYERS, sectors=SECTORS)
    cd.plot.draw_phase_on_disk(ax, grid, found["phase"].isel(time=SHOWN_FRAME))
    ax.set_title(f"{CHANNEL} inside")


if __name__ == "__main__":
    main()
