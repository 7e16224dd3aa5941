"""A share of the benchmark that breaks studies; the benchmark tries hundreds."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
CASES = 6


@pytest.fixture(scope="module")
def benchmark(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        from broken_studies import Benchmark
    finally:
        sys.path.remove(str(ROOT / "benchmarks"))
    return Benchmark(tmp_path_factory.mktemp("broken"))


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="processes are forked")
@pytest.mark.parametrize("seed", range(CASES))
def test_a_broken_study_is_resumed_to_the_same_or_refused_with_the_reason(benchmark: Any, seed: int) -> None:
    case = benchmark.try_case(seed)
    assert case.outcome in ("same", "refused"), case
    assert case.words or case.outcome == "same"
