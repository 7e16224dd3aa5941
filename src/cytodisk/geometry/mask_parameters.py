"""Parameters of `clean_mask`."""

from typing import Literal, TypeAlias

from cytodisk.parameters import Parameters, parameter

Holes: TypeAlias = Literal["fill", "exclude", "error"]


class HoleParameters(Parameters):
    """What becomes of holes in a mask."""

    holes: Holes = parameter(
        "fill",
        'Background that the cell encloses (4-connected). "fill": it counts as cell. "exclude": the cell is '
        'mapped as if it were filled, but the holes\' pixels belong to no window. "error": such a mask is '
        "refused.",
    )


class CleaningParameters(HoleParameters):
    """What becomes of a mask that is not one piece, or not all of the cell."""

    fragments: Literal["largest", "error"] = parameter(
        "largest",
        'Several pieces (8-connected): keep the "largest" (the first of equals), or raise an "error".',
    )
    border: Literal["flag", "error"] = parameter(
        "flag",
        'A cell at the image border: "flag" it in the report, or raise an "error".',
    )
