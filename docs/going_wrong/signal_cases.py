"""Cases of signals and of the places that windows stand for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from case_study import cell_axes, draw_outline, flags_said, study_of
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.plot.style import INWARD_COLOUR, OUTWARD_COLOUR

SEED = 1000
FRAMES = 12


def _cut_off(figure: Figure, folder: Path, name: str) -> list[str]:
    truth = cd.simulate.movie("migrating", SEED, frames=FRAMES, radius_px=35.0)
    assert truth.signal is not None
    raw = truth.signal.sel(channel="edge").to_numpy().astype(float)
    inside = raw[truth.masks]
    if name == "clipped signal":
        cut = np.maximum(raw - np.quantile(inside, 0.6), 0.0)
        before = raw - np.quantile(inside, 0.6)
    else:
        cut, before = np.minimum(raw, 400.0), raw
    study = study_of(folder, truth.masks, {"VASP": cut})
    image, graph = figure.subplots(1, 2, width_ratios=(1, 1.4))
    shown = image.imshow(np.where(truth.masks[3], cut[3], np.nan), cmap="viridis")
    figure.colorbar(shown, ax=image, label="signal (a.u.)", shrink=0.8)
    draw_outline(image, truth.masks[3], color="0.3")
    cell_axes(image, "the signal, frame 3")
    image.invert_yaxis()
    bins = np.linspace(before[truth.masks].min(), before[truth.masks].max(), 60)
    graph.hist(cut[truth.masks], bins, color=OUTWARD_COLOUR, alpha=0.7, label="what came in")
    graph.hist(before[truth.masks], bins, color="0.2", histtype="step", linewidth=0.7, label="what was there")
    graph.set(xlabel="value of the pixel (a.u.)", ylabel="number of pixels", yscale="log", ylim=(1, 1e6))
    graph.legend(frameon=False, loc="upper right")
    return flags_said(study, name)


def clipped_signal(figure: Figure, folder: Path) -> list[str]:
    """Too much background was subtracted."""
    return _cut_off(figure, folder, "clipped signal")


def saturated_signal(figure: Figure, folder: Path) -> list[str]:
    """The detector ended below the bright edge."""
    return _cut_off(figure, folder, "saturated signal")


def depth_in_cells_of_any_size(figure: Figure, folder: Path) -> list[str]:
    """One cortex in cells of four sizes, by layer and by depth."""
    by_layer, by_depth = figure.subplots(1, 2, sharey=True)
    borders = (0.5, 1.0, 2.0, 3.0)
    words = []
    for radius, shade in zip((4.0, 8.0, 12.0, 20.0), ("0.75", "0.5", "0.25", "0"), strict=True):
        cell = cd.simulate.cell_with_cortex(radius, SEED)
        disk = cd.map_to_disk(cell.mask, pixel_size_um=cell.signal.attrs["pixel_size_um"])
        for axes, grid in (
            (by_layer, cd.polar_windows(5, 24)),
            (by_depth, cd.polar_windows(sectors=24, depth_um=borders)),
        ):
            data = cd.sample(grid.on(disk), cell.signal).isel(channel=0)
            mean = data["mean"].mean("sector")
            axes.plot(mean["layer"], mean, "o-", markersize=2.5, color=shade, label=f"radius {radius:.0f} µm")
            if axes is by_depth:
                words.append(f"radius {radius:4.0f} µm: outermost layer {float(mean[0]):.0f}")
    by_layer.set(xlabel="layer", ylabel="mean signal (a.u.)", title="layers of equal area")
    by_depth.set(xlabel="layer", title=f"borders at {', '.join(f'{b:g}' for b in borders)} µm")
    by_depth.legend(frameon=False)
    return words


def interior_under_a_protrusion(figure: Figure, folder: Path) -> list[str]:
    """A nucleus that stands still while one side grows."""
    truth = cd.simulate.movie("lamellipodium", SEED, frames=21, radius_px=40.0, signals=False)
    masks = truth.masks
    grid = cd.polar_windows(3, 8)
    panels = figure.subplots(1, 3)
    centre = np.argwhere(masks[0]).mean(axis=0)
    angle = np.linspace(0, 2 * np.pi, 100)
    nucleus = centre + 10.0 * np.stack([np.sin(angle), np.cos(angle)], axis=1)
    shown = {"frame 0": ("area", 0), "frame 20, area": ("area", 20), "frame 20, still": ("still", 20)}
    movies = {name: cd.map_movie(masks, interior=name) for name in ("area", "still")}
    words = []
    for axes, (title, (name, frame)) in zip(panels, shown.items(), strict=True):
        windows = grid.on(movies[name][frame])
        cd.plot.draw_windows(axes, windows, color="0.5", linewidth=0.5)
        axes.fill(nucleus[:, 1], nucleus[:, 0], facecolor="none", edgecolor=OUTWARD_COLOUR, linewidth=1.0)
        draw_outline(axes, movies[name][frame].mask, color="0.2")
        axes.set(xlim=(0, masks.shape[2]), ylim=(0, masks.shape[1]))
        cell_axes(axes, title)
        place = movies[name][frame].to_cell(movies[name][0].to_disk(centre[None]))[0]
        axes.plot(place[1], place[0], "+", color=INWARD_COLOUR, markersize=5)
        words.append(
            f"{title}: the window of the nucleus' centre is {np.hypot(*(place - centre)):.1f} px off"
        )
    return words[1:]


def small_windows(figure: Figure, folder: Path) -> list[str]:
    """A grid that is far too fine for the cell."""
    truth = cd.simulate.movie("spiky", SEED, frames=3, radius_px=20.0, signals=False)
    study = study_of(folder, truth.masks, layers=6, sectors=93)
    cell, graph = figure.subplots(1, 2, width_ratios=(1, 1.2))
    windows = cd.polar_windows(6, 93).on(cd.map_to_disk(truth.masks[0]))
    cd.plot.draw_windows(cell, windows, color="0.4", linewidth=0.3)
    draw_outline(cell, truth.masks[0], color="0.4", linewidth=0.3)
    cell_axes(cell, "6 × 93 windows")
    areas = np.sort(windows.areas.ravel())
    graph.hist(areas, 40, color="0.5")
    graph.axvline(10.0, color=OUTWARD_COLOUR, linewidth=0.8)
    graph.set(xlabel="area of a window (px²)", ylabel="number of windows", xlim=(0, None))
    return flags_said(study, "small windows")


CASES = {
    "clipped_signal": clipped_signal,
    "saturated_signal": saturated_signal,
    "depth_in_cells_of_any_size": depth_in_cells_of_any_size,
    "interior_under_a_protrusion": interior_under_a_protrusion,
    "small_windows": small_windows,
}
