"""Which condition is the control, and what is said of it."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import cytodisk as cd
from cytodisk.runs.population.conditions_compared import compared_conditions
from cytodisk.runs.population.population_at_hand import prepared


def _population(*conditions: str | None) -> cd.Population:
    values = xr.DataArray(np.ones((len(conditions), 1, 2)), dims=("cell", "layer", "sector"))
    return cd.Population(values, pd.DataFrame({"condition": list(conditions)}))


@pytest.mark.parametrize("name", ["control", "Ctrl", "UNTREATED", "WT", "dmso"])
def test_a_control_is_known_by_its_name(name: str) -> None:
    found = compared_conditions(_population("a", name, "b"), ())
    assert found.names == (name, "a", "b")
    assert found.treated == ("a", "b")
    assert f"--compare {name},a,b" in found.sentence


def test_conditions_stand_in_the_order_of_their_dose() -> None:
    there = _population("high", "none", "control", "low", "high", "low")
    dosed = there.with_cells(there.cells.assign(dose=["10", "", "0", 2, 30.0, 1]))
    assert compared_conditions(dosed, (), "dose").names == ("control", "low", "high", "none")
    assert compared_conditions(dosed, ()).names == ("control", "high", "none", "low")
    asked = ("control", "high", "low")
    assert compared_conditions(dosed, asked, "dose").names == asked


def test_a_command_that_is_told_can_be_typed() -> None:
    found = compared_conditions(_population("row B", "row D"), ())
    assert "pass --compare 'row B,row D' to name it" in found.sentence


def test_names_with_commas_are_put_together_again() -> None:
    there = _population("10 nM, fresh", "DMSO", "10 nM, old, washed")
    given = cd.PopulationParameters(compare="DMSO,10 nM, old, washed").compare
    assert compared_conditions(there, given).names == ("DMSO", "10 nM, old, washed")
    with pytest.raises(cd.errors.PopulationError, match="no cell has the condition '10 nM'"):
        compared_conditions(there, given[:-1])


@pytest.mark.parametrize(("name", "value"), [("normalise", "z-score"), ("align", "axis")])
def test_cells_without_windows_are_neither_normalised_nor_aligned(name: str, value: str) -> None:
    shapes = cd.Population(None, pd.DataFrame({"area": [1.0, 2.0]}), scalars=["area"])
    with pytest.raises(cd.errors.PopulationError, match=f"no windows: leave --{name} out"):
        prepared(shapes, cd.PopulationParameters(**{name: value}))


def test_names_can_be_given_as_one_text() -> None:
    found = cd.PopulationParameters(compare="control, drug", channel="Rac1", scalars="area,polarity")
    assert found.compare == ("control", "drug")
    assert (found.channel, found.scalars) == (("Rac1",), ("area", "polarity"))


def test_the_first_of_two_is_the_control() -> None:
    found = compared_conditions(_population("siRNA", "rescue"), ())
    assert found.control == "siRNA"
    assert "as the first of two in the table" in found.sentence


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (("a", "b", "c"), "none is called control: name the control first, such as --compare a,b,c"),
        (("wt", "dmso", "c"), r"several are names of a control \(wt, dmso\)"),
        (("x 1", "b", "c"), "--compare 'x 1,b,c'"),
    ],
)
def test_several_conditions_need_a_control(names: tuple[str, ...], words: str) -> None:
    with pytest.raises(cd.errors.PopulationError, match=words):
        compared_conditions(_population(*names), ())


def test_one_condition_is_shown_alone() -> None:
    found = compared_conditions(_population("drug", None), ())
    assert (found.names, found.control, found.treated) == (("drug",), "", ())
    assert "nothing is compared" in found.sentence


def test_what_the_user_names_needs_no_words() -> None:
    assert compared_conditions(_population("control", "a"), ("a", "control")).control == "a"
    assert not compared_conditions(_population("control", "a"), ("a", "control")).sentence


def test_a_missing_condition_is_named_with_those_there() -> None:
    with pytest.raises(cd.errors.PopulationError, match=r"no cell has the condition 'b'; there is 'a'$"):
        compared_conditions(_population("a"), ("a", "b"))
    with pytest.raises(cd.errors.PopulationError, match="none: pass --groups"):
        compared_conditions(_population(None), ("a", "b"))


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"compare": ("a",)}, "two conditions or more"),
        ({"compare": ("a", "a")}, "must be different names"),
        ({"align": "north"}, "must be none, nucleus, front, motion, axis or signal:CHANNEL"),
        ({"align": "signal:"}, "signal:CHANNEL"),
        ({"channel": ("",)}, "must be different names"),
    ],
)
def test_parameters_are_refused_with_what_they_may_be(settings: dict[str, object], words: str) -> None:
    with pytest.raises(cd.errors.ParameterError, match=words):
        cd.PopulationParameters(**settings)
