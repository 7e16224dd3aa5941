"""Sphinx extension: write `reference/tables.rst`, all columns of all tables, from the package's own lists."""

from pathlib import Path
from typing import Any

from public_names import heading, write
from sphinx.application import Sphinx

from cytodisk.analysis.shape.features import GROUPS
from cytodisk.runs.batch.input_columns import INPUT, INPUT_COLUMNS
from cytodisk.runs.compare_windows.compare_tables import COMPARED_CELLS, COMPARED_MOVIE, COMPARED_NUCLEI
from cytodisk.runs.correlate.correlation_columns import CORRELATION_TABLES
from cytodisk.runs.map.map_kind import MAP
from cytodisk.runs.movie.movie_kind import MOVIE
from cytodisk.runs.population.population_kind import POPULATION
from cytodisk.runs.population.predictions.pooled_prediction_columns import POOLED_PREDICTION_TABLES
from cytodisk.runs.population.wave_numbers.pooled_wave_columns import POOLED_WAVE_TABLES
from cytodisk.runs.predict.prediction_columns import PREDICTION_TABLES
from cytodisk.runs.shapes.shape_tables import SHAPE_STUDY
from cytodisk.runs.waves.waves_columns import WAVE_TABLES
from cytodisk.store.study_kind import StudyKind
from cytodisk.store.tables import Columns

WORDS = """Tables are Parquet files. ``cytodisk.open_study`` reads them. Each table has the units of its
columns in ``attrs["units"]``; the file has them in its metadata. Lengths, areas and velocities are
in µm and seconds if the scale is known, else in pixels and frames. A column without a unit is a
count, a name or a choice."""
CHANNEL = "CHANNEL"
UNITS = {"length": "µm", "length²": "µm²", "velocity": "µm/s", "1": "1 (a ratio)"}


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("config-inited", write_page)
    return {"parallel_read_safe": True}


def write_page(app: Sphinx, _config: Any) -> None:
    lines = [*heading("Columns of every table", "="), WORDS, ""]
    mapped = tables_of(MAP, MOVIE)
    lines += run("Maps and movies", "``cytodisk map`` and ``cytodisk movie`` write these tables.", mapped)
    with_nuclei = tables_of(MAP.with_nuclei.with_channels([CHANNEL]), MOVIE.with_nuclei)
    lines += run(
        "Maps and movies with nuclei",
        f"With ``--nuclei`` the tables also have these columns. Those that end in ``{CHANNEL}`` are there "
        "once for each channel, with its name.",
        {name: only_new(columns, mapped.get(name, ())) for name, columns in with_nuclei.items()},
    )
    lines += [
        "With ``--groups`` the tables of cells (and ``shapes.parquet``) have ``condition``, ``experiment`` "
        "and your own columns behind ``label``: see :ref:`groups`.",
        "",
    ]
    lines += derived()
    lines += run("Shapes", "``cytodisk shapes`` writes this table.", {"shapes": SHAPE_STUDY.cells})
    lines += ["The features follow; ``features.csv`` lists them, too.", "", *features()]
    compared = tables_of(COMPARED_CELLS, COMPARED_MOVIE, COMPARED_NUCLEI)
    lines += run("Comparisons of windows", "``cytodisk compare-windows`` writes these tables.", compared)
    lines += ["``comparison_columns.csv`` explains the columns of the summaries, which are CSV files.", ""]
    lines += run("Populations", "``cytodisk population`` writes these tables.", tables_of(POPULATION))
    lines += [
        "``cells`` also has the columns of the studies and of the table of groups, and the scalars of each "
        "channel. Values are in the unit of the signal, or relative where cells were normalised.",
        "",
    ]
    inputs = {"inputs": (INPUT, *INPUT_COLUMNS)}
    lines += run("Many inputs", "``cytodisk batch`` writes this table, also as CSV.", inputs)
    lines += [
        "In the merged tables ``input``, your own columns and the units come before the columns above.",
        "",
    ]
    write(Path(app.srcdir) / "reference" / "tables.rst", lines)


def only_new(columns: Columns, known: Columns) -> Columns:
    """The columns of a table that are not known yet."""
    names = {column.name for column in known}
    return tuple(column for column in columns if column.name not in names)


def derived() -> list[str]:
    """Sections of what is computed from a movie's results, and of what is pooled over a batch."""
    lines = run(
        "Correlations",
        "``cytodisk correlate`` writes these tables into ``correlation/SIGNAL~WITH/``.",
        CORRELATION_TABLES,
    )
    lines += run(
        "Predictions",
        "``cytodisk predict`` writes these tables into ``prediction/SOURCE~TARGET/`` or "
        "``prediction/network/``.",
        PREDICTION_TABLES,
    )
    lines += run(
        "Pooled predictions",
        "``cytodisk predict`` of a batch writes these tables into ``prediction/SOURCE~TARGET/`` or "
        "``prediction/network/`` of its folder.",
        POOLED_PREDICTION_TABLES,
    )
    lines += run(
        "Waves",
        "``cytodisk waves`` writes these tables into ``waves/SIGNAL/``. Speeds are positive towards higher "
        "sectors, which is clockwise as seen in the image.",
        WAVE_TABLES,
    )
    lines += run(
        "Pooled waves",
        "``cytodisk waves`` of a batch writes these tables into ``waves/SIGNAL/`` of its folder.",
        POOLED_WAVE_TABLES,
    )
    return lines


def tables_of(*kinds: StudyKind) -> dict[str, Columns]:
    """Columns of the tables that runs of these kinds write, all that any of them has."""
    found: dict[str, Columns] = {}
    for kind in kinds:
        for name, columns in kind.tables.items():
            known = found.get(name, ())
            found[name] = (*known, *(column for column in columns if column not in known))
    return found


def run(title: str, words: str, tables: dict[str, Columns]) -> list[str]:
    """Section of a command: each of its tables."""
    lines = [*heading(title, "-"), words, ""]
    for name, columns in tables.items():
        if not columns:
            continue
        rows = [(column.name, column.unit, column.meaning) for column in columns]
        lines += [*heading(f"{name}.parquet", "~"), *list_table(rows)]
    return lines


def features() -> list[str]:
    """Shape features, group by group."""
    return list_table(
        [(feature.name, feature.unit, feature.description) for group in GROUPS for feature in group.features]
    )


def list_table(rows: list[tuple[str, str, str]]) -> list[str]:
    lines = [".. list-table::", "   :header-rows: 1", "   :class: small", "   :widths: 26 12 62", ""]
    for name, unit, meaning in [("Column", "Unit", "Meaning"), *rows]:
        first = name if name == "Column" else f"``{name}``"
        lines += [
            f"   * - {first}",
            f"     - {UNITS.get(unit, unit)}",
            f"     - {meaning}".replace("|", "\\|"),
        ]
    return [*lines, ""]
