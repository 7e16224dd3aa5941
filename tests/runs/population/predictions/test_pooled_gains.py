import numpy as np
import pandas as pd
import pytest

from cytodisk.errors import PopulationError
from cytodisk.runs.population.pooling.pool_parameters import PoolParameters
from cytodisk.runs.population.pooling.pooled_population import Pooled
from cytodisk.runs.population.predictions.gain_words import predicts
from cytodisk.runs.population.predictions.pooled_gains import pool_gains

LINKS = (("Rac1", "velocity"), ("velocity", "Rac1"))


def pooled(
    strength: dict[str, float], experiments: int = 6, compare: tuple[str, ...] = (), noise: float = 0.0
) -> Pooled:
    """Cells in which the past of Rac1 predicts velocity in layer 0, half of which geometry takes away.

    Backwards it gains as much on reversed time as `noise`.
    """
    rng = np.random.default_rng(3)
    rows, cells = [], []
    for condition, size in strength.items():
        for experiment in range(experiments):
            for cell in range(1 + experiment % 3):
                place = {"input": f"{condition}{experiment}", "cell": cell}
                cells.append(place | {"condition": condition, "experiment": f"{condition} {experiment}"})
                for source, target in LINKS:
                    for layer in range(2):
                        mean = size * (layer == 0) * (source == "Rac1" or noise > 0)
                        score = mean + rng.normal()
                        row = place | {"source": source, "target": target, "layer": layer, "score": score}
                        reversed_ = 0.0 if source == "Rac1" else noise
                        row |= {"gain": 0.01 * score + 0.02, "gain_reversed": reversed_}
                        row |= {"gain_excess": 0.01 * score, "gain_excess_partial": 0.005 * score}
                        rows.append(row | {"score_partial": 0.1 * score + 0.5 * rng.normal()})
    return pool_gains(pd.DataFrame(rows), pd.DataFrame(cells), PoolParameters(compare=compare))


def test_a_link_is_found_in_its_direction_and_layer_and_the_sentence_has_its_numbers() -> None:
    found = pooled({"cells": 4.0})
    raw = found.tables["pooled"].query("kind == 'raw'")
    (row,) = raw[predicts(raw)].to_dict("records")
    assert (row["source"], row["target"], row["layer"]) == ("Rac1", "velocity", 0)
    assert row["low"] < 0.04 < row["high"]
    assert row["p_fwer"] == row["smallest_p"] == 2 / 2**6
    assert (row["n_cells"], row["n_experiments"]) == (12, 6)
    first = found.sentences[0]
    assert first.startswith("cells: The past of Rac1 predicts the edge's velocity, most in layer 0: ")
    assert "p = 0.031 over all links and layers" in first
    assert "geometry alone would give regressed out" in first
    assert "it does not survive" in first
    assert "The past of the edge's velocity does not predict Rac1 beyond chance" in first
    assert found.sentences[-1] == "cells against 0: 6 experiments can give p = 0.031 at best."


def test_a_direction_that_noise_alone_may_make_is_said_and_is_no_finding() -> None:
    found = pooled({"cells": 4.0}, noise=0.2)
    raw = found.tables["pooled"].query("kind == 'raw' and layer == 0").set_index("source")
    assert predicts(raw).all()
    assert raw["weaker"].to_dict() == {"Rac1": False, "velocity": True}
    assert not found.tables["pooled"].query("kind == 'partial'")["weaker"].any()
    there, back = found.sentences[0].split("The past of the edge's velocity predicts Rac1")
    assert "noise of measurement" not in there
    assert "but it is the weaker of both directions, and noise of measurement alone may make it" in back


def test_scores_below_0_predict_nothing() -> None:
    found = pooled({"cells": -4.0})
    raw = found.tables["pooled"].query("kind == 'raw'")
    assert raw["p_fwer"].min() <= 0.05
    assert not predicts(raw).any()
    assert "predicts" not in found.sentences[0]


def test_few_experiments_cannot_tell_and_say_what_p_they_can_reach() -> None:
    found = pooled({"cells": 9.0}, experiments=3)
    assert found.tables["pooled"]["p_fwer"].min() == 0.25
    assert "cannot be told, as p is 0.25 at best" in found.sentences[0]


def test_conditions_are_compared_by_their_gains() -> None:
    found = pooled({"drug": 0.0, "control": 5.0}, experiments=5)
    compared = found.tables["comparisons"].query("kind == 'raw'")
    most = compared.loc[compared["p_holm"].idxmin()]
    assert (most["condition"], most["control"]) == ("drug", "control")
    assert (most["source"], most["layer"]) == ("Rac1", 0)
    assert most["p_holm"] <= 0.05
    assert any(words.startswith("drug differs from control in 1 of 4 links") for words in found.sentences)
    with pytest.raises(PopulationError, match="condition 'toxin' is not in the batch"):
        pooled({"control": 1.0}, compare=("control", "toxin"))
