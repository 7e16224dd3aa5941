"""In which order and under which headings `cytodisk COMMAND --help` lists its flags."""

from collections.abc import Sequence
from typing import Any

from typer.core import TyperCommand

WIDTH = 100
"""Letters in a line of help, at most; less in a narrow window."""

GROUPS = {
    "Files": "signal nuclei groups out parameters",
    "What the files hold": "pixel-size frame-interval channels movie kind label fragments holes link tracks "
    "axes signal-axes scene z mask-channel signal-channels nuclei-kind nuclei-axes nuclei-channel",
    "Nuclei": "several missing nucleus-radius",
    "Windows": "layers sectors nucleus-layers points harmonics depth-um depth-px spacing align nan methods",
    "Map of each cell": "method shape-weight edge-length",
    "Motion of the edge and the inside": "tracker tension smoothness-px2 registration renew-every inertia "
    "interior fade-um",
    "Score of complexity": "neighbors min-dist seed",
    "The run": "workers resume overwrite time-limit scheduler dry-run seed",
    "Results": "csv maps geojson cell cells figures all no-report quiet help",
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

POPULATION_GROUPS = {
    "What is compared": "compare channel scalars groups dose dose-scale",
    "What each cell contributes": "summary normalise align",
    "How it is tested": "unit design permutations seed",
    "Planning experiments": "power effects experiments cells between-experiments between-dishes studies",
    "The run": "resume overwrite",
    "Results": "out csv h5ad figures format no-report parameters quiet help",
}
"""The same for a command with the flag `--compare`."""


class GroupedCommand(TyperCommand):
    """A command whose help lists flags under headings, as plain text."""

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """What follows the name of the command in the first line, without the marks of a choice."""
        return [piece.strip("{}") for piece in super().collect_usage_pieces(ctx)]

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse, and refuse an option that is given twice: the first of them would count for nothing."""
        _, _, given = self.make_parser(ctx).parse_args(args=list(args))
        for param in given if not ctx.resilient_parsing else ():
            once = param.param_type_name == "option" and not (
                param.multiple or getattr(param, "is_flag", False)
            )
            if once and given.count(param) > 1:
                ctx.fail(f"--{flag_name(param)} is given {given.count(param)} times: keep one")
        found: list[str] = super().parse_args(ctx, args)
        return found

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write arguments, then the flags by heading."""
        shown = [(param, param.get_help_record(ctx)) for param in self.get_params(ctx)]
        arguments = [said for param, said in shown if said and param.param_type_name == "argument"]
        if arguments:
            with formatter.section("Arguments"):
                formatter.write_dl([(name.split()[0], words) for name, words in arguments])
        records = {flag_name(param): said for param, said in shown if said and said not in arguments}
        for heading, flags in grouped(list(records)):
            with formatter.section(heading):
                formatter.write_dl([records[flag] for flag in flags])


def flag_name(param: Any) -> str:
    """The long flag of an option, without dashes; the name of an argument."""
    longest: str = max(param.opts, key=len)
    return longest.removeprefix("--")


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
    >>> from cytodisk.cli.help_groups import grouped
    >>> grouped(["csv", "sectors", "signal", "layers"])
    [('Files', ['signal']), ('Windows', ['layers', 'sectors']), ('Results', ['csv'])]
    """
    groups = CORRELATION_GROUPS if "with" in flags else POPULATION_GROUPS if "compare" in flags else GROUPS
    found: list[tuple[str, list[str]]] = []
    left = list(flags)
    for heading, names in groups.items():
        there = [name for name in names.split() if name in left]
        if heading == "Score of complexity" and "neighbors" not in there:
            continue  # a seed is no score
        left = [name for name in left if name not in there]
        found += [(heading, there)] if there else []
    return [*found, ("More", left)] if left else found
