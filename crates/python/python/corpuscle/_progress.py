"""Progress of long work."""

from __future__ import annotations

import sys
import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Report = Callable[[float, float, int, float, "float | None"], Any]


@contextmanager
def reporter(progress: bool | Report) -> Iterator[Report | None]:
    """A function that is called with the progress: the caller's own, a bar of `tqdm`, or lines on standard error."""
    if not progress:
        yield None
    elif callable(progress):
        yield progress
    else:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            yield _lines()
            return
        bar = tqdm(total=1.0, bar_format="{l_bar}{bar}| {elapsed}{postfix}")

        def show(time: float, until: float, particles: int, rate: float, left: float | None) -> None:
            bar.n = min(time / until, 1.0)
            bar.set_postfix_str(f"t = {time:g} of {until:g}, {particles} particles{_left(left)}")

        try:
            yield show
        finally:
            bar.close()


def _left(left: float | None) -> str:
    return "" if left is None else f", {left:.0f} s left"


def _lines() -> Report:
    shown = clock.monotonic()

    def show(time: float, until: float, particles: int, rate: float, left: float | None) -> None:
        nonlocal shown
        if clock.monotonic() - shown > 5.0:
            shown = clock.monotonic()
            print(f"t = {time:g} of {until:g}, {particles} particles{_left(left)}", file=sys.stderr)

    return show
