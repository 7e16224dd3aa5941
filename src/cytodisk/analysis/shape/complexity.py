"""`complexity_score`: one number for how complex the shape of a cell is among others (paper appendix B)."""

from __future__ import annotations

import warnings
from importlib.util import find_spec
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import spearmanr

from cytodisk.analysis.shape.features import SCALE_FREE
from cytodisk.analysis.shape.score_parameters import ScoreParameters
from cytodisk.arrays import FloatArray
from cytodisk.errors import MissingPartError, ParameterError
from cytodisk.taking import takes

LEAST_CELLS = 10
_LEAST_FEATURES = 2  # that vary: a plane has two axes
_WITHOUT_UMAP = str(MissingPartError.of("the complexity score needs umap-learn", "umap"))
_NORMAL_QUARTILES = 1.349  # between the quartiles of a normal distribution with standard deviation 1


@takes(ScoreParameters)
def complexity_score(features: pd.DataFrame, **settings: Any) -> pd.DataFrame:
    """Place cells on an axis from plain to complex shapes.

    The scale-free features, made comparable, are laid out in a plane by UMAP; the score is the position along
    the plane's principal axis, higher for cells with more edge for their area. The equivalent diameter of
    cells should be at least 75 px, or about the same in all: see `shape_features`.

    Parameters
    ----------
    features : DataFrame
        As `shape_features` returns it, or several of them put together. `attrs["scale_free"]` names the
        columns that count; without it they are all scale-free features of `shape_features`.
    **settings
        See `ScoreParameters`.

    Returns
    -------
    DataFrame
        Index and columns "cell" and "status" of `features`, then "complexity", "umap_1" and "umap_2", which
        are relative to the mean of the cells, NaN for cells without features. `attrs["axis"]` is the
        principal axis (umap_1, umap_2), of length 1, towards complex shapes; `attrs["axis_share"]` the share
        of the variance along it: near 0.5 there is no such axis. `attrs["first_component"]` is the rank
        correlation of the score with the first principal component of the features.

    Raises
    ------
    ParameterError
        `features` is not a table of numbers with the columns of `shape_features`, has fewer than 10 cells
        with numbers, or cells that are all alike; or a parameter is out of its range.
    MissingPartError
        umap-learn is not installed.

    See Also
    --------
    shape_features : Measures the features.

    Notes
    -----
    The median of each feature is taken away, what is left is divided by the spread between quartiles and
    compressed by arsinh, which is a logarithm for large values, so that few extreme cells do not make the
    axis. UMAP starts from the first two principal components: from its usual start, groups of cells that
    hang together loosely come to lie anywhere, and the score depends on the seed. Eigenvectors have no sign:
    the axis points to where circularity falls (rank correlation), so circularity must not be constant.

    The score has no unit and depends on the cells that are scored together: compare only scores that were
    computed in one call. Where large and small cells are scored together, the place of the small ones also
    depends on the resolution.

    References
    ----------
    u-Unwrap, appendix B. McInnes, Healy and Melville, "UMAP", 2018, arXiv:1802.03426. Kobak and Linderman,
    "Initialization is critical for preserving global data structure in both t-SNE and UMAP", 2021,
    doi:10.1038/s41587-020-00809-z.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cells = [cd.simulate.random_smooth(seed, radius=12) for seed in range(10)]
    >>> score = cd.complexity_score(cd.shape_features(cells))
    >>> list(score.columns)
    ['cell', 'status', 'complexity', 'umap_1', 'umap_2']
    >>> bool(score["complexity"].notna().all())
    True
    """
    how = ScoreParameters.of(**settings)
    if reason := why_unscored(features):
        raise (MissingPartError if reason == _WITHOUT_UMAP else ParameterError)(reason)
    names, values = _measured(features)
    known = np.isfinite(values).all(axis=1)
    comparable = standardised(values[known])
    plane = umap_plane(comparable, how.seed, min(how.n_neighbors, int(known.sum()) - 1), how.min_dist)
    axis, share = principal_axis(plane)
    circularity = values[known, names.index("circularity")]
    score = plane @ axis
    if _rank_correlation(score, circularity) > 0:
        axis, score = -axis, -score
    table = features[[name for name in ("cell", "status") if name in features]].copy()
    for name, column in zip(("complexity", "umap_1", "umap_2"), (score, *plane.T), strict=True):
        table[name] = np.nan
        table.loc[known, name] = column
    table.attrs = {
        "axis": tuple(axis.tolist()),
        "axis_share": share,
        "first_component": abs(_rank_correlation(score, first_component(comparable))),
        "units": dict.fromkeys(("complexity", "umap_1", "umap_2"), "1"),
    }
    return table


