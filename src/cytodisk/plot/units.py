"""Units of what is drawn: read from the arrays, or from a scale that the caller passes."""

from __future__ import annotations

from typing import Any

import xarray as xr

from cytodisk.scale import Scale, ShownUnit, suited_velocity


def scale_for(carrier: Any, scale: Scale | None = None) -> Scale:
    """The scale of a picture.

    Parameters
    ----------
    carrier : DataArray, map, movie or windows
        What is drawn; see `Scale.of`.
    scale : Scale, optional
        What it holds goes before what the carrier holds.

    Returns
    -------
    Scale
    """
    carried = Scale.of(carrier)
    return carried if scale is None else carried.given(scale.pixel_size_um, scale.frame_interval_s)


def unit_of(values: Any, otherwise: str = "") -> str:
    """Unit of values: their attribute `units`, or `otherwise` where they have none."""
    return str(getattr(values, "attrs", {}).get("units", otherwise))


def with_unit(label: str, unit: str) -> str:
    """A label with its unit in brackets; the label alone where there is none, or it is a ratio's "1"."""
    return label if unit in ("", "1") else f"{label} ({unit})"


def velocity_unit(velocity: Any, scale: Scale | None, time: ShownUnit, fastest: float) -> ShownUnit:
    """The unit that edge velocity is shown in.

    Parameters
    ----------
    velocity : array_like or DataArray
    scale : Scale, optional
        Of values that do not say their unit.
    time : ShownUnit
        That of the times.
    fastest : float
        The largest size that is shown.

    Returns
    -------
    ShownUnit
        Of plain numbers without a scale "px/frame". A DataArray that has lost its unit in a computation, and
        comes without a scale, has none.
    """
    known = scale_for(velocity, scale)
    lost = isinstance(velocity, xr.DataArray) and known == Scale()
    unit = unit_of(velocity, "unit unknown" if lost else known.velocity_unit)
    return suited_velocity(fastest, unit, time)
