"""The paper's claims beside what was measured here, each with a verdict that the numbers give."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from remeasured.cells import percent
from remeasured.maps import PUBLISHED
from remeasured.movies import PEAK, summaries

UNIFORM = 0.1  # largest coefficient of variation of areas that are called alike
HIGH = 0.7  # least correlation that is called high


class Claim(NamedTuple):
    """One claim of the paper."""

    paper: str
    here: str
    verdict: str


def write(found: dict[str, Any], files: Path) -> dict[str, Any]:
    """The table `claims.csv`, and the numbers that the page's sentences quote."""
    claims = [*shape_claims(found), *movie_claims(found), *map_claims(found)]
    header = ["The paper says", "Measured here", "Holds here?"]
    pd.DataFrame(claims).set_axis(header, axis=1).to_csv(files / "claims.csv", index=False)
    return numbers(found)


def shape_claims(found: dict[str, Any]) -> Iterator[Claim]:
    """Section 4.1 and Fig. 3."""
    emptiest = {name: float(ours_by_layer(one)["completeness"].min()) for name, one in found["cells"].items()}
    published = pd.read_csv(PUBLISHED)["windows_percent"]
    yield Claim(
        "u-Unwrap windows sample signal in every window (4.1)",
        "emptiest layer of our windows: "
        + ", ".join(f"{percent(share)} at {name.replace('x', ' × ')}" for name, share in emptiest.items())
        + f"; 10 × 60 windows of the published program: {published.min():g} to {published.max():g} %",
        "yes, with our windows" if min(emptiest.values()) == 1.0 else "no",
    )
    ours, edge = ours_by_layer(found["cells"]["12x60"]), edge_by_layer(found["cells"]["12x60"])
    fall = edge["completeness"].to_numpy()
    yield Claim(
        "completeness of edge-based windows decreases rapidly with depth (4.1, Fig. 3B)",
        f"{percent(fall[0])} in layer 0, {percent(fall[len(fall) // 2])} in layer {len(fall) // 2}, "
        f"{percent(fall[-1])} in the last",
        yes(bool((np.diff(fall) <= 0).all()) and fall[-1] < 0.5 * fall[0]),
    )
    higher = [layer for layer in layers_not_below(ours, edge, "eccentricity_cv") if layer > 0]
    yield Claim(
        "eccentricity varies less than that of edge-based windows after the first layer (4.1, Fig. 3B)",
        f"coefficient of variation by layer: ours {span(ours['eccentricity_cv'])}, edge-based "
        f"{span(edge['eccentricity_cv'])}"
        + (f"; after the first layer ours is not lower in {listed(higher)}" if higher else ""),
        yes(not higher),
    )
    yield Claim(
        "windows are relatively uniform within each layer (4.1)",
        f"coefficient of variation of area by layer: ours {span(ours['area_cv'])}, edge-based "
        f"{span(edge['area_cv'])}",
        yes(bool((ours["area_cv"] < UNIFORM).all())),
    )


def movie_claims(found: dict[str, Any]) -> Iterator[Claim]:
    """Section 4.2 and Fig. 4."""
    table = summaries(found["movies"])
    ours, edge = (table[table["method"] == method].set_index("movie") for method in ("newton", "edge"))
    pairs = [(name, ours.loc[name], edge.loc[name]) for name in ours.index]
    yield Claim(
        "edge-based windows severely undersample inner layers (4.2, Fig. 4B)",
        "; ".join(
            f"{n}: emptiest layer {percent(b.emptiest)}, ours {percent(a.emptiest)}" for n, a, b in pairs
        ),
        over([b.emptiest < 0.5 and a.emptiest == 1.0 for _, a, b in pairs]),
    )
    yield Claim(
        "correlations of consecutive frames are consistently high, and more alike over layers than with "
        "edge-based windows (4.2, Fig. 4C)",
        "mean (lowest to highest layer): "
        + "; ".join(f"{n}: ours {correlations(a)}, edge-based {correlations(b)}" for n, a, b in pairs),
        f"above {HIGH:g} in every layer: {over([a.correlation_least > HIGH for _, a, _ in pairs])}; "
        f"more alike: {over([spread(a) < spread(b) for _, a, b in pairs])}; "
        f"higher than edge-based: {over([a.correlation > b.correlation for _, a, b in pairs])}",
    )
    yield Claim(
        "displacements of windows have similar magnitudes with both (4.2, Fig. 4D)",
        "; ".join(
            f"{n}: ours {a.displacement:.3g}, edge-based {b.displacement:.3g} {a.unit} a frame"
            for n, a, b in pairs
        ),
        over([0.5 < a.displacement / b.displacement < 2.0 for _, a, b in pairs]),
    )
    yield Claim(
        "edge-based windows have peaks of displacement, which ours have not (4.2, Fig. 4D)",
        "; ".join(
            f"{n}: ours {a.peaks} (largest {a.largest:.3g} {a.unit}), "
            f"edge-based {b.peaks} ({b.largest:.3g} {a.unit}) "
            f"of {a.steps} steps are above {PEAK:g} times the median of their own"
            for n, a, b in pairs
        ),
        over([bool(b.peaks > 0 and a.peaks == 0) for _, a, b in pairs]),
    )


