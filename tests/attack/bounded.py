"""What the attacks share: how long they last, how they are drawn, and a limit of time for each call."""

import os
import random
import signal
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from contextlib import contextmanager

#: How long an attack lasts in all; `make attack SECONDS=600` sets it.
SECONDS = float(os.environ.get("FLEXAPOD_ATTACK_SECONDS", "3"))
#: Whether a run is one of all tests: then a fast machine draws no more than has been drawn before.
AMONG_TESTS = "FLEXAPOD_ATTACK_SECONDS" not in os.environ
#: What is drawn: the same in every run of the tests.
SEED = int(os.environ.get("FLEXAPOD_ATTACK_SEED", "1"))
#: What was tried in this run, by attack: how often it came to what.
TRIED: defaultdict[str, Counter[str]] = defaultdict(Counter)
#: s of one call: far more than any needs, so that only what never ends reaches it. The first is of processor time, which
#: does not run on while other programs have the machine; the second is for what waits and does nothing meanwhile.
LIMIT, WAIT = 60, 900
IDLE = 0.01  #: of the time waited: who had less of the processor than this does nothing


class Hang(BaseException):
    """A call that did not end. No Exception, so that nothing takes it for a failed attempt."""


@contextmanager
def limited(seconds: float = LIMIT, wait: float = WAIT) -> Iterator[None]:
    """Raises Hang in a call that computes, or waits and does nothing, for longer; only where signals can be used."""
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield
        return

    used = time.process_time()

    def end(number, frame):
        nonlocal used
        before, used = used, time.process_time()
        if number == signal.SIGALRM and used - before > IDLE * wait:  # it works, on a machine that others use too
            signal.setitimer(signal.ITIMER_REAL, wait)
            return
        raise Hang

    timers = {signal.SIGPROF: (signal.ITIMER_PROF, seconds), signal.SIGALRM: (signal.ITIMER_REAL, wait)}
    before = {number: signal.signal(number, end) for number in timers}
    for timer, limit in timers.values():
        signal.setitimer(timer, limit)
    try:
        yield
    finally:
        for timer, _ in timers.values():
            signal.setitimer(timer, 0)
        for number, handler in before.items():
            signal.signal(number, handler)


def rounds(share: float, name: str, most: int = 30) -> Iterator[random.Random]:
    """A source of draws for each attack, for a share of the time; the same for a name in every run.

    most: how many there are at most among all tests, whose outcome must not depend on how fast the machine is.
    """
    end = time.monotonic() + share * SECONDS
    number = 0
    least = 1 if AMONG_TESTS else 3
    while number < least or (time.monotonic() < end and not (AMONG_TESTS and number >= most)):
        yield random.Random(f"{SEED} {name} {number}")
        number += 1


def tried(attack: str, outcome: str, count: int = 1) -> None:
    """Take down an attack that ended as it should, for the table at the end of `make attack`."""
    TRIED[attack][outcome] += count
