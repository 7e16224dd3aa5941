from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cytodisk.store import merging

SCHEMA = pa.schema([("cell", pa.int64()), ("mean", pa.float64())])


@given(st.lists(st.integers(0, 30), max_size=12))
def test_tables_stand_one_below_the_other(
    tmp_path_factory: pytest.TempPathFactory, lengths: list[int]
) -> None:
    target = tmp_path_factory.mktemp("merged") / "a.parquet"
    parts = [pa.table({"cell": [k] * n, "mean": [0.5] * n}, schema=SCHEMA) for k, n in enumerate(lengths)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(merging, "ROWS_AT_ONCE", 20)
        merging.merge_tables(iter(parts), SCHEMA, target)
    merged = pq.read_table(target)
    assert merged["cell"].to_pylist() == [k for k, n in enumerate(lengths) for _ in range(n)]
    groups = [
        pq.read_metadata(target).row_group(k).num_rows for k in range(pq.read_metadata(target).num_row_groups)
    ]
    assert all(rows < 20 + 30 for rows in groups)  # never more than what was waited for and one part


@pytest.mark.parametrize("count", [0, 1, 999, 1000, 2001])
def test_rows_become_a_table(tmp_path: Path, count: int) -> None:
    rows = ({"cell": k, "more": "left out"} for k in range(count))
    merging.write_rows(rows, SCHEMA, tmp_path / "a.parquet")
    table = pq.read_table(tmp_path / "a.parquet")
    assert table["cell"].to_pylist() == list(range(count))
    assert table["mean"].null_count == count
