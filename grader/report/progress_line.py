"""Show the progress on standard error, so that the report on standard output can be piped."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator


@dataclass(frozen=True)
class Progress:
    """Two functions: `tell` shows what the grader is doing, and `keep` shows a line until the report appears.

    Calling the object is the same as calling `tell`:

        with progress() as tell:
            tell("Building with colcon")
    """

    tell: Callable[[str], None]
    keep: Callable[[str], None]

    def __call__(self, text: str) -> None:
        """Show what the grader is doing."""
        self.tell(text)

    def keep_all(self, lines: Iterable[str]) -> None:
        """Show lines until the report appears."""
        for line in lines:
            self.keep(line)


@contextmanager
def progress() -> Iterator[Progress]:
    """Yield a Progress, which shows live lines on a terminal, or prints plain lines elsewhere."""
    if not sys.stderr.isatty():

        def line(text: str) -> None:
            print(text, file=sys.stderr, flush=True)

        yield Progress(lambda text: line(f"{text} ..."), line)
        return
    from rich.console import Console
    from rich.text import Text

    console = Console(stderr=True, highlight=False)
    with console.status("Starting", spinner="dots") as status:
        kept: list[str] = []

        def tell(text: str) -> None:
            status.update(Text("\n".join([f"{text} ...", *kept])))

        def keep(text: str) -> None:
            kept.append(text)
            tell("Starting")

        yield Progress(tell, keep)
