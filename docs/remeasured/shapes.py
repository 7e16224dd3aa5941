"""Complexity of the osteosarcoma cells: landscape, extremes, and five cells along the score."""

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import spearmanr

import cytodisk as cd
from cytodisk.pages.shape_pages import cells_to_draw, write_shape_figures
from cytodisk.runs.shapes.shape_parameters import ShapeParameters
from cytodisk.runs.shapes.shape_study import cleaned_masks, open_shape_inputs, shape_study

QUANTILES = (0.01, 0.3, 0.6, 0.85, 0.99)
SEEDS = (1, 2, 3, 4, 5)


def measure(masks: Path, work: Path, workers: int) -> dict[str, Any]:
    """The table of shapes, its folder, and the scores by other seeds."""
    out = work / "shapes"
    parameters = ShapeParameters(fragments="largest")  # as in the published figures
    inputs = open_shape_inputs(masks, parameters)
    table = shape_study(inputs, out, parameters, workers=workers, **again(out))
    (out / "figures").mkdir(exist_ok=True)
    write_shape_figures(out / "figures", table, cleaned_masks(inputs, cells_to_draw(table)))
    scores = [cd.complexity_score(table, seed=seed) for seed in SEEDS]
    return {"table": table, "path": out, "scores": scores}


def again(out: Path) -> dict[str, bool]:
    """Go on with a study that is there."""
    return {"resume": (out / "provenance.json").exists()}


def representatives(table: pd.DataFrame) -> list[int]:
    """Five cells along the score, of those whose mask is surely that of one cell."""
    sure = table[(table["status"] == "ok") & (table["qc_flags"] == "")]
    score = sure["complexity"].to_numpy()
    places = [np.abs(score - np.quantile(score, share)).argmin() for share in QUANTILES]
    return [int(sure["cell"].iloc[place]) for place in places]


def write(found: dict[str, Any], files: Path) -> dict[str, Any]:
    """Pictures of the landscape and of the extremes; how stable the score is."""
    shapes = found["shapes"]
    for name in ("complexity", "extremes"):
        shutil.copy(shapes["path"] / "figures" / f"{name}.png", files / f"{name}.png")
    scores = np.array([score["complexity"].dropna() for score in shapes["scores"]])
    ranks = [spearmanr(one, other).statistic for n, one in enumerate(scores) for other in scores[n + 1 :]]
    return {
        "n_cells": int((shapes["table"]["status"] == "ok").sum()),
        "seeds": len(SEEDS),
        "seed_rank_least": f"{min(ranks):.2f}",
        "seed_rank_median": f"{np.median(ranks):.2f}",
        "first_component": f"{np.median([score.attrs['first_component'] for score in shapes['scores']]):.2f}",
    }
