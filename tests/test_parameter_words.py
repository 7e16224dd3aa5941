"""What is typed for a parameter becomes the value that is meant, or stays a text that the model refuses."""

import pytest

from cytodisk import CorrelateParameters, MapParameters
from cytodisk.errors import ParameterError
from cytodisk.parameter_words import value_of_text
from cytodisk.parameters import Parameters


@pytest.mark.parametrize(
    ("model", "name", "text", "value"),
    [
        (MapParameters, "align", "upright", "upright"),
        (MapParameters, "align", "45", 45.0),
        (MapParameters, "align", "-.5, 4e1", (-0.5, 40.0)),
        (MapParameters, "channels", "Rac1, RhoA", ("Rac1", "RhoA")),
        (CorrelateParameters, "frames", "10:80", (10, 80)),
        (CorrelateParameters, "skip_lags", "-1,0", (-1, 0)),
        (CorrelateParameters, "null", "shift", "shift"),
    ],
)
def test_a_text_becomes_the_value(model: type[Parameters], name: str, text: str, value: object) -> None:
    found = value_of_text(model.model_fields[name], text)
    assert found == value
    assert dict(model.of(**{name: found}))[name] == value


@pytest.mark.parametrize(
    ("model", "name", "text"),
    [
        (MapParameters, "align", "1.2.3"),
        (MapParameters, "align", "30,"),
        (MapParameters, "align", "1,2,3"),
        (CorrelateParameters, "frames", "10"),
        (CorrelateParameters, "frames", "10.7:80"),
        (CorrelateParameters, "without_frames", "17.5"),
        (CorrelateParameters, "skip_lags", "-1.9,0"),
    ],
)
def test_what_is_no_such_value_is_refused(model: type[Parameters], name: str, text: str) -> None:
    with pytest.raises(ParameterError, match=f"{name} must be"):
        model.of(**{name: value_of_text(model.model_fields[name], text)})
