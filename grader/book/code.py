"""A block of code as HTML: highlighted source, or a terminal with commands and their output."""

from __future__ import annotations

from typing import TYPE_CHECKING

from markupsafe import Markup, escape

from grader.report.coloured_code import coloured

if TYPE_CHECKING:
    from collections.abc import Iterator

CONSOLE = "console"
PROMPT = "$ "
_NAMES = {"": "Text", "toml": "TOML", "xml": "XML", "python": "Python", "bash": "Shell", CONSOLE: "Terminal"}


def code_html(text: str, language: str) -> str:
    """Return the HTML of a block.

    A script adds a button that copies the code. For terminal blocks, the button copies only the commands.
    """
    text = text.rstrip("\n")
    lines = _console(text) if language == CONSOLE else _source(text, language)
    name = _NAMES.get(language, language)
    kind = " console" if language == CONSOLE else ""
    frame = Markup('<div class="code{}"><pre tabindex="0" role="group" aria-label="{}"><code>{}</code></pre></div>\n')
    return str(frame.format(kind, name, Markup("\n").join(lines)))


def _source(text: str, language: str) -> Iterator[Markup]:
    for line in coloured(text, language or "text"):
        yield Markup("").join(
            Markup('<span class="{}">{}</span>').format(*each) if each[0] else escape(each[1]) for each in line
        )


def _console(text: str) -> Iterator[Markup]:
    """Yield the HTML of each line: commands are kbd elements, and output lines are samp elements."""
    continues = False
    for line in text.split("\n"):
        if continues or line.startswith(PROMPT):
            prompt = "" if continues else Markup('<span class="prompt" aria-hidden="true">{}</span>').format(PROMPT)
            yield Markup("{}<kbd>{}</kbd>").format(prompt, line if continues else line.removeprefix(PROMPT))
            continues = line.endswith("\\")
        else:
            yield Markup("<samp>{}</samp>").format(line) if line else Markup()
