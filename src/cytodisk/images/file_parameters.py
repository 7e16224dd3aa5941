"""Parameters that say how mask files are read."""

from typing import Literal, TypeAlias

from cytodisk.parameters import Parameters, parameter

Kind: TypeAlias = Literal["auto", "mask", "stack", "labels"]


class KindParameters(Parameters):
    """What a mask file holds."""

    kind: Kind = parameter(
        "auto",
        'What the mask file holds: "mask" is one cell, "stack" one cell a frame, "labels" one cell a label; '
        '"auto" looks at the values.',
    )


class MovieKindParameters(KindParameters):
    """What the mask file of a movie holds."""

    kind: Literal["auto", "stack", "labels"] = parameter(
        "auto",
        'What the mask file holds: "stack" is one cell through time, "labels" one cell a label; "auto" looks '
        "at the values.",
    )
    link: bool = parameter(
        False, "Labels differ from frame to frame: give overlapping cells one label through time."
    )
