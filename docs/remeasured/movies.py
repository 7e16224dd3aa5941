"""Windows of each method through the melanoma and Dictyostelium movies: Fig. 4 of the paper."""

import shutil
from pathlib import Path
from typing import Any

import pandas as pd

from cytodisk.pages.compared_movie import write_compared_movie
from cytodisk.runs.compare_windows.compare_parameters import TITLES, CompareMovieParameters, MovieMethod
from cytodisk.runs.compare_windows.comparison import Comparison
from cytodisk.runs.compare_windows.run_compare_windows import run_compare_windows
from remeasured import shapes
from remeasured.cells import percent

MOVIES: dict[str, tuple[str, str, dict[str, Any]]] = {
    "melanoma": (
        "melanoma_vasp_lpd/mask.tif",
        "melanoma_vasp_lpd/signal.ome.tif",
        {"channels": ("VASP", "lamellipodin"), "depth_px": 10.0},  # 1.5 µm; the paper's are 1.6 µm
    ),
    "dictyostelium": (
        "dictyostelium_rac1/mask.tif",
        "dictyostelium_rac1/rac1.tif",
        {"channels": ("Rac1",), "frame_interval_s": 1.29},
    ),
}
BESIDE = {"edge": "edge-based", "springs": "with springs", "registered": "registered"}
LAYERS, SECTORS = 10, 60  # about as many sectors as in the paper
METHODS: tuple[MovieMethod, ...] = ("newton", "harmonic", "edge", "springs", "registered")
PEAK = 3.0  # times the median displacement: a step at which windows are mistracked


def measure(data: Path, work: Path) -> dict[str, Comparison]:
    """One comparison a movie."""
    found = {}
    for name, (masks, signal, more) in MOVIES.items():
        print(name, flush=True)
        out = work / f"movie_{name}"
        parameters = CompareMovieParameters(layers=LAYERS, sectors=SECTORS, methods=METHODS, **more)
        found[name] = run_compare_windows(
            data / masks, out, parameters=parameters, signal=data / signal, **shapes.again(out)
        )
    return found


def write(found: dict[str, Any], files: Path) -> dict[str, Any]:
    """Fig. 4B to D of each movie, and a table."""
    for name, comparison in found["movies"].items():
        picture = write_compared_movie(comparison, 0, channel_of(name))
        shutil.copy(picture, files / f"{name}.png")
    words(summaries(found["movies"])).to_csv(files / "movies.csv", index=False)
    return {}


def channel_of(name: str) -> str:
    """The channel of a movie that is compared."""
    return str(MOVIES[name][2]["channels"][0])


def summaries(found: dict[str, Comparison]) -> pd.DataFrame:
    """The measures of Fig. 4, one row a movie and method."""
    return pd.DataFrame([summary(name, one, method) for name, one in found.items() for method in one.methods])


def summary(name: str, comparison: Comparison, method: str) -> dict[str, Any]:
    """The measures of Fig. 4 of one method on one movie."""
    rows = comparison.consistency
    rows = rows[(rows["method"] == method) & (rows["channel"] == channel_of(name))]
    layers = comparison.by_layer[comparison.by_layer["method"] == method]
    correlation = rows.groupby("layer")["correlation"].mean().reindex(range(LAYERS))
    moved = rows.groupby("frame")["centroid_displacement"].mean().dropna()
    return {
        "movie": name,
        "method": method,
        "complete": layers["completeness"].mean(),
        "emptiest": layers["completeness"].min(),
        "coverage": comparison.by_method.set_index("method").loc[method, "coverage"],
        "correlation": correlation.mean(),
        "correlation_least": correlation.min(),
        "correlation_most": correlation.max(),
        "layers_without": int(correlation.isna().sum()),
        "folded": comparison.by_method.set_index("method").loc[method].get("folded"),
        "outside": comparison.by_method.set_index("method").loc[method].get("carried_outside"),
        "eccentricity": layers["eccentricity"].mean(),
        "eccentricity_cv": layers["eccentricity_cv"].mean(),
        "displacement": moved.mean(),
        "peaks": int((moved > PEAK * moved.median()).sum()),
        "largest": moved.max(),
        "steps": len(moved),
        "unit": comparison.provenance["length_unit"],
    }


def words(table: pd.DataFrame) -> pd.DataFrame:
    """The table as the page shows it."""
    rows = []
    for row in table.itertuples():
        correlation = f"{row.correlation:.3f} ({row.correlation_least:.3f} to {row.correlation_most:.3f})"
        rows.append(
            {
                "movie": row.movie,
                "windows": TITLES[str(row.method)],
                "with signal": percent(row.complete),
                "emptiest layer": percent(row.emptiest),
                "area covered": percent(row.coverage),
                "field folds, carried outside": two_shares(row.folded, row.outside),
                "eccentricity (CV)": f"{row.eccentricity:.2f} ({row.eccentricity_cv:.3f})",
                "correlation of consecutive frames, mean (lowest to highest layer)": correlation,
                "layers without one": row.layers_without,
                "displacement of centroids a frame": f"{row.displacement:.3g} {row.unit}",
                f"steps above {PEAK:g} times the median": f"{row.peaks} of {row.steps}",
            }
        )
    return pd.DataFrame(rows)


def two_shares(folded: float, outside: float) -> str:
    """What a registration did to windows, in words; nothing for the others."""
    return f"{percent(folded)}, {percent(outside)}" if pd.notna(folded) else "–"
