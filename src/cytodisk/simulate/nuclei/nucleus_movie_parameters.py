"""Parameters of simulated movies with a nucleus."""

from typing import Annotated

from pydantic import Field

from cytodisk.parameters import parameter
from cytodisk.simulate.moving_cell_parameters import MovingCellParameters


class NucleusMovieParameters(MovingCellParameters):
    """How a movie of one cell with its nucleus is made."""

    nucleus_share: float = parameter(
        0.15,
        "Share of the cell's area that the nucleus has in frame 0; less where the cell is not deep enough.",
        least=0.01,
        most=0.5,
    )
    nucleus_elongation: float = parameter(
        1.3, "Longer over shorter axis of the nucleus in frame 0.", least=1, most=3
    )
    nucleus_turn_deg: float = parameter(
        0.0,
        "Turn of the nucleus within the cell and its direction, positive from +x towards +y.",
        least=-45,
        most=45,
        unit="degrees/frame",
    )
    nucleus_missing: Annotated[float, Field(lt=1)] = parameter(
        0.0, "Share of frames whose nucleus is missing, never the first or last.", least=0
    )
