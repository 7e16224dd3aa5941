"""The paper's claims beside what was measured here, each with a verdict that the numbers give."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from remeasured.cells import MAPS, percent
from remeasured.maps import PUBLISHED
from remeasured.movies import BESIDE, PEAK, summaries

UNIFORM = 0.1  # largest coefficient of variation of areas that are called alike
HIGH = 0.7  # least correlation that is called high
FOLDED = 0.01  # share of the cell above which a field is said to fold
BASED_ON_EDGE = {method: BESIDE[method] for method in ("edge", "springs")}


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
    windows = {name: one for name, one in found["cells"].items() if name != MAPS}
    emptiest = {name: float(of_layers(one, "newton")["completeness"].min()) for name, one in windows.items()}
    published = pd.read_csv(PUBLISHED)["windows_percent"]
    yield Claim(
        "u-Unwrap windows sample signal in every window (4.1)",
        "emptiest layer of our windows: "
        + ", ".join(f"{percent(share)} at {name.replace('x', ' × ')}" for name, share in emptiest.items())
        + f"; 10 × 60 windows of the published program: {published.min():g} to {published.max():g} %",
        "yes, with our windows" if min(emptiest.values()) == 1.0 else "no",
    )
    ours = of_layers(windows["12x60"], "newton")
    others = {name: of_layers(windows["12x60"], method) for method, name in BASED_ON_EDGE.items()}
    falls = {name: table["completeness"].to_numpy() for name, table in others.items()}
    yield Claim(
        "completeness of edge-based windows decreases rapidly with depth (4.1, Fig. 3B)",
        "; ".join(
            f"{name}: {percent(fall[0])} in layer 0, {percent(fall[len(fall) // 2])} in layer "
            f"{len(fall) // 2}, {percent(fall[-1])} in the last"
            for name, fall in falls.items()
        ),
        each(
            {
                name: bool((np.diff(fall) <= 0).all()) and fall[-1] < 0.5 * fall[0]
                for name, fall in falls.items()
            }
        ),
    )
    higher = {name: higher_inside(ours, table) for name, table in others.items()}
    yield Claim(
        "eccentricity varies less than that of edge-based windows after the first layer (4.1, Fig. 3B)",
        f"coefficient of variation by layer: ours {span(ours['eccentricity_cv'])}, "
        + ", ".join(f"{name} {span(table['eccentricity_cv'])}" for name, table in others.items())
        + "".join(
            f"; after the first layer ours is not lower than {name} in {listed(layers)}"
            for name, layers in higher.items()
            if layers
        ),
        each({name: not layers for name, layers in higher.items()}),
    )
    yield Claim(
        "windows are relatively uniform within each layer (4.1)",
        f"coefficient of variation of area by layer: ours {span(ours['area_cv'])}, "
        + ", ".join(f"{name} {span(table['area_cv'])}" for name, table in others.items()),
        yes(bool((ours["area_cv"] < UNIFORM).all())),
    )


def movie_claims(found: dict[str, Any]) -> Iterator[Claim]:
    """Section 4.2 and Fig. 4."""
    table = summaries(found["movies"])
    by_method = {one: table[table["method"] == one].set_index("movie") for one in ("newton", *BESIDE)}
    ours = by_method["newton"]
    names = list(ours.index)
    others = {name: by_method[method] for method, name in BESIDE.items()}
    on_edge = {name: others[name] for name in BASED_ON_EDGE.values()}

    def told(words: Callable[[Any], str]) -> str:
        """Words for each movie and kind of windows."""
        return "; ".join(
            f"{movie}: ours {words(ours.loc[movie])}, "
            + ", ".join(f"{name} {words(rows.loc[movie])}" for name, rows in others.items())
            for movie in names
        )

    def held(holds: Callable[[Any, Any], bool], against: dict[str, Any]) -> str:
        """A verdict for each kind of windows, over the movies."""
        return each_over(
            {
                name: [bool(holds(ours.loc[movie], rows.loc[movie])) for movie in names]
                for name, rows in against.items()
            }
        )

    yield Claim(
        "edge-based windows severely undersample inner layers (4.2, Fig. 4B)",
        "emptiest layer: " + told(lambda row: percent(row.emptiest)),
        held(lambda a, b: b.emptiest < 0.5 and a.emptiest == 1.0, on_edge),
    )
    yield Claim(
        "correlations of consecutive frames are consistently high, and more alike over layers than with "
        "edge-based windows (4.2, Fig. 4C)",
        "mean (lowest to highest layer): " + told(correlations),
        f"above {HIGH:g} in every layer: {over([ours.loc[n].correlation_least > HIGH for n in names])}; "
        f"more alike: {held(lambda a, b: spread(a) < spread(b), others)}; "
        f"higher: {held(lambda a, b: a.correlation > b.correlation, others)}",
    )
    yield Claim(
        "displacements of windows have similar magnitudes with both (4.2, Fig. 4D)",
        told(lambda row: f"{row.displacement:.3g} {row.unit} a frame"),
        held(lambda a, b: 0.5 < a.displacement / b.displacement < 2.0, on_edge),
    )
    yield Claim(
        "edge-based windows have peaks of displacement, which ours have not (4.2, Fig. 4D)",
        f"steps above {PEAK:g} times the median of their own, and the largest: "
        + told(lambda row: f"{row.peaks} of {row.steps} ({row.largest:.3g} {row.unit})"),
        held(lambda a, b: b.peaks > 0 and a.peaks == 0, on_edge),
    )
    registered = others[BESIDE["registered"]]
    yield Claim(
        "thin necks, protrusions and branches make the field of a nonrigid registration ambiguous (2)",
        "; ".join(
            f"{movie}: the field folds in {percent(row.folded)} of the cell, {percent(row.outside)} of its "
            f"windows is carried outside, {percent(1.0 - row.coverage)} of the cell is in none"
            for movie, row in ((movie, registered.loc[movie]) for movie in names)
        ),
        f"folds in more than {percent(FOLDED)}: "
        + over([registered.loc[movie].folded > FOLDED for movie in names]),
    )


def map_claims(found: dict[str, Any]) -> Iterator[Claim]:
    """Appendix A.2: the map."""
    methods = found["cells"][MAPS].by_method.set_index("method")
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
    methods = found["cells"][MAPS].by_method.set_index("method")
    ours, edge = (of_layers(comparison, method) for method in ("newton", "edge"))
    springs = of_layers(comparison, "springs")
    published = pd.read_csv(PUBLISHED)
    return {
        "n_tried": f"{methods.loc['newton', 'tried']:.0f}",
        "n_mapped": f"{methods.loc['newton', 'mapped']:.0f}",
        "higher_eccentricity": listed(layers_not_below(ours, edge, "eccentricity_cv")),
        "higher_area": listed(layers_not_below(ours, edge, "area_cv")),
        "higher_mean": listed(layers_not_below(ours, edge, "eccentricity")),
        "springs_eccentricity": listed(layers_not_below(ours, springs, "eccentricity_cv")),
        "springs_area": listed(layers_not_below(ours, springs, "area_cv")),
        "springs_mean": listed(layers_not_below(ours, springs, "eccentricity")),
        "springs_complete": percent(springs["completeness"].mean()),
        "edge_complete": percent(edge["completeness"].mean()),
        "springs_last": percent(springs["completeness"].iloc[-1]),
        "springs_area_cv": f"{springs['area_cv'].median():.3f}",
        "edge_area_cv": f"{edge['area_cv'].median():.3f}",
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
        **{f"steadier_{method}": steadier(found["movies"], method) for method in BASED_ON_EDGE},
        **registered_words(found["movies"]),
        **{
            f"{method}_peaks": peaks(found["movies"], method)
            for method in ("newton", "springs", "registered")
        },
    }


def of_layers(comparison: Any, method: str) -> pd.DataFrame:
    """Measures of the windows of a method, by layer."""
    return comparison.by_layer[comparison.by_layer["method"] == method].set_index("layer")


def higher_inside(ours: pd.DataFrame, theirs: pd.DataFrame) -> list[int]:
    """Layers after the first in which the eccentricity of our windows does not vary less."""
    return [layer for layer in layers_not_below(ours, theirs, "eccentricity_cv") if layer > 0]


def layers_not_below(ours: pd.DataFrame, edge: pd.DataFrame, name: str) -> list[int]:
    """Layers in which a measure of our windows is not smaller than that of edge-based ones, or not known."""
    return [int(layer) for layer in ours.index[~(ours[name] < edge[name])]]


def published_closer(maps: pd.DataFrame, published: pd.DataFrame) -> int:
    """Masks on which the published program's "area" variant ends with less area error than our advection."""
    ours = maps[maps["method"] == "advection"].set_index("mask")["error"]
    theirs = published[published["flow"].str.startswith("area")].set_index("mask")["final"]
    return int((theirs < ours[theirs.index].round(2)).sum())


