"""How much memory there is to use."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

_UNKNOWN = 2**40
_GROUP = Path("/sys/fs/cgroup")


def free_bytes() -> int:
    """Memory that a process can still take: that of the machine, of its container and of its own limit."""
    return max(0, min(_of_machine(), _of_container(), _of_process()))


def _of_machine() -> int:
    with suppress(OSError, ValueError, IndexError):
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    with suppress(OSError, ValueError, AttributeError):  # other systems: at least no more than there is
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return _UNKNOWN


def _of_container() -> int:
    """What the limit of a container or of a cluster's job leaves."""
    with suppress(OSError, ValueError, StopIteration):  # "max" where there is no limit
        texts = [
            (_GROUP / f"memory.{name}").read_text(encoding="ascii") for name in ("max", "current", "stat")
        ]
        limit, used, lines = int(texts[0]), int(texts[1]), texts[2].splitlines()
        given_back = next(int(line.split()[1]) for line in lines if line.startswith("inactive_file "))
        return limit - used + given_back
    return _UNKNOWN


def _of_process() -> int:
    """What `ulimit -v` leaves."""
    with suppress(ImportError, OSError, ValueError, IndexError):
        import resource

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
        if limit != resource.RLIM_INFINITY:
            pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
            return limit - pages * os.sysconf("SC_PAGE_SIZE")
    return _UNKNOWN
