"""In which order and under which headings flags of a command are listed: in its help, and in forms."""

from collections.abc import Sequence

GROUPS = {
    "Files": "to signal nuclei groups out parameters",
    "What is written": "cells frames windows images",
    "What the files hold": "pixel-size frame-interval channels movie kind label fragments holes link tracks "
    "axes signal-axes scene z mask-channel signal-channels nuclei-kind nuclei-axes nuclei-channel",
    "Nuclei": "several missing nucleus-radius",
    "Windows": "layers sectors nucleus-layers points harmonics depth-um depth-px spacing align nan methods "
    "evenness line-tension",
    "Map of each cell": "method shape-weight edge-length",
    "Motion of the edge and the inside": "tracker tension smoothness-px2 registration renew-every inertia "
    "interior fade-um",
    "Score of complexity": "neighbors min-dist seed",
    "The run": "workers resume overwrite time-limit scheduler dry-run seed",
    "Results": "csv maps geojson cell cells figures format all no-report quiet help",
}
"""Flags by heading, without dashes in front."""

CORRELATION_GROUPS = {
    "What is correlated": "signal with cell max-lag frames without-frames sectors skip-lags against pairs "
    "clusters control geometry",
    "Many movies": "groups compare permutations resume",
    "How it is correlated": "statistic detrend detrend-frames difference min-pairs rule surrogates null seed",
    "Results": "name csv figures format parameters quiet help",
}
"""The same for a command with the flag `--with`."""

PREDICTION_GROUPS = {
    "What is tested": "source target given cell frames without-frames sectors geometry",
    "Many movies": "groups compare permutations resume",
    "How it is tested": "max-order order source-order given-order criterion neighbours detrend surrogates "
    "seed",
    "Results": "name csv figures format parameters quiet help",
}
"""The same for a command with the flag `--source`."""

WAVE_GROUPS = {
    "Where waves are looked for": "signal layer cell frames without-frames geometry",
    "How they are tested": "max-mode frames-per-period periods surrogates seed",
    "Many movies": "groups compare permutations resume",
    "Results": "name csv figures format parameters quiet help",
}
"""The same for a command with the flag `--layer`."""

POPULATION_GROUPS = {
    "What is compared": "compare channel scalars groups dose dose-scale",
    "What each cell contributes": "summary normalise align",
    "How it is tested": "unit design permutations seed",
    "Planning experiments": "power effects experiments cells between-experiments between-dishes studies",
    "The run": "resume overwrite",
    "Results": "out csv h5ad figures format no-report parameters quiet help",
}
"""The same for a command with the flag `--compare`."""


def grouped(flags: Sequence[str]) -> list[tuple[str, list[str]]]:
    """Flags of a command by heading, in the order of help.

    Parameters
    ----------
    flags : sequence of str
        Without dashes in front.

    Returns
    -------
    list of (str, list of str)
        Headings with their flags; those that no heading names are under the last, "More".

    Examples
    --------
    >>> from cytodisk.runs.told.flag_headings import grouped
    >>> grouped(["csv", "sectors", "signal", "layers"])
    [('Files', ['signal']), ('Windows', ['layers', 'sectors']), ('Results', ['csv'])]
    """
    marks = {
        "with": CORRELATION_GROUPS,
        "source": PREDICTION_GROUPS,
        "layer": WAVE_GROUPS,
        "compare": POPULATION_GROUPS,
    }
    groups = next((own for mark, own in marks.items() if mark in flags), GROUPS)
    found: list[tuple[str, list[str]]] = []
    left = list(flags)
    for heading, names in groups.items():
        there = [name for name in names.split() if name in left]
        if heading == "Score of complexity" and "neighbors" not in there:
            continue  # a seed is no score
        left = [name for name in left if name not in there]
        found += [(heading, there)] if there else []
    return [*found, ("More", left)] if left else found
