"""Draw the picture of the page "Cells with their nuclei": real cells, two signals from nucleus to membrane.

    CYTODISK_DATA=FOLDER docs/draw_nuclei.py

The images are fields of Schwann cells in CytoDataFrame (cytomining, BSD-3-Clause). The script reads
`schwann_nuclei/*_signal.tif` (DAPI, GFP, RFP), `*_cells.tif` and `*_nuclei.tif`. Writes into
`docs/source/guides/nucleus`, and prints how many cells there were, and what their innermost layer is.
"""

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tifffile
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image
from skimage.filters import gaussian
from skimage.measure import label, regionprops
from skimage.segmentation import expand_labels, watershed

import cytodisk as cd
from cytodisk.arrays import AnyArray, FloatArray
from cytodisk.files import replacing
from cytodisk.plot.layer_looks import layer_fills
from cytodisk.plot.nucleus.nucleus_profile import CHANNEL_COLOURS, shade_compartments
from cytodisk.plot.style import signal_limits

TARGET = Path(__file__).resolve().parent / "source" / "guides" / "nucleus"
FIELDS, SHOWN_FIELD, CHANNELS = ("B7", "D6", "D7"), "D7", ("DAPI", "GFP", "RFP")
PROFILES = {"GFP": CHANNEL_COLOURS[0], "RFP": CHANNEL_COLOURS[1]}
LAYERS, SECTORS, NUCLEUS_LAYERS = 6, 24, 2
SPECK_PX, LEAST_SOLIDITY = 400, 0.93  # less: no nucleus, or two that touch
LEAST_CYTOPLASM, AROUND_PX = 1.5, 5  # cytoplasm over nucleus, by area
WIDTH_MM, HEIGHT_MM, DPI, PALETTE = 180.0, 66.0, 220, 256


@dataclass(frozen=True, eq=False)
class Cell:
    """A mapped cell and the signal in its windows."""

    field: str
    windows: cd.CellWindows
    data: xr.Dataset


def main() -> None:
    """Write the picture."""
    folder = Path(os.environ["CYTODISK_DATA"]) / "schwann_nuclei"
    cells = [cell for field in FIELDS for cell in cells_of(folder, field)]
    image = tifffile.imread(folder / f"{SHOWN_FIELD}_signal.tif")[1].astype(np.float64)
    shown = [cell for cell in cells if cell.field == SHOWN_FIELD]
    tell(cells)
    with cd.plot.paper_style():
        figure = Figure(figsize=(WIDTH_MM / 25.4, HEIGHT_MM / 25.4))
        field = figure.add_axes((0.0, 0.01, 0.55, 0.9))
        draw_field(field, image, shown)
        draw_profiles(figure.add_axes((0.625, 0.2, 0.345, 0.66)), cells)
        figure.text(0.275, 0.94, "GFP, layers of the cytoplasm orange, of the nucleus blue", ha="center")
        TARGET.mkdir(parents=True, exist_ok=True)
        with replacing(TARGET / "schwann.png") as temporary:
            figure.savefig(temporary, dpi=DPI)
            with Image.open(temporary) as drawn:
                small = drawn.convert("RGB").quantize(PALETTE, dither=Image.Dither.NONE)
            small.save(temporary, "png", optimize=True)


def cells_of(folder: Path, field: str) -> Iterator[Cell]:
    """Cells of a field that have one nucleus and can be mapped."""
    signal, cells, nuclei = (
        tifffile.imread(folder / f"{field}_{name}.tif") for name in ("signal", "cells", "nuclei")
    )
    nuclei = label(nuclei > 0)
    around = expand_labels(nuclei, AROUND_PX)  # GFP is dim at the nuclear outline: start beyond
    cut = watershed(-gaussian(np.log1p(signal[1]), 1.5), around, mask=(cells > 0) | (nuclei > 0))
    grid = cd.polar_windows(layers=LAYERS, sectors=SECTORS, nucleus_layers=NUCLEUS_LAYERS)
    images = xr.DataArray(signal, dims=("channel", "y", "x"), coords={"channel": list(CHANNELS)})
    for nucleus in regionprops(nuclei):
        mask = cut == nucleus.label
        if nucleus.area < SPECK_PX or nucleus.solidity < LEAST_SOLIDITY:
            continue
        if mask.sum() < (1 + LEAST_CYTOPLASM) * nucleus.area:
            continue
        try:
            disk = cd.map_to_disk(mask, nucleus=nuclei == nucleus.label)
        except cd.errors.CytodiskError as error:
            print(f"{field} nucleus {nucleus.label}: {error}")
            continue
        windows = grid.on(disk)
        yield Cell(field, windows, cd.sample(windows, images))


