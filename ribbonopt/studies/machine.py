"""What times depend on besides the versions."""

from __future__ import annotations

import os
import platform
from typing import Any


def machine() -> dict[str, Any]:
    """Processor, number of processors and system."""
    return {
        "processor": platform.processor() or platform.machine(),
        "cpus": cores(),
        "system": platform.system(),
    }


def cores() -> int:
    """Processors that this process may use: queues and `taskset` give away less than there are."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1  # macOS and Windows do not tell
