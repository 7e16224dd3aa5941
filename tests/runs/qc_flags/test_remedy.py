from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pandas as pd
import pytest

from cytodisk.runs.qc_flags.qc_flag import Place
from cytodisk.runs.qc_flags.remedy import without_frames
from cytodisk.store.study import Study

PLACES = [Place(0, 5, "")]


def study_with(**there: list[tuple[str, ...]]) -> Study:
    """A study of 40 frames from which some results were computed, without frame 2."""
    opened = SimpleNamespace(settings={"without_frames": [2], "given": {}, "asked": {}, "cells": None})
    parts: dict[str, Any] = {"correlations": [], "predictions": [], "wave_signals": [], **there}
    parts |= dict.fromkeys(("correlation", "prediction", "waves"), lambda *_: opened)
    return cast(Study, SimpleNamespace(path=Path("out"), cells=pd.DataFrame({"frame": range(40)}), **parts))


@pytest.mark.parametrize(
    ("there", "command"),
    [
        ({"correlations": [("Rac1", "velocity")]}, "correlate out --signal Rac1 --with velocity"),
        ({"predictions": [("Rac1", "velocity")]}, "predict out --source Rac1 --target velocity"),
        ({"predictions": [()]}, "predict out"),
        ({"wave_signals": [("velocity",)]}, "waves out --signal velocity"),
    ],
)
def test_frames_are_left_out_with_the_command_that_was_run(
    there: dict[str, list[tuple[str, ...]]], command: str
) -> None:
    words = without_frames(study_with(**there), PLACES)
    assert (
        words == f" Or leave these frames out: cytodisk {command} --without-frames 2,5 --name without_jumps"
    )


def test_each_kind_of_result_has_its_command_and_many_frames_have_none() -> None:
    study = study_with(predictions=[("Rac1", "velocity")], wave_signals=[("Rac1", "late")])
    words = without_frames(study, PLACES, after=1)
    assert words.count("cytodisk ") == 2
    assert words.endswith(
        "; cytodisk waves out --signal Rac1 --without-frames 2,5,6 --name late_without_jumps"
    )
    assert without_frames(study, [Place(0, k, "") for k in range(11)]) == ""
