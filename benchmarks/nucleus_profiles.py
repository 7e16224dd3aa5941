"""DAPI, GFP and RFP of real cells by layer, from the membrane to the nucleus and into it; rings beside them.

    benchmarks/nucleus_profiles.py [--quick] [--layers 6] [--sectors 24] [--nucleus-layers 3]

Takes the fields of touching Schwann cells (of the folder in CYTODISK_DATA), cut around their nuclei by a
watershed, without cells that touch the image's border or that are refused. The background of a field is the
median of what is 20 px or more from all cells. Prints, as means over cells:

* by layer of the map: its share of the compartment's area, its distance to the membrane and to the nuclear
  outline in px, and each channel over its mean in the cytoplasm; "±" is the standard deviation over cells;
* the same layers of rings by distance, d / (d_membrane + d_nucleus), and of rings interpolated from outline
  to outline, with the cells in which a window is empty;
* of each channel: mean of the nucleus over that of the cytoplasm, with background and without, and the
  shares of the cytoplasm's total in the third at the nucleus and in the third at the membrane (even: 0.333);
* how far the nucleus is out of the middle, and how often a channel has a direction.

Ends with status 1 unless DAPI is brighter in the nucleus than in the cytoplasm in all cells.
"""

import argparse
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import tifffile
import xarray as xr
from scipy import ndimage

import cytodisk as cd
from cytodisk.analysis.compartments.layer_sums import group_means
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import CytodiskError
from cytodisk.windows.on_cell import WindowsOnCell
from real_masks import DATA
from schwann_nuclei import Case, schwann_cases

CHANNELS = ("DAPI", "GFP", "RFP")
QUICK = 8
_FAR_PX = 20  # from all cells, where the background is taken


@dataclass(frozen=True)
class Layers:
    """How many windows there are."""

    layers: int
    sectors: int
    nucleus_layers: int

    @property
    def settings(self) -> dict[str, int]:
        return {"layers": self.layers, "sectors": self.sectors, "nucleus_layers": self.nucleus_layers}


@dataclass(frozen=True, eq=False)
class Cell:
    """A cell, its nucleus and its image, with the background of its field."""

    name: str
    mask: BoolArray
    nucleus: BoolArray
    image: FloatArray
    background: FloatArray


@dataclass(frozen=True, eq=False)
class Found:
    """What a cell came to: profiles by method, shape (channels, layers), shares of area, empty windows."""

    name: str
    profiles: dict[str, FloatArray]
    shares: dict[str, FloatArray]
    empty: dict[str, int]
    where: FloatArray
    raw: xr.Dataset
    clean: xr.Dataset


def schwann_cells(data: Path) -> Iterator[Cell]:
    """The cells with their images; those at the border of the image are left out."""
    fields: dict[str, tuple[FloatArray, FloatArray]] = {}
    for case in schwann_cases(data):
        field = case.name.split()[0]
        if field not in fields:
            image = tifffile.imread(data / "schwann_nuclei" / f"{field}_signal.tif").astype(np.float64)
            cells = tifffile.imread(data / "schwann_nuclei" / f"{field}_cells.tif") > 0
            far = ndimage.distance_transform_edt(~cells) >= _FAR_PX
            fields[field] = image, np.median(image[:, far], axis=1)
        image, background = fields[field]
        if _at_border(case):
            continue
        (top, left), (height, width) = case.corner, case.mask.shape
        piece = image[:, top : top + height, left : left + width]
        yield Cell(case.name, case.mask, case.nucleus, piece, background)


def _at_border(case: Case) -> bool:
    """Whether the mask, which has background around it elsewhere, touches an edge of its piece."""
    edges = (case.mask[0], case.mask[-1], case.mask[:, 0], case.mask[:, -1])
    return any(edge.any() for edge in edges)


def measure(cell: Cell, layers: Layers) -> Found | str:
    """Profiles of a cell by each method; words if it is refused."""
    try:
        disk = cd.map_to_disk(cell.mask, nucleus=cell.nucleus)
    except CytodiskError as error:
        return str(error)
    image = cell.image - cell.background[:, None, None]
    nucleus = disk.nucleus.mask
    methods: dict[str, WindowsOnCell] = {
        "map": cd.polar_windows(**layers.settings).on(disk),
        "by distance": cd.nucleus_ring_windows(disk.mask, nucleus, **layers.settings),
        "interpolated": cd.interpolated_ring_windows(disk.mask, nucleus, **layers.settings),
    }
    in_nucleus = np.arange(layers.layers + layers.nucleus_layers) >= layers.layers
    means = np.array([channel[disk.mask & ~nucleus].mean() for channel in image])
    profiles, shares = {}, {}
    for name, windows in methods.items():
        data = cd.sample(windows, image)
        by_layer = group_means(data["mean"].to_numpy(), data["n_pixels"].to_numpy()).mean
        profiles[name] = by_layer / means[:, None]
        area = windows.areas.sum(axis=1)
        whole = np.where(in_nucleus, area[in_nucleus].sum(), area[~in_nucleus].sum())
        shares[name] = area / whole
    raw, clean = (_named(methods["map"], one) for one in (cell.image, image))
    profile = cd.nuclear_profile(clean)
    where = np.stack([profile["depth"], profile["nucleus_distance"]])
    summaries = cd.nucleus_summary(disk, raw), cd.nucleus_summary(disk, clean)
    empty = {name: windows.n_empty for name, windows in methods.items()}
    return Found(cell.name, profiles, shares, empty, where, *summaries)


