"""`cytodisk report` on the folder of a batch."""

import sys
from pathlib import Path

from cytodisk.cli.console import console_for, count, progress_bar

_MOST_FAILED = 20


def report_batch(batch: Path, *, resume: bool, quiet: bool) -> None:
    """Write the page of each study of a batch, and the page that lists them."""
    from cytodisk.pages.batch_reports import write_batch_reports

    console = console_for(quiet)
    stopped = "Stopped; the pages that are done stay: run it again with --resume."
    with progress_bar(quiet, "studies", stopped=stopped) as progress:
        found = write_batch_reports(batch, resume=resume, progress=progress)
    kept = int((found.table["status"] == "kept").sum())
    done = len(found.table) - len(found.failed)
    words = f"{done} of {count(len(found.table), 'input')} have a page"
    console.print(words + (f", {kept} of them from before" if kept else ""))
    for row in found.failed.head(_MOST_FAILED).itertuples():
        print(f"{row.input} {row.status}: {row.reason}", file=sys.stderr)
    if len(found.failed) > _MOST_FAILED:
        print(f"… and {len(found.failed) - _MOST_FAILED} more: look into their folders", file=sys.stderr)
