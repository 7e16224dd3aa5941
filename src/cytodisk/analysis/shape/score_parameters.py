"""Parameters of `complexity_score`."""

from cytodisk.parameters import Parameters, parameter


class ScoreParameters(Parameters):
    """How cells are laid out by UMAP."""

    seed: int = parameter(
        0,
        "Seed of UMAP. The same seed gives the same result for the same cells in the same order.",
        least=0,
        most=2**32 - 1,  # of UMAP
    )
    n_neighbors: int = parameter(
        15,
        "Number of cells that UMAP takes for alike; at most one less than there are cells is used.",
        least=2,
        most=1_000_000,
        flag="neighbors",
    )
    min_dist: float = parameter(0.1, "How close together UMAP may put cells in the plane.", least=0, most=1)
