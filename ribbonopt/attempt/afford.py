"""Whether there is memory for a program, before it is built: what it needs, and what there is.

The dense blocks of all elements are what counts. Measured on collocation of degree 3 to 10, on 500
to 10,000 intervals: Newton's method keeps 5 blocks an element, IPOPT's sparse functions 36.
"""

from __future__ import annotations

import os
from pathlib import Path

from ribbonopt.errors import ModelError
from ribbonopt.transcription import NLP

BLOCKS, SPARSE_BLOCKS = 5, 36
SMALL = 1 << 28  # bytes that any program may take without a look at what there is
GIGA = 1e9
#: bytes that IPOPT's own linear algebra takes at once; where they are refused it tries for ever
LIBRARIES = 200_000_000


class TooLargeError(ModelError):
    """A program that needs more memory than there is."""


def refuse_unaffordable(nlp: NLP, *, sparse: bool) -> None:
    """Raise a TooLargeError, exit status 2, where a program needs more memory than there is.

    `sparse` says whether it is solved by its sparse functions, as IPOPT does.
    """
    room = _of_process() if sparse else None
    if room is not None and room < LIBRARIES:
        raise TooLargeError(
            f"IPOPT needs {LIBRARIES / 1e6:.0f} MB of memory to begin, and the limit of this "
            f"process (ulimit -v) leaves {room / 1e6:.0f} MB; raise it"
        )
    needed = bytes_needed(nlp, sparse=sparse)
    if needed < SMALL:
        return
    there = bytes_there()
    if there is not None and needed > there:
        count = nlp.layout.element_count
        raise TooLargeError(
            f"transcription: {nlp.unknowns:,} unknowns on {count:,} intervals need about "
            f"{needed / GIGA:.1f} GB of memory, and there are {there / GIGA:.1f} GB; choose fewer "
            f"intervals, such as {max(1, int(count * there / needed / 2)):,}, or a lower degree",
            "transcription.intervals",
        )


def bytes_needed(nlp: NLP, *, sparse: bool) -> int:
    """Return about how many bytes solving a program takes at its most."""
    layout = nlp.layout
    block = 8 * layout.element_unknowns * layout.element_equations
    return layout.element_count * block * (SPARSE_BLOCKS if sparse else BLOCKS)


def bytes_there() -> int | None:
    """Return the bytes that this process may still take; None where the system does not say.

    The least of what is free, what its control group leaves it and what `ulimit -v` does.
    """
    found = [_free(), _of_group(), _of_process()]
    return min((size for size in found if size is not None), default=None)


def _free() -> int | None:
    for line in _lines("/proc/meminfo"):
        if line.startswith("MemAvailable:"):
            return 1024 * int(line.split()[1])
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):  # not on Windows
        return None


def _of_group(root: str = "/sys/fs/cgroup") -> int | None:
    """Return what the control group of a container or of a cluster's job leaves."""
    own = [line.rpartition(":")[2] for line in _lines("/proc/self/cgroup")]
    folders = [Path(root + path) for path in own] + [Path(root), Path(root, "memory")]
    names = ("memory.max", "memory.current"), ("memory.limit_in_bytes", "memory.usage_in_bytes")
    left = []
    for folder in folders:
        for most, used in names:
            sizes = [*_lines(folder / most), *_lines(folder / used)]
            if len(sizes) == 2 and all(size.isdigit() for size in sizes):
                left.append(max(0, int(sizes[0]) - int(sizes[1])))
    return min(left, default=None)


def _of_process() -> int | None:
    try:
        import resource
    except ImportError:  # Windows
        return None
    most, _ = resource.getrlimit(resource.RLIMIT_AS)
    pages = "".join(_lines("/proc/self/statm")).split()
    if most == resource.RLIM_INFINITY or not pages:
        return None
    return max(0, most - int(pages[0]) * resource.getpagesize())


def _lines(path: str | Path) -> list[str]:
    try:
        return Path(path).read_text().splitlines()
    except (OSError, ValueError):
        return []
