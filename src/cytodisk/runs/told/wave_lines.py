"""What waves tell: the finding first, then layers, cells that were left out, and what was replaced."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from cytodisk.number_words import counted

if TYPE_CHECKING:
    from cytodisk.runs.waves.wave_run_parameters import WavesParameters
    from cytodisk.store.study import Study
    from cytodisk.store.waves.waves_store import Waves

_MOST_FINDINGS = 3  # cells of which sentences are told
_MOST_CELLS = 8  # whose layers are listed


def wave_finding_lines(found: "Waves", study: "Study") -> Iterator[str]:
    """What was found, in the sentences of the report; of several cells in how many first."""
    from cytodisk.runs.findings.doubt_words import bearing_flags
    from cytodisk.runs.findings.waves_finding import waves_finding, waves_summary
    from cytodisk.runs.qc_flags.study_flags import run_flags

    flags = run_flags(study)
    cells = [int(cell) for cell in found.cells.loc[found.cells["status"] == "ok", "cell"]]
    if len(cells) > 1:
        yield waves_summary(study, found)
    for cell in cells[:_MOST_FINDINGS]:
        finding = waves_finding(study, found, cell, bearing_flags(flags, cell))
        if finding is not None:
            yield finding.words
    if (more := len(cells) - _MOST_FINDINGS) > 0:
        yield f"… and those of {counted(more, 'more cell')}: they stand in the report"


def wave_lines(found: "Waves", study: "Study") -> Iterator[str]:
    """A line for each layer of a signal, and for each cell that was left out."""
    from cytodisk.runs.channel_names import VELOCITIES

    cells = found.cells
    done = cells.loc[cells["status"] == "ok", "cell"].tolist()
    if found.signal not in VELOCITIES:
        for cell in done[:_MOST_CELLS]:
            yield f"cell {cell}, by layer:"
            yield from _layer_lines(found, study, cell)
        if len(done) > _MOST_CELLS:
            yield f"… and {counted(len(done) - _MOST_CELLS, 'more cell')}: layers.parquet has them all"
    for row in cells[cells["status"] != "ok"].itertuples():
        yield f"cell {row.cell} left out: {row.reason}"
    surrogates = found.settings["surrogates_made"]
    yield (
        f"waves were looked for in {counted(len(done), 'cell')}; p counts {surrogates} surrogates that keep "
        "the spectrum of each sector"
    )


def _layer_lines(found: "Waves", study: "Study", cell: int) -> Iterator[str]:
    from cytodisk.runs.findings.layer_names import layer_name
    from cytodisk.runs.findings.wave_words import wave_numbers

    rows = found.layers[found.layers["cell"] == cell]
    frames = float(found.cells.loc[found.cells["cell"] == cell, "frames"].iloc[0])
    for row in rows.assign(frames=frames).to_dict("records"):
        name = layer_name(study, int(row["layer"]))
        if row["status"] != "ok":
            yield f"  {name}: left out, {row['reason']}"
            continue
        what = f"{row['kind']}, {wave_numbers(row, study.scale)}" if row["kind"] != "none" else "no waves"
        yield f"  {name}: {what}, p = {row['p']:.2g}, q = {row['q']:.2g}{_in_doubt(row)}"


def _in_doubt(row: dict[Any, Any]) -> str:
    """What speaks against the wave of a layer, by the names of QC flags."""
    from cytodisk.analysis.waves.edge_waves import SIGNIFICANT
    from cytodisk.runs.qc_flags.wave_doubts import NEAR_A_LIMIT

    raised = {
        "one of many layers (q)": row["q"] > SIGNIFICANT,
        "few periods": row["period"] * NEAR_A_LIMIT > row["longest_period"],
        f"waves of the cell's motion (p = {row['p_partial']:.2g} without it)": row["p_partial"] > SIGNIFICANT,
    }
    doubts = [name for name, is_raised in raised.items() if is_raised and row["kind"] != "none"]
    return f"; in doubt: {', '.join(doubts)}" if doubts else ""


def earlier_waves(study: "Study", signal: str, now: "WavesParameters") -> str:
    """Which settings the waves have that will be replaced, if others; empty if there are none."""
    names = (signal, now.name) if now.name else (signal,)
    if names not in study.wave_signals:
        return ""
    before: dict[str, Any] = study.waves(*names).settings
    after = now.model_dump(mode="json")
    changed = [name for name in after if name in before and before[name] != after[name]]
    told = ", ".join(f"--{name.replace('_', '-')} {before[name]}" for name in changed)
    return f"The earlier waves of {signal} ({told}) were replaced" if told else ""
