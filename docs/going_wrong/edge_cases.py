"""Cases of masks and of the edge's motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from case_study import NOTHING, cell_axes, draw_outline, flags_said, study_of
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.plot.style import INWARD_COLOUR, OUTWARD_COLOUR

SEED = 1000


def thin_protrusion(figure: Figure, folder: Path) -> list[str]:
    """A protrusion of 5 px that grows: the sector's mean velocity is small, that of its fastest piece not."""
    truth = cd.simulate.movie("filopodium", SEED, frames=15, radius_px=35.0, signals=False)
    study = study_of(folder, truth.masks)
    cell, graph = figure.subplots(1, 2, width_ratios=(1, 1.4))
    for frame, shade in zip((0, 4, 8, 12), ("0.75", "0.55", "0.3", "0"), strict=True):
        draw_outline(cell, truth.masks[frame], color=shade)
    cell_axes(cell, "frames 0, 4, 8, 12")
    edge = study.edge[study.edge["frame"] < 14].groupby("frame")
    for name, colour in (("velocity_fastest", OUTWARD_COLOUR), ("velocity", INWARD_COLOUR)):
        graph.plot(edge[name].max(), color=colour, label=f"largest {name}")
    graph.axhline(4.0, color="0.6", linewidth=0.6, linestyle="--", label="true velocity of the tip")
    graph.set(xlabel="frame", ylabel="velocity (px/frame)", ylim=(0, 5))
    graph.legend(frameon=False, loc="center right")
    return flags_said(study) or [NOTHING]


def sliding_edge(figure: Figure, folder: Path) -> list[str]:
    """A wave runs around the cell: points slide along the edge, and velocity is right all the same."""
    truth = cd.simulate.movie("waving", SEED, frames=12, radius_px=45.0, signals=False)
    study = study_of(folder, truth.masks)
    cell, graph = figure.subplots(1, 2, width_ratios=(1, 1.4))
    for frame, shade in zip((0, 4, 8), ("0.7", "0.4", "0"), strict=True):
        draw_outline(cell, truth.masks[frame], color=shade)
    cell_axes(cell, "frames 0, 4, 8")
    rows = study.edge[study.edge["frame"] == 4]
    graph.errorbar(
        rows["sector"], rows["velocity"], rows["velocity_error"], color=OUTWARD_COLOUR, linewidth=0.8
    )
    edge = study.edge
    mean = (edge["velocity"] * edge["edge_length"]).sum() / edge["edge_length"].sum()
    graph.axhline(0.0, color="0.6", linewidth=0.6)
    title = f"frame 4; mean of all frames {mean:+.3f}".replace("-", "−")
    graph.set(xlabel="sector", ylabel="velocity (px/frame)", title=title)
    return flags_said(study) or [NOTHING]


def turning_cell(figure: Figure, folder: Path) -> list[str]:
    """Lobes that stand and change sign: the outlines would fit better after a turn that never was."""
    truth = cd.simulate.movie("lobes", SEED, frames=20, radius_px=45.0, signals=False)
    study = study_of(folder, truth.masks)
    cell, graph = figure.subplots(1, 2, width_ratios=(1, 1.4))
    angle = study.cells["registration_angle"].to_numpy()
    apart = (truth.masks[:, None] ^ truth.masks[None]).sum(axis=(2, 3))
    first, other = np.unravel_index(apart.argmax(), apart.shape)
    for frame, colour in ((first, INWARD_COLOUR), (other, OUTWARD_COLOUR)):
        draw_outline(cell, truth.masks[frame], color=colour)
    cell_axes(cell, f"frames {first} and {other}")
    graph.plot(angle, color="0.15")
    graph.set(xlabel="frame", ylabel="turn since frame 0 (°)", ylim=(-45, 45))
    return flags_said(study) or [NOTHING]


def leaps_of_the_mask(figure: Figure, folder: Path) -> list[str]:
    """Three masks that are too large, in a cell that grows."""
    truth = cd.simulate.movie("growing", SEED, frames=30, radius_px=30.0, speed_px=0.3, signals=False)
    masks = truth.masks.copy()
    centre = np.argwhere(masks[0]).mean(axis=0)
    distance = np.hypot(*(np.indices(masks[0].shape) - centre[:, None, None]))
    for frame, share in ((7, 0.08), (15, 0.16), (22, 0.12)):
        radius = np.sqrt(masks[frame].sum() * (1 + share) / np.pi)
        masks[frame] |= distance < radius
    study = study_of(folder, masks)
    (flag,) = [flag for flag in cd.qc_flags(study) if flag.name == "area jumps"]
    at = [place.frame for place in flag.places]
    graph = figure.subplots()
    area = study.cells["area"]
    graph.plot(study.cells["frame"], area, ".-", color="0.4", markersize=3, linewidth=0.6)
    marks = {"color": OUTWARD_COLOUR, "markersize": 4, "fillstyle": "none", "label": "flag"}
    graph.plot(at, area.to_numpy()[at], "o", **marks)
    graph.set(xlabel="frame", ylabel="area (px²)")
    graph.legend(frameon=False)
    return flags_said(study, "area jumps")


def scaled_up_masks(figure: Figure, folder: Path) -> list[str]:
    """Masks drawn at a sixth of the size."""
    truth = cd.simulate.movie("bulging", SEED, frames=15, radius_px=45.0, signals=False)
    coarse = cd.simulate.scaled_up_masks(truth.masks, 6)
    study = study_of(folder / "coarse", coarse)
    fine = study_of(folder / "fine", truth.masks)
    cell, *maps = figure.subplots(1, 3, width_ratios=(1, 1.1, 1.1))
    draw_outline(cell, truth.masks[5], color="0.6")
    draw_outline(cell, coarse[5], color="0")
    cell_axes(cell, "frame 5")
    for axes, found, title in zip(maps, (fine, study), ("as drawn", "scaled up"), strict=True):
        table = found.edge.pivot(index="sector", columns="frame", values="velocity")
        image = axes.imshow(table, cmap="RdBu_r", vmin=-4, vmax=4, aspect="auto", origin="lower")
        axes.set(xlabel="frame", title=title)
    maps[0].set_ylabel("sector")
    figure.colorbar(image, ax=maps, label="velocity (px/frame)")
    return flags_said(study, "coarse outline")


CASES = {
    "thin_protrusion": thin_protrusion,
    "sliding_edge": sliding_edge,
    "turning_cell": turning_cell,
    "leaps_of_the_mask": leaps_of_the_mask,
    "scaled_up_masks": scaled_up_masks,
}
