"""The QC flags of a study in lines: what is wrong, where, and what to do."""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag
    from cytodisk.store.correlation_store import Correlation
    from cytodisk.store.study import Study
    from cytodisk.store.waves.waves_store import Waves

MOST_FLAGS = 8
_MOST_PLACES = 8
_LONGEST_NOTE, _SHORT_NOTE = 160, 40


def study_flag_lines(study: "Study", found: "Correlation | None" = None) -> Iterator[str]:
    """The QC flags of a study; of its correlations those of one alone, if that is given."""
    from cytodisk.runs.qc_flags.one_correlation import with_one
    from cytodisk.runs.qc_flags.study_flags import qc_flags

    page = f"cytodisk report {study.path}"
    files = file_names(study)
    shown = qc_flags(study if found is None else with_one(study, found))
    yield from flag_lines(shown, f"see {page}", files)
    if found is not None and _places(qc_flags(study)) - _places(shown):
        yield f"flags of other results: {page}"


def wave_flag_lines(study: "Study", found: "Waves") -> Iterator[str]:
    """The QC flags of a study's run, and of its waves those of one signal alone."""
    from cytodisk.runs.qc_flags.one_of_waves import with_waves
    from cytodisk.runs.qc_flags.study_flags import run_flags, wave_flags_of

    page = f"cytodisk report {study.path}"
    flags = [*wave_flags_of(with_waves(study, found)), *run_flags(study)]
    yield from flag_lines(flags, f"see {page}", file_names(study))


def file_names(study: "Study") -> dict[int, str]:
    """Name of the file of each cell, where they come from several."""
    cells = study.cells
    many = "source" in cells and cells["source"].nunique() > 1
    return dict(zip(cells["cell"], cells["source"], strict=True)) if many else {}


def _places(flags: Sequence["QCFlag"]) -> set[tuple[str, "Place"]]:
    return {(flag.name, place) for flag in flags for place in flag.places}


def flag_lines(flags: Sequence["QCFlag"], where_all: str, files: Mapping[int, str]) -> Iterator[str]:
    """QC flags, a line each, the gravest first.

    Parameters
    ----------
    flags : sequence of QCFlag
        As `qc_flags` sorts them.
    where_all : str
        Where those stand for which there is no room.
    files : mapping of int to str
        Name of the file of each cell, where they come from several.
    """
    for flag in flags[:MOST_FLAGS]:
        places = f" ({places_words(flag.places, files)})" if flag.places else ""
        yield f"QC flag {flag.name}: {flag.what}{places}. {flag.advice}"
    if len(flags) > MOST_FLAGS:
        yield f"… and {len(flags) - MOST_FLAGS} more QC flags: {where_all}"
    if not flags:
        yield "no QC flags"


def places_words(places: Sequence["Place"], files: Mapping[int, str]) -> str:
    """The first places of a flag, as "cell 0, frame 12: +9%; cell 0, frame 40: +12%; … 7 more"."""
    alike: dict[object, tuple[str, list[str]]] = {}  # a long note that comes again is said once
    for place in places[:_MOST_PLACES]:
        key = place.note if len(place.note) > _SHORT_NOTE else place
        alike.setdefault(key, (place.note, []))[1].append(_where(place, files))
    words = [" and ".join(where) + (f": {_short(note)}" if note else "") for note, where in alike.values()]
    more = len(places) - _MOST_PLACES
    return "; ".join([*words, f"… {more} more"] if more > 0 else words)


def _where(place: "Place", files: Mapping[int, str]) -> str:
    where = f"cell {place.cell}" + (f" of {files[place.cell]}" if place.cell in files else "")
    return f"{where}, {words}" if (words := place.frames_words) else where


def _short(note: str) -> str:
    return note if len(note) <= _LONGEST_NOTE else note[:_LONGEST_NOTE].rpartition(" ")[0] + " …"
