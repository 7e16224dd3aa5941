import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cytodisk.motion.cyclic_system import solve_cyclic


def dense(diagonal: np.ndarray, coupling: np.ndarray) -> np.ndarray:
    """Plain twin's matrix: entry i of the coupling joins i and i + 1, the last one the last and the first."""
    n = len(diagonal)
    matrix = np.diag(diagonal)
    for i in range(n):
        matrix[i, (i + 1) % n] += coupling[i]
        matrix[(i + 1) % n, i] += coupling[i]
    return matrix


@given(st.integers(3, 20), st.integers(1, 4), st.integers(0, 10**6))
def test_a_dominant_system_is_solved_like_the_dense_one(n: int, k: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    coupling = random.normal(size=n)
    diagonal = np.abs(coupling) + np.abs(np.roll(coupling, 1)) + random.uniform(0.1, 3.0, n)
    right = random.normal(size=(n, k))
    solved = solve_cyclic(diagonal, coupling, right)
    np.testing.assert_allclose(solved, np.linalg.solve(dense(diagonal, coupling), right), atol=1e-9)


@given(st.integers(3, 20), st.integers(0, 10**6))
def test_any_positive_definite_system_is_solved(n: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    coupling, diagonal = random.normal(size=(2, n))
    diagonal += 0.1 - np.linalg.eigvalsh(dense(diagonal, coupling))[0]
    right = random.normal(size=(n, 2))
    solved = solve_cyclic(diagonal, coupling, right)
    np.testing.assert_allclose(dense(diagonal, coupling) @ solved, right, atol=1e-8)


def test_the_arguments_stay_as_they_are() -> None:
    given_ = np.full(5, 3.0), np.full(5, -1.0), np.arange(10.0).reshape(5, 2)
    copies = [array.copy() for array in given_]
    solve_cyclic(*given_)
    for array, copy in zip(given_, copies, strict=True):
        np.testing.assert_array_equal(array, copy)