def steadier(movies: dict[str, Any], method: str) -> str:
    """In how many movies our windows move less than a method's, and consecutive frames are more alike."""
    table = summaries(movies).set_index(["method", "movie"])
    ours, theirs = table.loc["newton"], table.loc[method]
    both = (ours["displacement"] < theirs["displacement"]) & (ours["correlation"] > theirs["correlation"])
    return f"{int(both.sum())} of {len(both)}"


def registered_words(movies: dict[str, Any]) -> dict[str, str]:
    """How registered windows and ours compare; which share of them is filled, and of the cell is in them."""
    table = summaries(movies).set_index(["method", "movie"])
    ours, theirs = table.loc["newton"], table.loc["registered"]
    calmer = theirs["displacement"] < ours["displacement"]
    alike = theirs["correlation"] > ours["correlation"]
    kept = ", ".join(
        f"{percent(row.complete)} and {percent(row.coverage)} ({movie})" for movie, row in theirs.iterrows()
    )
    return {
        "calmer_registered": f"{int(calmer.sum())} of {len(calmer)}",
        "alike_registered": f"{int(alike.sum())} of {len(alike)}",
        "registered_kept": kept,
    }


def peaks(movies: dict[str, Any], method: str) -> str:
    """How many steps of a method's windows are peaks, by movie."""
    table = summaries(movies)
    rows = table[table["method"] == method]
    return ", ".join(f"{row.peaks} of {row.steps} ({row.movie})" for row in rows.itertuples())


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


def each(holds: dict[str, bool]) -> str:
    """A verdict against each kind of windows, in one word where they agree."""
    return each_over({name: [one] for name, one in holds.items()})


def each_over(holds: dict[str, list[bool]]) -> str:
    """The same over the movies."""
    verdicts = {name: over(found) for name, found in holds.items()}
    alike = set(verdicts.values())
    return (
        alike.pop() if len(alike) == 1 else ", ".join(f"{name} {words}" for name, words in verdicts.items())
    )


def listed(layers: list[int]) -> str:
    """Layers in words."""
    return f"layer{'s' if len(layers) > 1 else ''} {', '.join(map(str, layers))}" if layers else "no layer"
