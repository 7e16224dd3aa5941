"""Parameters of simulated populations."""

from typing import Literal, Self, TypeAlias

from pydantic import field_validator, model_validator

from cytodisk.parameters import Parameters, parameter
from cytodisk.simulate.series_parameters import NeighbourParameters

Turned: TypeAlias = Literal["none", "nucleus", "front"]
Days: TypeAlias = Literal["none", "by experiment", "by condition"]

_MOST = 1_000_000  # cells, windows: beyond any study
_LARGEST = 100.0  # effects, in standard deviations of a cell


class DesignParameters(Parameters):
    """Which conditions, experiments and cells there are."""

    conditions: tuple[str, ...] = parameter(
        ("control", "drug"), "Names of the conditions.", words="one or more different names"
    )
    experiments: int | tuple[int, ...] = parameter(
        6,
        "Experiments of each condition, one number for all or one for each; for `paired` in all.",
        words="a whole number of at least 1, or one for each condition",
    )
    cells: int = parameter(12, "Cells of each condition in each experiment, on average.", least=1, most=_MOST)
    cells_spread: float = parameter(
        0.0,
        "How unequal numbers of cells are: each is drawn, evenly, from (1 - this) to (1 + this) times "
        "`cells`; 0: all equal.",
        least=0,
        most=1,
    )
    paired: bool = parameter(
        False, "Whether each experiment holds all conditions, under one name; otherwise it holds one."
    )
    days: Days = parameter(
        "none",
        'Column `day`: "by experiment", a day for each one of a condition, so that conditions share days; '
        '"by condition": all of a condition on a day of its own, which confounds both; "none": no column.',
    )

    @field_validator("conditions")
    @classmethod
    def _different(cls, conditions: tuple[str, ...]) -> tuple[str, ...]:
        if not conditions or len(set(conditions)) < len(conditions) or not all(conditions):
            raise ValueError("must be one or more different names")
        return conditions

    @field_validator("experiments")
    @classmethod
    def _at_least_one(cls, experiments: int | tuple[int, ...]) -> int | tuple[int, ...]:
        several = (experiments,) if isinstance(experiments, int) else experiments
        if not several or min(several) < 1 or max(several) > _MOST:
            raise ValueError("must be whole numbers of at least 1")
        return experiments

    @model_validator(mode="after")
    def _fit(self) -> Self:
        if not isinstance(self.experiments, int):
            if self.paired:
                raise ValueError("experiments must be one number for paired=True, the same for all")
            if len(self.experiments) != len(self.conditions):
                raise ValueError(
                    f"experiments must be one number or one for each of the {len(self.conditions)} "
                    f"conditions, got {len(self.experiments)}"
                )
        return self

    @property
    def experiments_of(self) -> tuple[int, ...]:
        """Number of experiments of each condition."""
        if isinstance(self.experiments, int):
            return (self.experiments,) * len(self.conditions)
        return self.experiments


class WindowValueParameters(NeighbourParameters):
    """What the values of windows are, and how they vary."""

    layers: int = parameter(4, "Number of layers.", least=1, most=1000)
    sectors: int = parameter(12, "Number of sectors.", least=1, most=10_000)
    nucleus_layers: int = parameter(
        0, "How many of the layers, the last ones, lie in the nucleus; coordinate `compartment`.", least=0
    )
    mean: float = parameter(10.0, "Mean of all values of a control, but for `peripheral` and `polarity`.")
    deviation: float = parameter(
        1.0,
        "Standard deviation of a window's value between cells of one condition, over all its experiments: "
        "the unit of effects.",
        above=0,
    )
    between_experiments: float = parameter(
        0.1,
        "Share of the variance that the cells of one experiment share, whatever their condition.",
        least=0,
        most=1,
    )
    between_dishes: float = parameter(
        0.0,
        "Share of the variance that the cells of one experiment and condition share; for `paired` it makes "
        "the effect differ between experiments.",
        least=0,
        most=1,
    )
    common: float = parameter(
        0.0,
        "Share of each of these variances that all windows have in common, as a dish or a cell that is "
        "brighter as a whole.",
        least=0,
        most=1,
    )
    peripheral: float = parameter(
        0.0,
        "By how much layer 0 is above the deepest layers, in all conditions; falls to 1/e over a third of "
        "the layers.",
        least=-_LARGEST,
        most=_LARGEST,
        unit="deviations",
    )
    polarity: float = parameter(
        0.0,
        "First harmonic around the cell, highest at sector 0, in all conditions.",
        least=-_LARGEST,
        most=_LARGEST,
        unit="deviations",
    )
    missing: float = parameter(0.0, "Share of the windows without a value: NaN.", least=0, most=1)
    precision: Literal["float64", "float32"] = parameter("float64", "Type of the values.")

    @model_validator(mode="after")
    def _shares(self) -> Self:
        if self.between_experiments + self.between_dishes > 1.0:
            both = f"{self.between_experiments:g} + {self.between_dishes:g}"
            raise ValueError(f"between_experiments + between_dishes must be at most 1, got {both}")
        if self.nucleus_layers >= self.layers:
            raise ValueError(f"nucleus_layers must be less than layers, got {self.nucleus_layers}")
        return self


class SimulatedPopulationParameters(WindowValueParameters, DesignParameters):
    """How a population of cells is made."""

    channels: tuple[str, ...] = parameter(
        (),
        "Names of the channels, which vary independently: the region is raised in the first one. Without "
        "names, values have no dimension `channel`.",
        words="different names",
    )
    effect: float | tuple[float, ...] = parameter(
        2.0,
        "By how much the region is raised: one number for all conditions but the first, or one for each.",
        unit="deviations",
        words="a number, or one for each condition",
    )
    doses: tuple[float, ...] = parameter(
        (), "Dose of each condition: column `dose`.", words="a number for each condition"
    )
    turned: Turned = parameter(
        "none",
        "Whether each cell lies turned at random, by whole sectors, with its direction to the nucleus, or to "
        'the front, known: aligned by that direction all cells lie as for "none".',
    )
    direction_error_deg: float = parameter(
        0.0,
        "Standard deviation of the known direction about the true one.",
        least=0,
        most=180,
        unit="degrees",
    )
    without_direction: float = parameter(
        0.0, "Share of the cells without a direction, of each kind.", least=0, most=1
    )

    @field_validator("channels")
    @classmethod
    def _names(cls, channels: tuple[str, ...]) -> tuple[str, ...]:
        if len(set(channels)) < len(channels) or not all(channels):
            raise ValueError("must be different names")
        return channels

    @model_validator(mode="after")
    def _one_for_each(self) -> Self:
        if not isinstance(self.effect, float) and len(self.effect) != len(self.conditions):
            raise ValueError(
                f"effect must be one number or one for each of the {len(self.conditions)} conditions, got "
                f"{len(self.effect)}"
            )
        if self.doses and len(self.doses) != len(self.conditions):
            raise ValueError(
                f"doses must be one number for each of the {len(self.conditions)} conditions, got "
                f"{len(self.doses)}"
            )
        return self

    @property
    def effect_of(self) -> tuple[float, ...]:
        """Effect on each condition, in deviations."""
        if isinstance(self.effect, float):
            return (0.0, *(self.effect,) * (len(self.conditions) - 1))
        return self.effect
