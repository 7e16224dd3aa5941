"""Help that lists the flags of a command under headings."""

from typing import Any

from typer.core import TyperCommand

from cytodisk.runs.told.flag_headings import grouped

WIDTH = 100
"""Letters in a line of help, at most; less in a narrow window."""


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
