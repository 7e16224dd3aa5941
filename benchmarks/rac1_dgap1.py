"""Rac1 against DGAP1 in a real movie: do they run around the cell, apart, and which predicts what?

    benchmarks/rac1_dgap1.py [--data FOLDER] [--out FOLDER] [--frames N] [--surrogates N]

The movie (*Dictyostelium*, two channels, 4 s a frame, pixel size unknown) has no mask. The mask is where the
smoothed sum of both channels, each over its mean in the frame, lies above Li's threshold, which is taken by
frame and smoothed over nine frames; of the pieces that which overlaps the last frame's mask most, without
holes, and taken in by 2 px, which smoothing adds. In frames 164 to 173 the cell is out of focus, so the first
160 frames are used. Prints a table of figures of the outermost layer, by `run_movie`, `run_waves`,
`run_predict` and `run_correlate` as they are for any user. With `--out` the masks, the study and the pictures
`masks.png` and `poles.png` stay.

What is known of these cells: DGAP1 and cortexillin gather where active Rac1 is low, at the rear (Filić et al.
2012; Šoštar et al. 2024), so their poles should stand apart.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import tifffile
from scipy import ndimage
from skimage.filters import threshold_li

import cytodisk as cd
from cytodisk.arrays import BoolArray, FloatArray

FILE = Path("dictyostelium_rac1") / "rac1_dgap1_no_mask.tif"
CHANNELS = ("Rac1", "DGAP1")
FRAME_S, SMOOTH_PX, SMOOTH_FRAMES = 4.0, 2.0, 9
LAYERS, SECTORS = 5, 36
SHOWN, USED = 6, 160
_SHIFTS = 999


def cell_masks(movie: FloatArray) -> tuple[BoolArray, FloatArray]:
    """Masks of the brightest cell of a movie.

    Parameters
    ----------
    movie : float64 array (frames, channels, height, width)

    Returns
    -------
    masks : bool array (frames, height, width)
    thresholds : float64 array (frames,)
        Of the smoothed sum of channels.
    """
    share = movie / movie.mean(axis=(2, 3), keepdims=True)
    bright = np.stack([ndimage.gaussian_filter(frame, SMOOTH_PX) for frame in share.sum(axis=1)])
    found = np.array([threshold_li(frame) for frame in bright])
    thresholds = ndimage.median_filter(found, SMOOTH_FRAMES, mode="nearest")
    masks = np.zeros(bright.shape, dtype=bool)
    last = bright[0] > 0.5 * bright[0].max()
    for mask, frame, threshold in zip(masks, bright, thresholds, strict=True):
        cell = ndimage.binary_fill_holes(_piece(frame > threshold, last))
        mask[:] = last = _piece(ndimage.distance_transform_edt(cell) > SMOOTH_PX, cell)
    return masks, np.asarray(thresholds)


def _piece(mask: BoolArray, among: BoolArray) -> BoolArray:
    """The piece of a mask that overlaps another mask most."""
    labels, _ = ndimage.label(mask)
    pieces = np.bincount(labels[among])
    pieces[0] = 0  # what is around the cell
    return np.asarray(labels == pieces.argmax())


def poles_apart(first: FloatArray, second: FloatArray, seed: int = 0) -> tuple[float, float, float]:
    """How far around the cell the pole of one signal stands from that of another.

    The pole is where the one wave around the cell that fits a frame best is highest.

    Parameters
    ----------
    first, second : float64 array (frames, sectors)
        Frames with NaN are left out.
    seed : int
        Of the shifts in time that chance is told by.

    Returns
    -------
    degrees : float
        Angle of the second pole from the first towards higher sectors, 0 to 180 either way; mean weighted by
        how pronounced both are.
    agreement : float
        1 where the angle never changes, 0 where it is anything.
    p : float
        Share of shifts of one in time, the real one counted too, with at least this agreement. Two poles that
        turn at the same speed agree at any shift, so that few turns cannot show more.
    """
    whole = np.isfinite(first).all(axis=1) & np.isfinite(second).all(axis=1)
    waves = [np.fft.fft(series[whole], axis=1)[:, 1] for series in (first, second)]
    size = np.sqrt(np.prod([np.sum(np.abs(wave) ** 2) for wave in waves]))

    def product(shift: int) -> complex:
        return complex(np.sum(waves[0] * np.conj(np.roll(waves[1], shift))) / size)

    found, frames = product(0), int(whole.sum())
    shifts = np.random.default_rng(seed).integers(1, frames, _SHIFTS)
    chance = np.array([abs(product(int(shift))) for shift in shifts])
    p = (1 + int(np.sum(chance >= abs(found)))) / (1 + _SHIFTS)
    return float(np.degrees(np.angle(found))), abs(found), p


def rows(study: cd.Study, masks: BoolArray, surrogates: int) -> Iterator[tuple[str, str]]:
    """What is measured and the figure, one by one as they are found."""
    area = masks.sum(axis=(1, 2))
    kept = (masks[1:] & masks[:-1]).sum(axis=(1, 2)) / (masks[1:] | masks[:-1]).sum(axis=(1, 2))
    cells = study.cells
    yield "mask: area, mean ± SD over frames", f"{area.mean():.0f} ± {area.std():.0f} px"
    yield "mask: overlap of neighbouring frames, median and least", f"{np.median(kept):.3f}, {kept.min():.3f}"
    yield "frames mapped", f"{int((cells['status'] == 'ok').sum())} of {len(cells)}"
    flags = [f"{flag.name} ({len(flag.places)})" for flag in cd.qc_flags(study)]
    yield "QC flags", ", ".join(flags) or "none"
    for signal in ("velocity", *CHANNELS):
        wave = cd.run_waves(study, signal).cells.iloc[0]
        yield f"waves of {signal}", _of_wave(wave)
    activity = study.activity(0).load()
    outer = {name: activity["mean"].sel(channel=name).isel(layer=0).to_numpy() for name in CHANNELS}
    outer["velocity"] = activity["velocity"].to_numpy()
    for pair in (("Rac1", "DGAP1"), ("velocity", "Rac1"), ("velocity", "DGAP1")):
        degrees, agreement, p = poles_apart(*(outer[name] for name in pair))
        yield (
            f"pole of {pair[1]} from that of {pair[0]}",
            f"{degrees:+.0f}°, agreement {agreement:.2f}, p {p:.3f}",
        )
    for source, target in (("Rac1", "velocity"), ("DGAP1", "velocity"), ("Rac1", "DGAP1")):
        links = cd.run_predict(study, source, target, detrend="linear", surrogates=surrogates).links
        for _, link in links[links["layer"] == 0].iterrows():
            yield f"{link['source']} predicts {link['target']}", _of_link(link)
        found = cd.run_correlate(study, source, target, detrend="linear", surrogates=surrogates)
        yield f"{source} with {target}", _of_layer(found.layers[found.layers["layer"] == 0].iloc[0])


def _of_wave(wave: Any) -> str:
    if wave["status"] != "ok":
        return str(wave["reason"])
    return (
        f"{wave['kind']} {wave['way'] or ''}, mode {wave['mode']}, period {wave['period_s']:.0f} s, "
        f"direction {wave['direction']:+.2f}, order {wave['order']:.1f}, p {wave['p']:.3f}, "
        f"without the cell's motion p {wave['p_partial']:.3f}"
    )


def _of_link(link: Any) -> str:
    if link["status"] != "ok":
        return str(link["reason"])
    return (
        f"gain {1e3 * link['gain']:.1f} mnat, beyond chance {1e3 * link['gain_excess']:.1f}, "
        f"effect {link['effect']:+.2f}, p {link['p']:.3f}, q {link['q']:.3f}; "
        f"without geometry p {link['p_partial']:.3f}"
    )


def _of_layer(layer: Any) -> str:
    return (
        f"r {layer['correlation']:+.2f} at {layer['lag_s']:+.0f} s, q {layer['q']:.3f}; without geometry "
        f"{layer['correlation_partial']:+.2f}, q {layer['q_partial']:.3f}"
    )


def draw_masks(movie: FloatArray, masks: BoolArray, path: Path) -> None:
    """Both channels of some frames, with the outline of the mask."""
    from matplotlib.figure import Figure

    shown = np.linspace(0, len(movie) - 1, SHOWN).astype(int)
    figure = Figure(figsize=(2.0 * SHOWN, 4.2), layout="constrained")
    axes = figure.subplots(2, SHOWN)
    for column, frame in zip(axes.T, shown, strict=True):
        for ax, image, name in zip(column, movie[frame], CHANNELS, strict=True):
            ax.imshow(image, cmap="gray", vmax=np.percentile(image[masks[frame]], 99.0))
            ax.contour(masks[frame], [0.5], colors="#e69f00", linewidths=0.8)
            ax.set_title(f"{name}, {FRAME_S * frame:.0f} s", fontsize=8)
            ax.set_axis_off()
    figure.savefig(path, dpi=120)


def draw_poles(study: cd.Study, path: Path) -> None:
    """Both channels of the outermost layer and the edge's velocity, by time and sector."""
    from matplotlib.figure import Figure

    activity = study.activity(0).load()
    shown = {name: activity["mean"].sel(channel=name).isel(layer=0) for name in CHANNELS}
    shown["velocity"] = activity["velocity"]
    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    for ax, (name, series) in zip(figure.subplots(1, 3, sharey=True), shown.items(), strict=True):
        values = series.dropna("time", how="all").transpose("time", "sector").to_numpy()
        values = values - np.nanmean(values, axis=1, keepdims=True)
        values /= np.nanstd(values, axis=1, keepdims=True)
        seconds = FRAME_S * len(values)
        drawn = ax.imshow(
            values, cmap="RdBu_r", vmin=-2.5, vmax=2.5, aspect="auto", extent=(0, SECTORS, seconds, 0)
        )
        ax.set(title=name, xlabel="sector", xticks=range(0, SECTORS + 1, 12))
    figure.axes[0].set_ylabel("time (s)")
    figure.colorbar(drawn, ax=figure.axes, label="SD from the frame's mean")
    figure.savefig(path, dpi=120)


