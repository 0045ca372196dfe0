"""Waiting for what comes in its own time: tests wait as long as it takes, and say what did not come."""

import time
from typing import Any


def until(met: Any, seconds: float = 30.0) -> bool:
    """Whether a condition is met within some seconds."""
    end = time.monotonic() + seconds
    while not met():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True
