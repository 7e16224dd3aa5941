"""Parameters of runs with nuclei, and what is said of nuclei that are not there."""

from typing import TypeVar

from cytodisk.errors import ParameterError
from cytodisk.images.nuclei.nuclei_parameters import NucleiFileParameters
from cytodisk.parameters import Parameters

ONLY_WITH_NUCLEI = (
    *(name for name in NucleiFileParameters.model_fields if name.startswith("nuclei_")),
    "nucleus_radius",
    "nucleus_layers",
    "several",
    "missing",
)
"""Parameters that mean nothing without nuclei."""

NUCLEUS_LAYERS = 3
"""Layers of the nucleus in a run with nuclei that says no number."""

Given = TypeVar("Given", bound=Parameters)


def with_nucleus_layers(nuclei: object, parameters: Given) -> Given:
    """Parameters of a run with or without nuclei: with them, grids have layers of the nucleus.

    Parameters
    ----------
    nuclei : path-like or None
    parameters : Parameters

    Returns
    -------
    Parameters

    Raises
    ------
    ParameterError
        Something is said of nuclei that are not there.
    """
    known = dict(parameters)
    if nuclei is not None:
        if known.get("method", "newton") != "newton":
            raise ParameterError(f'nuclei need method "newton", got {known["method"]!r}: take --method out')
        if known.get("align") == "nucleus" and known.get("missing") == "plain":
            raise ParameterError(
                'missing "plain" maps cells without a nucleus, which have no direction for align "nucleus": '
                "take --missing plain out, or choose another --align"
            )
        without = "nucleus_layers" in known and known["nucleus_layers"] is None
        return parameters.changed(nucleus_layers=NUCLEUS_LAYERS) if without else parameters
    for name in ONLY_WITH_NUCLEI:
        if name in known and known[name] != type(parameters).model_fields[name].default:
            flag = "--" + name.replace("_", "-")
            raise ParameterError(
                f"{name} is given, but there are no nuclei: pass them as --nuclei, or take {flag} out"
            )
    if known.get("align") == "nucleus":
        raise ParameterError('align "nucleus" needs nuclei: pass them as --nuclei')
    return parameters