def map_claims(found: dict[str, Any]) -> Iterator[Claim]:
    """Appendix A.2: the map."""
    methods = found["cells"]["12x60"].by_method.set_index("method")
    error, spread_of_areas = methods["area_error"], methods["area_cv"]
    yield Claim(
        "relaxation turns the conformal map into an equiareal one (A.2.1 iii)",
        f"median area error of triangles: harmonic {error['harmonic']:.3f}, "
        f"the paper's relaxation {error['advection']:.3f}, ours {error['newton']:.3f}; median coefficient of "
        f"variation of the areas of windows in a layer: {spread_of_areas['harmonic']:.3f}, "
        f"{spread_of_areas['advection']:.3f}, {spread_of_areas['newton']:.3f}",
        "it lowers the error" if error["advection"] < error["harmonic"] else "no",
    )
    invalid = methods["invalid_maps"]
    yield Claim(
        "Delaunay flips between steps ensure bijectivity (A.2.1 iii)",
        f"maps with triangles turned over: the paper's relaxation {share_of(methods, 'advection')}, "
        f"ours {share_of(methods, 'newton')}",
        yes(invalid["advection"] == 0),
    )


def numbers(found: dict[str, Any]) -> dict[str, Any]:
    """What the page's sentences quote."""
    comparison = found["cells"]["12x60"]
    methods = comparison.by_method.set_index("method")
    ours, edge = ours_by_layer(comparison), edge_by_layer(comparison)
    published = pd.read_csv(PUBLISHED)
    return {
        "n_tried": f"{methods.loc['newton', 'tried']:.0f}",
        "n_mapped": f"{methods.loc['newton', 'mapped']:.0f}",
        "higher_eccentricity": listed(layers_not_below(ours, edge, "eccentricity_cv")),
        "higher_area": listed(layers_not_below(ours, edge, "area_cv")),
        "higher_mean": listed(layers_not_below(ours, edge, "eccentricity")),
        "widest_layer": int(ours["eccentricity_cv"].idxmax()),
        "widest": f"{ours['eccentricity_cv'].max():.2f}",
        "roundest_layer": int(ours["eccentricity"].idxmin()),
        "roundest": f"{ours['eccentricity'].min():.2f}",
        "newton_error": f"{methods.loc['newton', 'area_error']:.3f}",
        "newton_area_cv": f"{methods.loc['newton', 'area_cv']:.3f}",
        "newton_seconds": f"{methods.loc['newton', 'seconds']:.2f}",
        "advection_seconds": f"{methods.loc['advection', 'seconds']:.1f}",
        "advection_invalid": share_of(methods, "advection"),
        "newton_invalid": share_of(methods, "newton"),
        "published_flipped": published[published["flips"] > 0]["mask"].nunique(),
        "published_masks": published["mask"].nunique(),
        "published_seconds": f"{published['seconds'].min()} to {published['seconds'].max()}",
        "published_closer": published_closer(found["maps"], published),
        "steadier": steadier(found["movies"]),
        "ours_peaks": peaks(found["movies"]),
    }


def ours_by_layer(comparison: Any) -> pd.DataFrame:
    """Measures of the windows on our map, by layer."""
    return comparison.by_layer[comparison.by_layer["method"] == "newton"].set_index("layer")


def edge_by_layer(comparison: Any) -> pd.DataFrame:
    """Measures of edge-based windows, by layer."""
    return comparison.by_layer[comparison.by_layer["method"] == "edge"].set_index("layer")


def layers_not_below(ours: pd.DataFrame, edge: pd.DataFrame, name: str) -> list[int]:
    """Layers in which a measure of our windows is not smaller than that of edge-based ones, or not known."""
    return [int(layer) for layer in ours.index[~(ours[name] < edge[name])]]


def published_closer(maps: pd.DataFrame, published: pd.DataFrame) -> int:
    """Masks on which the published program's "area" variant ends with less area error than our advection."""
    ours = maps[maps["method"] == "advection"].set_index("mask")["error"]
    theirs = published[published["flow"].str.startswith("area")].set_index("mask")["final"]
    return int((theirs < ours[theirs.index].round(2)).sum())


def steadier(movies: dict[str, Any]) -> str:
    """In how many movies windows on our map move less, and consecutive frames are more alike."""
    table = summaries(movies).set_index(["method", "movie"])
    ours, edge = table.loc["newton"], table.loc["edge"]
    both = (ours["displacement"] < edge["displacement"]) & (ours["correlation"] > edge["correlation"])
    return f"{int(both.sum())} of {len(both)}"


def peaks(movies: dict[str, Any]) -> str:
    """How many steps of our windows are peaks, by movie."""
    table = summaries(movies)
    ours = table[table["method"] == "newton"]
    return ", ".join(f"{row.peaks} of {row.steps} ({row.movie})" for row in ours.itertuples())


def span(values: "pd.Series[float]") -> str:
    """Smallest and largest value in words."""
    return f"{values.min():.3f} to {values.max():.3f}"


def correlations(row: Any) -> str:
    """Mean and range over layers in words."""
    return f"{row.correlation:.3f} ({row.correlation_least:.3f} to {row.correlation_most:.3f})"


def spread(row: Any) -> float:
    """How far apart the layers are in their correlation."""
    return float(row.correlation_most - row.correlation_least)


def share_of(methods: pd.DataFrame, method: str) -> str:
    """How many maps of a method are not one to one."""
    row = methods.loc[method]
    return f"{row['invalid_maps']:.0f} of {row['mapped']:.0f}"


def yes(holds: bool) -> str:
    """A verdict in words."""
    return "yes" if holds else "no"


def over(holds: list[bool]) -> str:
    """A verdict over the movies."""
    return "yes" if all(holds) else f"in {sum(holds)} of {len(holds)} movies" if any(holds) else "no"


def listed(layers: list[int]) -> str:
    """Layers in words."""
    return f"layer{'s' if len(layers) > 1 else ''} {', '.join(map(str, layers))}" if layers else "no layer"
