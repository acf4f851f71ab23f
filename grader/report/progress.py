"""Progress: what is being done, on standard error, so that the report can be piped."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


@contextmanager
def progress() -> Iterator[Callable[[str], None]]:
    """Give a function that tells what is being done: one live line on a terminal, plain lines elsewhere."""
    if not sys.stderr.isatty():
        yield lambda text: print(f"{text} ...", file=sys.stderr, flush=True)
        return
    from rich.console import Console

    with Console(stderr=True, highlight=False).status("Starting", spinner="dots") as status:
        yield lambda text: status.update(f"{text} ...")