def measure(source: Path, out: Path, frames: int, surrogates: int) -> None:
    """Make masks, run the commands and print the table."""
    movie = tifffile.imread(source)[:frames]
    masks, thresholds = cell_masks(movie.astype(float))
    out.mkdir(parents=True, exist_ok=True)
    for name, values, axes in (
        ("masks.tif", masks.astype(np.uint8), "TYX"),
        ("signal.ome.tif", movie, "TCYX"),
    ):
        tifffile.imwrite(out / name, values, metadata={"axes": axes}, photometric="minisblack")
    draw_masks(movie.astype(float), masks, out / "masks.png")
    study = cd.run_movie(
        out / "masks.tif",
        out / "study",
        signal=out / "signal.ome.tif",
        channels=CHANNELS,
        layers=LAYERS,
        sectors=SECTORS,
        frame_interval_s=FRAME_S,
        overwrite=True,
    )
    draw_poles(study, out / "poles.png")
    print(f"{'threshold, least to most':<56} {thresholds.min():.2f} to {thresholds.max():.2f}")
    for what, figure in rows(study, masks, surrogates):
        print(f"{what:<56} {figure}", flush=True)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--data", type=Path, default=Path(os.environ.get("CYTODISK_DATA", "../shared/data")))
    parser.add_argument("--out", type=Path, help="folder that keeps the study and the pictures")
    parser.add_argument("--frames", type=int, default=USED, help="so many of the 200 frames")
    parser.add_argument("--surrogates", type=int, default=999)
    given = parser.parse_args()
    mpl.use("agg")
    with tempfile.TemporaryDirectory() as folder:
        measure(given.data / FILE, given.out or Path(folder), given.frames, given.surrogates)


if __name__ == "__main__":
    main()
