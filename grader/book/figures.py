"""The places of the interactive figures in the lessons. figures.js draws them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Figure:
    """A figure of figures.js at the end of the section with this anchor."""

    name: str
    anchor: str


FIGURES = {
    "03-circle-publisher": Figure("circle", "how-fast-how-often"),
    "06-pose-subscriber": Figure("frames", "where-it-is-and-how-far-it-has-come"),
    "07-challenges": Figure("goal", "d-a-drive-to-a-goal"),
    "09-parameters": Figure("radius", "reject-a-value"),
}
"""The figures by step. A figure whose section does not exist is at the end of the lesson."""


def figure_html(figure: Figure) -> str:
    """Return the element for the figure. The script draws the figure in this element."""
    return f'<figure class="explore" data-figure="{figure.name}" hidden></figure>\n'