def why_unscored(features: pd.DataFrame) -> str:
    """Why cells cannot be scored; empty if they can.

    Parameters
    ----------
    features : DataFrame
        As for `complexity_score`.

    Returns
    -------
    str

    Raises
    ------
    ParameterError
        `features` is not a table of numbers with the columns of `shape_features`.
    """
    names, values = _measured(features)
    values = values[np.isfinite(values).all(axis=1)]
    if len(values) < LEAST_CELLS:
        return (
            f"features has {len(values)} cells with numbers, and a complexity score is relative to other "
            f"cells: pass at least {LEAST_CELLS}"
        )
    varying = standardised(values).shape[1]
    if varying < _LEAST_FEATURES:
        return (
            f"features has {len(values)} cells that are all alike ({varying} of their features vary), and a "
            "complexity score tells how they differ: pass cells of different shapes"
        )
    if not standardised(values[:, [names.index("circularity")]]).size:
        return (
            "features has the same circularity in every cell, which tells the plain end of the axis from the "
            "complex one: pass cells of different shapes"
        )
    return _WITHOUT_UMAP if find_spec("umap") is None else ""


def _measured(features: pd.DataFrame) -> tuple[list[str], FloatArray]:
    """Names and values of the features that count."""
    if not isinstance(features, pd.DataFrame):
        raise ParameterError(
            f"features must be a DataFrame, got {type(features).__name__}: pass the table that "
            "shape_features returns"
        )
    names = list(features.attrs.get("scale_free", SCALE_FREE))
    missing = [name for name in dict.fromkeys([*names, "circularity"]) if name not in features]
    if missing:
        raise ParameterError(
            f"features has no column {missing[0]!r}: pass the table that shape_features returns"
        )
    if "circularity" not in names:
        names.append("circularity")
    for name in names:
        _check_column(features[name], name)
    return names, features[names].to_numpy(np.float64, na_value=np.nan)


def _check_column(column: pd.Series[Any] | pd.DataFrame, name: str) -> None:
    if isinstance(column, pd.DataFrame):
        raise ParameterError(f"features has {column.shape[1]} columns {name!r}: leave one of them")
    if not pd.api.types.is_any_real_numeric_dtype(column):
        raise ParameterError(
            f"features holds {column.dtype} in column {name!r}, not numbers: convert it by pd.to_numeric"
        )


def standardised(values: FloatArray) -> FloatArray:
    """Features made comparable: median 0, spread between quartiles as of a standard normal, tails compressed.

    Parameters
    ----------
    values : ndarray of shape (cells, features) and dtype float

    Returns
    -------
    ndarray of shape (cells, features that vary) and dtype float
    """
    centred = values - np.median(values, axis=0)
    low, high = np.percentile(values, (25, 75), axis=0)
    spread = (high - low) / _NORMAL_QUARTILES
    spread = np.where(spread > 0, spread, values.std(axis=0))  # such as counts that are 0 for most cells
    varies = spread > 1e-12 * np.maximum(1.0, np.abs(values).max(axis=0))
    return np.asarray(np.arcsinh(centred[:, varies] / spread[varies]))


def umap_plane(values: FloatArray, seed: int, n_neighbors: int, min_dist: float) -> FloatArray:
    """Place cells in a plane so that alike ones are close together.

    Parameters
    ----------
    values : ndarray of shape (cells, features) and dtype float
    seed, n_neighbors, min_dist
        As for `complexity_score`.

    Returns
    -------
    ndarray of shape (cells, 2) and dtype float
        Mean 0.

    Raises
    ------
    MissingPartError
        umap-learn is not installed.
    """
    reducer = load_umap().UMAP(
        n_neighbors=n_neighbors, min_dist=min_dist, init="pca", random_state=seed, n_jobs=1
    )
    plane = np.asarray(reducer.fit_transform(values), dtype=np.float64)
    return np.asarray(plane - plane.mean(axis=0))


def load_umap() -> Any:
    """The package `umap`.

    Raises
    ------
    MissingPartError
        umap-learn is not installed.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ImportWarning)  # that TensorFlow, which is not used, is missing
            import umap
    except ImportError as error:
        raise MissingPartError(_WITHOUT_UMAP) from error
    return umap


def principal_axis(plane: FloatArray) -> tuple[FloatArray, float]:
    """Direction of largest variance in a plane.

    Parameters
    ----------
    plane : ndarray of shape (cells, 2) and dtype float

    Returns
    -------
    axis : ndarray of shape (2,) and dtype float
        Of length 1; its sign is arbitrary.
    share : float
        Share of the variance, 0.5 to 1.
    """
    variances, vectors = np.linalg.eigh(np.cov(plane.T))
    return np.asarray(vectors[:, -1]), float(variances[-1] / variances.sum())


def first_component(values: FloatArray) -> FloatArray:
    """Score of each cell on the first principal component, shape (cells,); its sign is arbitrary.

    Parameters
    ----------
    values : ndarray of shape (cells, features) and dtype float
    """
    left, sizes, _ = np.linalg.svd(values - values.mean(axis=0), full_matrices=False)
    return np.asarray(left[:, 0] * sizes[0])


def _rank_correlation(first: FloatArray, second: FloatArray) -> float:
    return float(spearmanr(first, second).statistic)
