"""Parameters of `cytodisk population --power`."""

from pydantic import field_validator

from cytodisk.parameters import MOST_SEED, Parameters, parameter

_MOST = 100  # experiments, and effects in standard deviations: beyond any plan


class PowerParameters(Parameters):
    """What experiments are planned, and how cells vary."""

    effects: tuple[float, ...] = parameter(
        (0.5, 1.0, 1.5, 2.0, 3.0),
        "Differences to plan for, in standard deviations of a cell within its condition.",
        words="numbers above 0 with commas between",
    )
    experiments: tuple[int, ...] = parameter(
        (3, 4, 5, 6, 8),
        "Numbers of experiments: of each condition, or of pairs.",
        words="whole numbers from 2 with commas between",
    )
    cells: int | None = parameter(
        None,
        "Cells of each condition in each experiment; without it the median of your cells, or 12.",
        least=1,
        most=1_000_000,
    )
    between_experiments: float | None = parameter(
        None,
        "Share of a cell's variance that is between experiments, and the same in both conditions of one; "
        "without it that of your cells, or 0.1.",
        least=0,
        most=1,
    )
    between_dishes: float | None = parameter(
        None,
        "Share of a cell's variance that is between the conditions of one experiment, beside their "
        "difference; without it that of your cells, or 0.05.",
        least=0,
        most=1,
    )
    studies: int = parameter(
        150, "Studies that are simulated for each line of the table.", least=20, most=100_000
    )
    permutations: int = parameter(
        199, "Most ways to exchange labels in each of these studies.", least=99, most=100_000
    )
    seed: int = parameter(0, "Start of the random numbers.", least=0, most=MOST_SEED)

    @field_validator("effects")
    @classmethod
    def _above_0(cls, effects: tuple[float, ...]) -> tuple[float, ...]:
        if not effects or not all(0 < effect <= _MOST for effect in effects):
            raise ValueError(f"must be numbers above 0 and at most {_MOST}")
        return tuple(sorted(set(effects)))

    @field_validator("experiments")
    @classmethod
    def _from_2(cls, experiments: tuple[int, ...]) -> tuple[int, ...]:
        if not experiments or not all(2 <= count <= _MOST for count in experiments):
            raise ValueError(f"must be whole numbers from 2 to {_MOST}")
        return tuple(sorted(set(experiments)))
