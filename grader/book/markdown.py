"""Convert the Markdown of a lesson to HTML: highlighted code, terminals, figures, tables and links between steps."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from markdown_it import MarkdownIt
from markdown_it.token import Token
from markupsafe import escape

from grader.book.code import code_html
from grader.book.figures import figure_html

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from markdown_it.renderer import RendererHTML
    from markdown_it.utils import EnvType, OptionsDict

    from grader.book.figures import Figure

PAGE = "index.html"
"""The name of a lesson's page, inside the folder of its step."""
_LESSON_LINK = re.compile(r"^(\.\./[\w-]+/)lesson\.md(#.*)?$")
_NEIGHBOURS = re.compile(r"(Previous|Next): ")


@dataclass(frozen=True)
class Section:
    """A heading with its level (2 or 3) and its anchor, and the plain text below it for the search index.

    The first section is that of the lesson's title, which has the level 1 and the anchor "".
    """

    level: int
    title: str
    anchor: str
    text: str


@dataclass(frozen=True)
class Rendered:
    """A Markdown file as HTML. The title is not part of the HTML."""

    title: str
    html: str
    sections: tuple[Section, ...]
    pictures: tuple[str, ...]


def rendered(text: str, figure: Figure | None = None) -> Rendered:
    """Return the HTML of a lesson, with an element for a figure. HTML in the Markdown is shown as text."""
    markdown = _parser()
    tokens = _without_neighbours(markdown.parse(text))
    title, tokens = _title(tokens)
    _add_anchors(tokens)
    _link(tokens)
    pictures = tuple(str(token.attrs["src"]) for token in _inner(tokens) if token.type == "image")
    if figure is not None:
        tokens = _with_figure(tokens, figure)
    html = markdown.renderer.render(tokens, markdown.options, {})
    return Rendered(title, html, tuple(_sections(tokens, title)), pictures)


def anchor_of(title: str) -> str:
    """Return the anchor of a heading, as on GitHub."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def _parser() -> MarkdownIt:
    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    markdown.add_render_rule("fence", _fence)
    markdown.add_render_rule("code_block", _fence)
    markdown.add_render_rule("image", _image)
    markdown.add_render_rule("table_open", _table_open)
    markdown.add_render_rule("table_close", _table_close)
    markdown.add_render_rule("th_open", _th_open)
    markdown.add_render_rule("th_close", _th_close)
    return markdown


# --- rules of the renderer, which is their first argument ---------------------------------------------------------


def _fence(_: RendererHTML, tokens: Sequence[Token], at: int, _options: OptionsDict, _env: EnvType) -> str:
    words = tokens[at].info.split()
    return code_html(tokens[at].content, words[0] if words else "")


def _image(_: RendererHTML, tokens: Sequence[Token], at: int, _options: OptionsDict, _env: EnvType) -> str:
    # The caption also describes the picture to screen readers. The paragraph around the picture becomes the figure.
    token = tokens[at]
    return (
        f'<img src="{escape(str(token.attrs["src"]))}" alt="" loading="lazy">'
        f"<figcaption>{escape(token.content)}</figcaption>"
    )


def _table_open(_: RendererHTML, _tokens: Sequence[Token], _at: int, _options: OptionsDict, _env: EnvType) -> str:
    return '<div class="wide" tabindex="0" role="group" aria-label="Table">\n<table>\n'


def _table_close(_: RendererHTML, _tokens: Sequence[Token], _at: int, _options: OptionsDict, _env: EnvType) -> str:
    return "</table>\n</div>\n"


def _th_open(_: RendererHTML, tokens: Sequence[Token], at: int, _options: OptionsDict, _env: EnvType) -> str:
    # A header without text is not a header for a screen reader.
    return '<th scope="col">' if tokens[at + 1].content else "<td>"


def _th_close(_: RendererHTML, tokens: Sequence[Token], at: int, _options: OptionsDict, _env: EnvType) -> str:
    return "</th>\n" if tokens[at - 1].content else "</td>\n"


# --- changes to the tokens ------------------------------------------------------------------------------------------


def _without_neighbours(tokens: list[Token]) -> list[Token]:
    """Remove the links to the neighbouring steps at the end, and the line above them: the page has its own links."""
    if len(tokens) > 3 and tokens[-2].type == "inline" and _NEIGHBOURS.match(tokens[-2].content):
        tokens = tokens[:-3]
        if tokens[-1].type == "hr":
            tokens = tokens[:-1]
    return tokens


def _title(tokens: list[Token]) -> tuple[str, list[Token]]:
    if tokens and tokens[0].type == "heading_open" and tokens[0].tag == "h1":
        return _plain(tokens[1]), tokens[3:]
    return "", tokens


def _add_anchors(tokens: list[Token]) -> None:
    used: set[str] = set()
    for opening, inline in pairwise(tokens):
        if opening.type == "heading_open":
            anchor = base = anchor_of(_plain(inline))
            number = 0
            while anchor in used:
                number += 1
                anchor = f"{base}-{number}"
            used.add(anchor)
            opening.attrSet("id", anchor)


def _link(tokens: list[Token]) -> None:
    """Change links to lessons into links to pages, and each paragraph that is only a picture into a figure."""
    for token in _inner(tokens):
        if token.type == "link_open":
            token.attrSet("href", _LESSON_LINK.sub(rf"\1{PAGE}\2", str(token.attrs["href"])))
    for opening, inline, closing in zip(tokens, tokens[1:], tokens[2:], strict=False):
        only = inline.children or []
        if opening.type == "paragraph_open" and len(only) == 1 and only[0].type == "image":
            opening.tag = closing.tag = "figure"


def _with_figure(tokens: list[Token], figure: Figure) -> list[Token]:
    """Insert the figure before the next heading after its anchor, or at the end of the lesson if there is none."""
    begin = next((at for at, token in enumerate(tokens) if token.attrs.get("id") == figure.anchor), len(tokens))
    heads = (at for at, token in enumerate(tokens) if at > begin and token.type == "heading_open")
    end = next(heads, len(tokens))
    return [*tokens[:end], Token("html_block", "", 0, content=figure_html(figure)), *tokens[end:]]


def _inner(tokens: list[Token]) -> Iterator[Token]:
    for token in tokens:
        yield from token.children or []


def _sections(tokens: list[Token], title: str) -> Iterator[Section]:
    """Yield a section for the lesson's title and the text before the first heading, then one per h2 and h3."""
    level, heading, anchor = 1, title, ""
    texts: list[str] = []
    heads = {id(inline) for opening, inline in pairwise(tokens) if _begins_section(opening)}
    for token in tokens:
        if _begins_section(token):
            yield Section(level, heading, anchor, " ".join(texts))
            level, anchor, texts = int(token.tag[1:]), str(token.attrs["id"]), []
        elif id(token) in heads:
            heading = _plain(token)
        elif token.type == "inline":
            texts.append(_plain(token))
        elif token.type in ("fence", "code_block"):
            texts.append(" ".join(token.content.split()))
    yield Section(level, heading, anchor, " ".join(texts))


def _begins_section(token: Token) -> bool:
    return token.type == "heading_open" and token.tag in ("h2", "h3")


def _plain(inline: Token) -> str:
    """Return the text of a paragraph or heading without its markup."""
    breaks = ("softbreak", "hardbreak")
    return "".join(" " if each.type in breaks else each.content for each in inline.children or [])
