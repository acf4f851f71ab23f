"""The command `grader book`: the lessons as static pages."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

PANEL = "Teach"
Out = Annotated[Path, typer.Argument(help="The folder for the pages.", metavar="OUT")]


def add_to(app: typer.Typer) -> None:
    """Add the command `grader book` to the typer application `app`."""
    app.command(rich_help_panel=PANEL, epilog="Example: grader book build/book")(book)


def book(
    out: Out,
    repository: Annotated[
        str, typer.Option(help="The URL of your course's repository, to which each page links.", metavar="URL")
    ] = "",
) -> None:
    """Write the lessons as static pages. The pages load nothing from other sites, and any web server can serve them."""
    from grader.book.site import write_book
    from grader.common.words import count

    amount = write_book(out, _checked(repository))
    typer.echo(f"{count(amount, 'lesson')}: {out / 'index.html'}")


def _checked(repository: str) -> str:
    from grader.errors import UsageError

    if repository and not repository.startswith(("https://", "http://")):
        message = f"--repository needs a URL that begins with https:// or http://, not {repository!r}."
        raise UsageError(message)
    return repository