def _named(windows: WindowsOnCell, image: FloatArray) -> xr.Dataset:
    return cd.sample(windows, xr.DataArray(image, {"channel": list(CHANNELS)}, ("channel", "y", "x")))


def print_profiles(found: Sequence[Found], layers: Layers) -> None:
    """Print a row a layer for each method."""
    where = np.mean([one.where for one in found], axis=0)
    for method in found[0].profiles:
        values = np.stack([one.profiles[method] for one in found])
        shares = np.mean([one.shares[method] for one in found], axis=0)
        with_empty = sum(one.empty[method] > 0 for one in found)
        print(f"\n{method}: {with_empty} of {len(found)} cells with empty windows")
        heads = f"{'':<4}{'':<11}{'area':>6}" + ("  membrane  nucleus" if method == "map" else "")
        print(heads + "".join(f"{channel:>15}" for channel in CHANNELS))
        for layer in range(layers.layers + layers.nucleus_layers):
            compartment = "cytoplasm" if layer < layers.layers else "nucleus"
            line = f"{layer:<4}{compartment:<11}{shares[layer]:>6.3f}"
            line += f"{where[0, layer]:>10.1f}{where[1, layer]:>9.1f}" if method == "map" else ""
            for channel in range(len(CHANNELS)):
                known = values[:, channel, layer][np.isfinite(values[:, channel, layer])]
                line += f"{known.mean():>9.2f} ±{known.std():>4.2f}"
            print(line)


def print_summaries(found: Sequence[Found]) -> None:
    """Print a row a channel, and where the nuclei are."""
    print(
        f"\n{'':<6}{'with background':>17}{'nucleus/cytoplasm':>19}{'perinuclear':>14}{'peripheral':>14}",
        end="",
    )
    print(f"{'polarity':>11}{'has direction':>15}")
    for channel in CHANNELS:
        raw = np.array([one.raw["nucleus_to_cytoplasm"].sel(channel=channel) for one in found])
        clean = xr.concat([one.clean.sel(channel=channel) for one in found], "cell")
        ratio = clean["nucleus_to_cytoplasm"]
        line = f"{channel:<6}{raw.mean():>17.2f}{float(ratio.mean()):>12.2f} ±{float(ratio.std()):>5.2f}"
        for name in ("perinuclear_share", "peripheral_share"):
            line += f"{float(clean[name].mean()):>8.3f} ±{float(clean[name].std()):>4.2f}"
        known = clean["signal_direction"].notnull()
        print(f"{line}{float(clean['signal_polarity'].mean()):>11.3f}{float(known.mean()):>15.0%}")
    polarity = np.array([one.clean["nucleus_polarity"] for one in found])
    print(f"nucleus out of the middle by {np.median(polarity):.2f} of the cell's radius (median)")


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--quick", action="store_true", help=f"one cell in {QUICK}")
    parser.add_argument("--layers", type=int, default=6, help="layers of the cytoplasm (default 6)")
    parser.add_argument("--sectors", type=int, default=24, help="sectors (default 24)")
    parser.add_argument("--nucleus-layers", type=int, default=3, help="layers of the nucleus (default 3)")
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    chosen = parser.parse_args()
    if not (chosen.data / "schwann_nuclei").is_dir():
        print(f"{chosen.data} has no folder schwann_nuclei: set CYTODISK_DATA or pass --data")
        return 1
    layers = Layers(chosen.layers, chosen.sectors, chosen.nucleus_layers)
    cells = list(schwann_cells(chosen.data))[:: QUICK if chosen.quick else 1]
    with ProcessPoolExecutor(chosen.workers) as pool:
        results = list(pool.map(partial(measure, layers=layers), cells))
    found = [one for one in results if isinstance(one, Found)]
    print(f"{len(found)} cells in {len({one.name.split()[0] for one in found})} fields, ", end="")
    print(f"{len(cells) - len(found)} refused")
    print_profiles(found, layers)
    print_summaries(found)
    ratios = [float(one.raw["nucleus_to_cytoplasm"].sel(channel="DAPI")) for one in found]
    dim = [f"{one.name} {ratio:.2f}" for one, ratio in zip(found, ratios, strict=True) if ratio <= 1.0]
    if dim:
        print(f"DAPI is not brighter in the nucleus: {', '.join(dim)}")
    return int(bool(dim))


if __name__ == "__main__":
    sys.exit(main())
