"""`%lesson`: show the lesson of the notebook's step, or of the named step, below the cell."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

_IMAGE = re.compile(r"^!\[[^\]]*\]\(([^)\s]+)\)\s*$", re.MULTILINE)
_LOCAL_LINK = re.compile(r"(?<!!)\[([^\]]+)\]\((?!https?://|#)[^)\s]+\)")


def pieces(lesson: Path) -> list[str | Path]:
    """Return the lesson as a sequence of Markdown texts and image files.

    Links to other files become plain text, because they would not work in a notebook that is copied without those
    files.
    """
    # `split` returns texts and the paths of images in turn.
    split = _IMAGE.split(lesson.read_text(encoding="utf-8"))
    found: list[str | Path] = []
    for number, text in enumerate(split):
        if number % 2:
            found.append(lesson.parent / text)
        elif text.strip():
            found.append(_LOCAL_LINK.sub(r"\1", text))
    return found


def show(lesson: Path) -> None:
    """Show the lesson below the cell."""
    from IPython.display import SVG, Image, Markdown, display

    for piece in pieces(lesson):
        if isinstance(piece, str):
            display(Markdown(piece))  # type: ignore[no-untyped-call, unused-ignore]
        elif piece.suffix == ".svg":
            display(SVG(filename=str(piece)))  # type: ignore[no-untyped-call, unused-ignore]
        else:
            display(Image(filename=str(piece)))  # type: ignore[no-untyped-call, unused-ignore]
