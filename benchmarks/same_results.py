"""Are the results of two revisions of the package the same? Every table, array and figure is compared.

    benchmarks/same_results.py --compare REVISION REVISION     make both, and compare
    benchmarks/same_results.py --run SRC OUT                   make the results with the package in SRC
    benchmarks/same_results.py OLD NEW                         compare two folders of results

"." stands for the files as they are. Names that changed are mapped: tables of them stand here (RENAMED,
RENAMED_FILES), in `differences.py` (REWORDED) and in `make_results.py` (RENAMED_WORDS). Running times are
left out, and so is what describes columns in words. Figures hold words, so they must exist on both sides, and
how many of their pixels differ is told. Ends with status 1 if there is a difference that EXPLAINED does not
name.
"""

import argparse
import json
import os
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import zarr
from zarr.storage import ZipStore

from differences import compare_pictures, difference
from make_results import Amount, make_results
from revisions import files_of

HERE = Path(__file__).parent
# Columns and arrays, as they were and as they are.
RENAMED = {"time": "frame", "doubts": "qc_flags", "track_times": "track_frames"}
# Patterns of files' names, as they were, and what stands for them.
RENAMED_FILES: dict[str, str] = {r"activity\.zarr$": "activity.zarr.zip"}
# File (a pattern) and name: a difference that is wanted, and why.
EXPLAINED: dict[tuple[str, str], str] = {
    (r"\.npz$", "header.pixel_size_um"): "a map carries its scale",
    (r"\.npz$", "header.frame_interval_s"): "a map carries its scale",
}
LEFT_OUT = {"seconds": "running time", "description": "words about columns", "header.format": "file format"}
_UNREAD = (".html", ".json", ".toml")


@dataclass(frozen=True)
class Finding:
    """What a comparison of two files says.

    Attributes
    ----------
    file : str
        Path in the folder of the results.
    name : str
        Column or array; empty for the file as a whole.
    text : str
        What differs.
    counts : bool
        Whether this is a difference of results.
    """

    file: str
    name: str
    text: str
    counts: bool = True


def read_table(path: Path) -> dict[str, np.ndarray]:
    """Columns of a Parquet file, and their units."""
    table = pq.read_table(path)
    units = {
        f"unit of {field.name}": np.array([(field.metadata or {}).get(b"unit", b"").decode()])
        for field in table.schema
    }
    return {str(name): column.to_numpy() for name, column in table.to_pandas().items()} | units


def read_csv(path: Path) -> dict[str, np.ndarray]:
    """Columns of a CSV file."""
    return {str(name): column.to_numpy() for name, column in pd.read_csv(path).items()}


def read_arrays(path: Path) -> dict[str, np.ndarray]:
    """Arrays of an npz file; what its header says one by one."""
    with np.load(path) as stored:
        arrays = {name: stored[name] for name in stored.files}
    if "header" in arrays:
        header = pd.json_normalize(json.loads(str(arrays.pop("header"))))
        arrays |= {f"header.{name}": np.array(header[name].tolist()) for name in header}
    return arrays


def read_store(path: Path) -> dict[str, np.ndarray]:
    """Arrays of a Zarr store, a folder or packed into one file, by their place in it."""
    store = ZipStore(path, mode="r") if path.is_file() else path
    members = zarr.open_group(store, mode="r").members(max_depth=None)
    return {place: np.asarray(item[...]) for place, item in members if isinstance(item, zarr.Array)}


READERS: dict[str, Callable[[Path], dict[str, np.ndarray]]] = {
    ".parquet": read_table,
    ".csv": read_csv,
    ".npz": read_arrays,
    ".zarr": read_store,
    ".zip": read_store,
}


def compare_folders(old: Path, new: Path) -> tuple[list[str], list[Finding]]:
    """Compare all results of two folders.

    Returns
    -------
    files : list of str
        Those that are on both sides, by their present names.
    findings : list of Finding
    """
    before = {_present_file(file): old / file for file in _files(old)}
    after = {file: new / file for file in _files(new)}
    findings = [Finding(file, "", "is gone") for file in sorted(before.keys() - after.keys())]
    findings += [Finding(file, "", "is new") for file in sorted(after.keys() - before.keys())]
    both = sorted(before.keys() & after.keys())
    for file in both:
        findings += compare_files(file, before[file], after[file])
    return both, findings


def compare_files(file: str, old: Path, new: Path) -> Iterator[Finding]:
    """Compare two files of one kind."""
    if old.suffix in READERS:
        read = READERS[old.suffix]
        yield from (Finding(file, *found) for found in compare_values(read(old), read(new)))
    elif old.suffix in (".png", ".gif"):
        text = compare_pictures(old, new)
        if text:
            yield Finding(file, "", text, counts=False)
    elif old.suffix not in _UNREAD and old.read_bytes() != new.read_bytes():
        yield Finding(file, "", "other bytes")


