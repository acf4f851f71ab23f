"""Progress: what is being done, on standard error, so that the report can be piped."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator


@dataclass(frozen=True)
class Progress:
    """`tell` says what is being done, `keep` what was found and stays to be read."""

    tell: Callable[[str], None]
    keep: Callable[[str], None]

    def __call__(self, text: str) -> None:
        """Say what is being done."""
        self.tell(text)

    def keep_all(self, lines: Iterable[str]) -> None:
        """Say what stays, line by line."""
        for line in lines:
            self.keep(line)


@contextmanager
def progress() -> Iterator[Progress]:
    """Tell what is being done: one live line on a terminal, plain lines elsewhere."""
    if not sys.stderr.isatty():

        def line(text: str) -> None:
            print(text, file=sys.stderr, flush=True)

        yield Progress(lambda text: line(f"{text} ..."), line)
        return
    from rich.console import Console
    from rich.text import Text

    console = Console(stderr=True, highlight=False)
    with console.status("Starting", spinner="dots") as status:
        yield Progress(lambda text: status.update(f"{text} ..."), lambda text: console.print(Text(text)))
