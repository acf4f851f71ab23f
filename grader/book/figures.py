"""The places in the lessons where figures.js draws interactive figures."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Figure:
    """An interactive figure that figures.js draws below the text of the section with this anchor."""

    name: str
    anchor: str


FIGURES = {
    "03-circle-publisher": Figure("circle", "how-fast-how-often"),
    "06-pose-subscriber": Figure("frames", "where-it-is-and-how-far-it-has-come"),
    "07-challenges": Figure("goal", "d-a-drive-to-a-goal"),
    "09-parameters": Figure("radius", "reject-a-value"),
}
"""The figures by step. If the section does not exist, the figure is placed at the end of the lesson."""


def figure_html(figure: Figure) -> str:
    """Return the HTML element in which figures.js draws the figure."""
    return f'<figure class="explore" data-figure="{figure.name}" hidden></figure>\n'