def draw_field(ax: Axes, image: AnyArray, cells: list[Cell]) -> None:
    """The image with the windows of its cells in the colours of their layers."""
    low, high = signal_limits(image)
    ax.imshow(image, cmap="gray", vmin=low, vmax=high)
    fills = np.repeat(layer_fills(LAYERS + NUCLEUS_LAYERS, NUCLEUS_LAYERS), SECTORS, axis=0)
    for cell in cells:
        polygons = [polygon[:, ::-1] for polygon in cell.windows.polygons()]
        ax.add_collection(PolyCollection(polygons, facecolors=fills, alpha=0.55, linewidths=0.0))
        cd.plot.draw_outline(ax, cell.windows.disk, color="white", linewidth=0.4)
    ax.set_axis_off()


def draw_profiles(ax: Axes, cells: list[Cell]) -> None:
    """A thin line a cell, a thick one their mean, in multiples of the cytoplasm's mean."""
    count = LAYERS + NUCLEUS_LAYERS
    places = count - 0.5 - np.arange(count)
    shade_compartments(ax, (0.0, float(NUCLEUS_LAYERS), float(count)))
    for channel, colour in PROFILES.items():
        table = profiles(cells, channel)
        for row in table:
            ax.plot(places, row, color=colour, linewidth=0.35, alpha=0.35)
        ax.plot(places, table.mean(axis=0), "o-", color=colour, linewidth=1.6, markersize=3)
    handles = [
        Line2D([], [], color=colour, marker="o", markersize=3, label=name)
        for name, colour in PROFILES.items()
    ]
    ax.legend(handles=handles, frameon=False, loc="upper right")
    ax.set_xticks(places, [str(layer) for layer in range(count)])
    ax.set(xlim=(0, count), xlabel=f"layer, 0 at the membrane; {len(cells)} cells")
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel("mean / mean of the cytoplasm")


def profiles(cells: list[Cell], channel: str) -> FloatArray:
    """Mean of each layer over that of the cytoplasm, a row a cell."""
    rows = []
    for cell in cells:
        profile = cd.nuclear_profile(cell.data.sel(channel=channel))
        mean, area = profile["mean"].to_numpy(), profile["area"].to_numpy()
        rows.append(mean / np.average(mean[:LAYERS], weights=area[:LAYERS]))
    return np.array(rows)


def tell(cells: list[Cell]) -> None:
    """Print how near to the nucleus the innermost layer of the cytoplasm is, in radii of the nucleus."""
    print(len(cells), "cells")
    rows = []
    for cell in cells:
        report = cell.windows.disk.nucleus
        assert report is not None
        radius = np.sqrt(report.report.area_px / np.pi)
        rows.append(cell.data["nucleus_distance"].sel(layer=LAYERS - 1).to_numpy() / radius)
    found = np.array(rows)
    print("innermost layer, radii of the nucleus away from it: median window", np.median(found).round(2))
    print(
        "median cell: nearest and farthest sector", *np.median([found.min(1), found.max(1)], axis=1).round(2)
    )
    print("farthest sector of any cell", found.max().round(2))
    for channel in PROFILES:
        table = profiles(cells, channel)
        print(
            channel, "by layer, mean of cells:", table.mean(axis=0).round(2), "sd", table.std(axis=0).round(2)
        )


if __name__ == "__main__":
    main()
