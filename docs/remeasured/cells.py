"""Windows of each method on every osteosarcoma cell: Fig. 3 of the paper."""

import hashlib
import shutil
from pathlib import Path
from typing import Any

import pandas as pd

from cytodisk.pages.compared_cells import write_compared_cells
from cytodisk.pages.compared_layers import write_comparison
from cytodisk.runs.compare_windows.compare_parameters import TITLES, CompareWindowsParameters, WindowMethod
from cytodisk.runs.compare_windows.comparison import Comparison, open_comparison
from cytodisk.runs.compare_windows.run_compare_windows import run_compare_windows
from remeasured import shapes

GRIDS: dict[str, tuple[int, int, tuple[WindowMethod, ...]]] = {
    "12x60": (12, 60, ("newton", "edge", "springs")),
    "30x60": (30, 60, ("newton", "edge", "springs")),
    "50x100": (50, 100, ("newton", "edge", "springs")),
}
MAPS = "maps"  # the comparison of maps; the others are of windows with and without one
GRIDS[MAPS] = (12, 60, ("newton", "harmonic", "advection"))
BESIDE = {"newton": "cytodisk", "edge": "edge-based", "springs": "with springs"}

COLUMNS = {"completeness": "complete", "area_cv": "CV of area", "eccentricity_cv": "CV of eccentricity"}


def measure(masks: Path, work: Path, workers: int, maps: Path | None = None) -> dict[str, Comparison]:
    """One comparison a grid; that of maps can be one that was made before."""
    found = {}
    for name, (layers, sectors, methods) in GRIDS.items():
        if name == MAPS and maps is not None:
            found[name] = made_before(maps, masks)
            continue
        print(f"osteosarcoma, {name}: {', '.join(methods)}", flush=True)
        out = work / ("maps_12x60" if name == MAPS else f"cells_{name}")
        parameters = CompareWindowsParameters(
            layers=layers, sectors=sectors, methods=methods, fragments="largest"
        )
        found[name] = run_compare_windows(
            masks, out, parameters=parameters, workers=workers, **shapes.again(out)
        )
    return found


def made_before(maps: Path, masks: Path) -> Comparison:
    """A comparison of maps that stands, if it is of these cells by these methods and this grid."""
    found = open_comparison(maps)
    layers, sectors, methods = GRIDS[MAPS]
    provenance = found.provenance
    parameters = {"fragments": "largest"} | provenance["parameters"]  # there was no choice at first
    asked = (layers, sectors, "largest", hashlib.sha256(masks.read_bytes()).hexdigest())
    given = (
        *(parameters.get(name) for name in ("layers", "sectors", "fragments")),
        provenance["inputs"]["masks"]["sha256"],
    )
    if asked != given or not set(methods) <= set(found.methods):
        raise SystemExit(
            f"{maps} is no comparison of {', '.join(methods)} with {layers} × {sectors} windows on the "
            f"largest pieces of {masks}: pass another folder as --maps, or leave it out"
        )
    return found


def write(found: dict[str, Any], files: Path) -> dict[str, Any]:
    """Fig. 3A and 3B, and the tables by layer and by grid."""
    comparison = found["cells"]["12x60"]
    chosen = shapes.representatives(found["shapes"]["table"])
    write_compared_cells(comparison, chosen)
    write_comparison(comparison)
    for name in ("cells", "comparison"):
        shutil.copy(comparison.path / "figures" / f"{name}.png", files / f"{name}.png")
    by_layer(comparison).to_csv(files / "by_layer.csv", index=False)
    by_method(found["cells"][MAPS], comparison).to_csv(files / "by_method.csv", index=False)
    grids(found["cells"]).to_csv(files / "grids.csv", index=False)
    made = found["cells"][MAPS].provenance
    return {
        "representatives": ", ".join(map(str, chosen)),
        "maps_made": f"{made['started'][:10]}, by cytodisk {made['versions']['cytodisk']}",
    }


def by_layer(comparison: Comparison) -> pd.DataFrame:
    """Completeness and spread by layer, ours and edge-based ones with and without springs."""
    table = comparison.by_layer.set_index(["method", "layer"])
    rows = []
    for layer in sorted(set(comparison.by_layer["layer"])):
        row: dict[str, Any] = {"layer": layer}
        for name, title in COLUMNS.items():
            for method, whose in BESIDE.items():
                value = table.loc[(method, layer), name]
                row[f"{title}, {whose}"] = percent(value) if name == "completeness" else f"{value:.3f}"
        rows.append(row)
    return pd.DataFrame(rows)


def by_method(maps: Comparison, windows: Comparison) -> pd.DataFrame:
    """What each method made of all cells: maps, then windows that need none."""
    rows = []
    others = windows.by_method[windows.by_method["method"] != "newton"]
    on_maps = maps.by_method[maps.by_method["method"].isin(GRIDS[MAPS][2])]
    for row in (*on_maps.itertuples(), *others.itertuples()):
        on_map = pd.notna(row.area_error)
        rows.append(
            {
                "windows": TITLES[row.method],
                "cells": f"{row.mapped:.0f} of {row.tried:.0f}",
                "maps that are not one to one": f"{row.invalid_maps:.0f}" if on_map else "no map",
                "area error of triangles": f"{row.area_error:.3f}" if on_map else "no map",
                "windows with signal": percent(row.completeness),
                "area covered": percent(row.coverage),
                "CV of area": f"{row.area_cv:.3f}",
                "CV of eccentricity": f"{row.eccentricity_cv:.3f}",
                "seconds a cell": f"{row.seconds:.2f}",
            }
        )
    return pd.DataFrame(rows)


def grids(found: dict[str, Comparison]) -> pd.DataFrame:
    """Completeness at coarse and fine grids: in all, and in the emptiest layer."""
    rows = []
    for name, comparison in found.items():
        for method in BESIDE if name != MAPS else ():
            own = comparison.by_layer[comparison.by_layer["method"] == method]
            rows.append(
                {
                    "grid": name.replace("x", " × "),
                    "windows": TITLES[method],
                    "in all": percent(own["completeness"].mean()),
                    "emptiest layer": percent(own["completeness"].min()),
                }
            )
    return pd.DataFrame(rows)


def percent(share: float) -> str:
    """A share in words; 100 % only if it is all, 0 % only if there is nothing."""
    text = f"{100 * share:.1f}"
    if text == "100.0" and share < 1:
        return "> 99.9 %"
    return "< 0.1 %" if text == "0.0" and share > 0 else f"{text.removesuffix('.0')} %"