def compare_values(old: Mapping[str, np.ndarray], new: Mapping[str, np.ndarray]) -> Iterator[tuple[str, str]]:
    """Name and difference of every column or array that is not the same."""
    before = {_present_name(name, new): values for name, values in old.items()}
    for name in [*before, *(name for name in new if name not in before)]:
        if name.removeprefix("unit of ").rpartition("/")[2] in LEFT_OUT:
            continue
        if name not in new:
            yield name, "is gone"
        elif name not in before:
            yield name, "is new"
        elif text := difference(before[name], new[name]):
            yield name, text


def explanation(finding: Finding) -> str:
    """Why a difference is wanted; empty if it is not."""
    for (file, name), why in EXPLAINED.items():
        if re.search(file, finding.file) and name == finding.name:
            return why
    return ""


def report(files: Sequence[str], findings: Sequence[Finding]) -> bool:
    """Print what was found, files of one kind together; whether the results are the same."""
    touched = {found.file for found in findings}
    for kind, number in Counter(_kind(file) for file in files if file not in touched).items():
        same = "on both sides, not compared" if Path(kind).suffix in _UNREAD else "equal bit for bit"
        print(f"{kind}: {same}" + (f" ({number} files)" if number > 1 else ""))
    for words, number in Counter(_line(found) for found in findings).items():
        print(words + (f" ({number} files)" if number > 1 else ""))
    print("left out: " + ", ".join(f"{name} ({why})" for name, why in LEFT_OUT.items()))
    bad = [found for found in findings if found.counts and not explanation(found)]
    print(f"{len(files)} files on both sides; {len(bad)} differences that are not explained")
    return not bad


def _line(found: Finding) -> str:
    """A difference in words, the same for files of one kind; for all files where it is wanted."""
    why = explanation(found)
    if why:
        return f"wanted: {found.name}: {found.text}; {why}"
    mark = "DIFFERENT" if found.counts else "told"
    return ": ".join([mark, _kind(found.file), *([found.name] if found.name else []), found.text])


def _kind(file: str) -> str:
    """The name of a file with N for numbers, where a run writes many of its kind."""
    return file if file.endswith(".parquet") else re.sub(r"\d+", "N", file)


def _files(folder: Path) -> Iterator[str]:
    """Results in a folder, without the inputs, what was printed, and hidden files; a Zarr store is one."""
    for path in sorted(folder.rglob("*")):
        parts = path.relative_to(folder).parts
        store = path.suffix == ".zarr"
        inside = any(part.endswith(".zarr") for part in parts[:-1])
        if "input" in parts or parts[0] == "inputs" or parts[-1].startswith(".") or inside:
            continue
        if store or (path.is_file() and path.suffix != ".log"):
            yield "/".join(parts)


def _present_file(file: str) -> str:
    for pattern, name in RENAMED_FILES.items():
        file = re.sub(pattern, name, file)
    return file


def _present_name(name: str, new: Mapping[str, Any]) -> str:
    """The name that a column or array has now; places in a store and units keep what stands before."""
    last = re.split(r"unit of |/", name)[-1]
    renamed = name.removesuffix(last) + RENAMED.get(last, last)
    return renamed if name not in new else name


def main() -> int:
    """Make or compare results."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    default = Path(os.environ.get("CYTODISK_DATA", HERE.parents[1] / "shared" / "data"))
    parser.add_argument("results", nargs="*", type=Path, metavar="OLD NEW", help="two folders of results")
    parser.add_argument("--run", nargs=2, type=Path, metavar=("SRC", "OUT"), help="make results in OUT")
    parser.add_argument("--compare", nargs=2, metavar=("OLD", "NEW"), help="revisions to run and compare")
    parser.add_argument("--data", type=Path, default=default, help="folder of the real data")
    parser.add_argument("--cells", type=int, default=60, help="of the stack of 325 cells (default 60)")
    parser.add_argument("--frames", type=int, default=10, help="of each movie; 0 for all (default 10)")
    chosen = parser.parse_args()
    amount = Amount(chosen.cells, frames=chosen.frames or None)
    if chosen.run:
        source, out = chosen.run
        make_results(source, out, chosen.data, amount)
        return 0
    if chosen.compare:
        with tempfile.TemporaryDirectory() as name:
            folders = [Path(name) / f"results_{side}" for side in ("old", "new")]
            for revision, out in zip(chosen.compare, folders, strict=True):
                make_results(files_of(revision, out.with_suffix(".files")) / "src", out, chosen.data, amount)
            return int(not report(*compare_folders(*folders)))
    if len(chosen.results) != 2:
        parser.error("give two folders of results, or --run, or --compare")
    return int(not report(*compare_folders(*chosen.results)))


if __name__ == "__main__":
    sys.exit(main())
