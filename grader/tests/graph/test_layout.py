"""Pictures drawn by Graphviz. The text is read from the SVG and measured with the font that the SVG names."""

from __future__ import annotations

import io
import itertools
import re
import subprocess
from dataclasses import dataclass
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

import matplotlib as mpl
import pytest
from PIL import Image, ImageFont

from grader.errors import MachineError
from grader.graph.graph import Show, picture, to_dot
from grader.graph.layout import render
from grader.tests.graph.graphs import ten_nodes, tutorial

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.trial.recording import Graph

SVG = "{http://www.w3.org/2000/svg}"
GRAPHS = [tutorial, ten_nodes]
FONT = ImageFont.truetype(f"{mpl.get_data_path()}/fonts/ttf/DejaVuSans.ttf", 100)


@dataclass(frozen=True)
class Box:
    left: float
    top: float
    right: float
    bottom: float

    def overlaps(self, other: Box) -> bool:
        return (
            self.left < other.right and other.left < self.right and self.top < other.bottom and other.top < self.bottom
        )

    def holds(self, other: Box) -> bool:
        return (
            self.left <= other.left
            and other.right <= self.right
            and self.top <= other.top
            and other.bottom <= self.bottom
        )


@dataclass(frozen=True)
class Shape:
    name: str
    ellipse: bool
    box: Box
    texts: tuple[Box, ...]


def shapes(svg: bytes) -> list[Shape]:
    root = ET.fromstring(svg)
    return [_shape(group) for group in root.iter(f"{SVG}g") if group.get("class") == "node"]


def _shape(group: ET.Element) -> Shape:
    title = group.findtext(f"{SVG}title") or ""
    texts = tuple(_text(text) for text in group.iter(f"{SVG}text"))
    ellipse = group.find(f"{SVG}ellipse")
    if ellipse is not None:
        x, y, across, down = (float(ellipse.get(key, "nan")) for key in ("cx", "cy", "rx", "ry"))
        return Shape(title, True, Box(x - across, y - down, x + across, y + down), texts)  # noqa: FBT003
    polygon = group.find(f"{SVG}polygon")
    assert polygon is not None
    numbers = [float(number) for number in re.findall(r"-?[\d.]+", polygon.get("points", ""))]
    xs, ys = numbers[::2], numbers[1::2]
    return Shape(title, False, Box(min(xs), min(ys), max(xs), max(ys)), texts)  # noqa: FBT003


def _text(text: ET.Element) -> Box:
    size = float(text.get("font-size", "nan"))
    x, y = float(text.get("x", "nan")), float(text.get("y", "nan"))
    half = FONT.getlength(text.text or "") * size / 100 / 2
    return Box(x - half, y - 0.8 * size, x + half, y + 0.25 * size)


def drawn(graph: Graph, show: Show | None = None) -> str:
    return to_dot(picture(graph.nodes, graph.endpoints, show))


@pytest.mark.parametrize("graph", GRAPHS)
@pytest.mark.parametrize("show", [Show(), Show(debug=True, hidden=True)])
def test_text_stays_in_its_shape_and_shapes_apart(graph: Callable[[], Graph], show: Show) -> None:
    placed = shapes(render(drawn(graph(), show), "svg"))
    assert len(placed) >= 5
    for shape in placed:
        assert shape.texts
        assert all(shape.box.holds(text) for text in shape.texts), shape
    assert [(a.name, b.name) for a, b in itertools.combinations(placed, 2) if a.box.overlaps(b.box)] == []


def test_nodes_are_ellipses_topics_are_boxes_and_arrows_lead_from_left_to_right() -> None:
    svg = render(drawn(tutorial()), "svg")
    placed = {shape.name: shape for shape in shapes(svg)}
    assert {name for name, shape in placed.items() if shape.ellipse} == {"/draw_circle", "/turtlesim"}
    path = [placed[name].box for name in ("/draw_circle", "/turtle1/cmd_vel", "/turtlesim", "/turtle1/pose")]
    assert all(a.right < b.left for a, b in itertools.pairwise(path))


def test_a_png_is_a_picture_of_the_same_shape() -> None:
    png = Image.open(io.BytesIO(render(drawn(tutorial()), "png")))
    svg = ET.fromstring(render(drawn(tutorial()), "svg"))
    width, height = (float(svg.get(side, "0").removesuffix("pt")) for side in ("width", "height"))
    # 144 pixels per inch, 72 points per inch
    assert png.width == pytest.approx(2 * width, abs=4)
    assert png.height == pytest.approx(2 * height, abs=4)


def test_invalid_dot_is_a_machine_error() -> None:
    with pytest.raises(MachineError, match="could not be drawn"):
        render("digraph {", "svg")


def test_a_graphviz_that_prints_nothing_leaves_no_empty_parentheses(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(subprocess, "run", lambda argv, **_: subprocess.CompletedProcess(argv, -11, b"", b""))
    with pytest.raises(MachineError, match=r"could not be drawn \(no message\)"):
        render("digraph {}", "svg")
