"""Draw a scene as an SVG picture. This module also contains the SVG helpers for the charts.

Colours and sizes are attributes, never styles, because the Content-Security-Policy of a page may forbid styles, and a
picture must also look right outside a page (in a notebook). `currentColor` is the text colour, so the picture
adapts to light and dark mode.
"""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING

from grader.common.words import printable
from grader.report.shapes import DEEP, LOOKS, SEA, SIDE_M, Line, Point, Rgb, Ring, Role

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.report.scene import Scene
    from grader.report.shapes import Arrow

Attribute = str | float | None

SIDE = 500.0
"""The side length of the canvas in the picture."""
LEFT, TOP, RIGHT, BOTTOM = 60.0, 10.0, 10.0, 46.0
"""The width of the margins around the canvas."""
FARTHEST = 1e5
"""Larger coordinates are clamped to this value, because browsers store coordinates with limited precision."""


def tag(name: str, *children: str, **attributes: Attribute) -> str:
    """Return an SVG element. `children` are strings of SVG.

    Attribute values are escaped, and "_" in attribute names becomes "-".

        tag("circle", cx=1, cy=2, stroke_width=0.5)  # <circle cx="1" cy="2" stroke-width="0.5"/>
    """
    given = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{_value(value)}"'
        for key, value in attributes.items()
        if value is not None
    )
    return f"<{name}{given}>{''.join(children)}</{name}>" if children else f"<{name}{given}/>"


def _value(value: str | float) -> str:
    return escape(value) if isinstance(value, str) else coordinate(value)


def coordinate(value: float) -> str:
    """Format a number for SVG: at most two decimals, and never infinity."""
    if not math.isfinite(value):
        value = 0.0 if math.isnan(value) else math.copysign(FARTHEST, value)
    return f"{min(max(value, -FARTHEST), FARTHEST):.2f}".rstrip("0").rstrip(".")


def words(text: str, x: float, y: float, anchor: str = "start", **attributes: Attribute) -> str:
    """Return a text element. The content of the element becomes one line of plain text."""
    given: dict[str, Attribute] = {"fill": "currentColor", "text_anchor": anchor, **attributes}
    return tag("text", escape(printable(text)), x=x, y=y, **given)


def rgb(color: Rgb) -> str:
    """Return a colour in CSS notation."""
    return "#{:02x}{:02x}{:02x}".format(*color)


def points(of: Iterable[Point]) -> str:
    """Return the coordinates for a polyline or a polygon."""
    return " ".join(f"{coordinate(x)},{coordinate(y)}" for x, y in of)


def picture(*children: str, width: float, height: float, title: str, key: str, name: str, about: str = "") -> str:
    """Return a complete picture that scales with its page.

    `key` is the kind of picture (a CSS class), and `name` makes the ids of the picture unique.
    """
    named = [tag("title", escape(printable(title)), id=f"picture-{name}-title")]
    if about:
        named.append(tag("desc", escape(printable(about)), id=f"picture-{name}-about"))
    return tag(
        "svg",
        *named,
        *children,
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {coordinate(width)} {coordinate(height)}",
        role="img",
        aria_labelledby=f"picture-{name}-title",
        aria_describedby=f"picture-{name}-about" if about else None,
        font_family="system-ui, sans-serif",
        font_size=13,
        class_=f"picture {key}",
    )


def pixel(point: Point) -> Point:
    """Return the position in the picture for a point on the canvas (m)."""
    scale = SIDE / SIDE_M
    return LEFT + point[0] * scale, TOP + SIDE - point[1] * scale


def scene_svg(scene: Scene, *, turtle: bool = False, name: str = "canvas") -> str:
    """Draw the canvas with its axes. `turtle` adds a turtle that a player can move, and the path behind that turtle."""
    scale = SIDE / SIDE_M
    shapes = "".join(_shape(shape, scale) for shape in scene.shapes)
    inside = [tag("rect", x=LEFT, y=TOP, width=SIDE, height=SIDE, fill=rgb(SEA)), tag("g", shapes)]
    if turtle:
        inside.append(_turtle())
    clip = tag("clipPath", tag("rect", x=LEFT, y=TOP, width=SIDE, height=SIDE), id=f"{name}-edge")
    canvas = tag("g", *inside, clip_path=f"url(#{name}-edge)")
    notice = _notice(scene.notice) if scene.notice else ""
    return picture(
        tag("defs", clip),
        canvas,
        _axes(),
        notice,
        width=LEFT + SIDE + RIGHT,
        height=TOP + SIDE + BOTTOM,
        title="The trajectory of the turtle on its canvas, 11 m by 11 m",
        about=". ".join([*([scene.notice] if scene.notice else []), *(text for _, text in scene.legend), *scene.facts]),
        key="canvas",
        name=name,
    )


def _shape(shape: Line | Ring | Arrow, scale: float) -> str:
    look = shape.look if isinstance(shape, Line) else LOOKS[shape.role]
    width, color = max(look.width_m * scale, 1.0), rgb(look.color)
    dash = look.dash_m * scale
    dashes = f"{coordinate(dash)} {coordinate(dash * 0.8)}" if dash else None
    if isinstance(shape, Line):
        return tag(
            "polyline",
            points=points(map(pixel, shape.points)),
            fill="none",
            stroke=color,
            stroke_width=width,
            stroke_dasharray=dashes,
            stroke_linecap="round" if dashes is None else None,
            stroke_linejoin="round",
            class_=shape.role,
        )
    if isinstance(shape, Ring):
        x, y = pixel(shape.centre)
        return tag(
            "circle",
            cx=x,
            cy=y,
            r=shape.radius * scale,
            fill="none",
            stroke=color,
            stroke_width=width,
            stroke_dasharray=dashes,
            class_=shape.role,
        )
    corners = points(map(pixel, shape.corners))
    return tag("polygon", points=corners, fill=color, stroke=rgb(DEEP), class_=shape.role)


def _axes() -> str:
    """Draw the scale in metres along the left and bottom edges, with a number at every second metre."""
    marks = []
    for metre in range(12):
        x, y = pixel((metre, metre))
        marks.append(tag("path", d=f"M{coordinate(x)} {coordinate(TOP + SIDE)}v5", stroke="currentColor"))
        marks.append(tag("path", d=f"M{coordinate(LEFT)} {coordinate(y)}h-5", stroke="currentColor"))
        if metre % 2 == 0:
            marks.append(words(str(metre), x, TOP + SIDE + 22, "middle"))
            marks.append(words(str(metre), LEFT - 10, y + 5, "end"))
    marks.append(words("x (m)", LEFT + SIDE, TOP + SIDE + 40, "end"))
    marks.append(words("y (m)", 2, TOP + 14))
    return tag("g", *marks, class_="axes", font_size=16)


def _notice(text: str) -> str:
    middle, y = LEFT + SIDE / 2, TOP + SIDE * 0.72
    width = 9.3 * len(text) + 30
    return tag(
        "g",
        tag("rect", x=middle - width / 2, y=y - 26, width=width, height=38, fill=rgb(DEEP), rx=4),
        words(text, middle, y, "middle", fill="#ffffff", font_size=17),
        class_="notice",
    )


def _turtle() -> str:
    """Return the drawing of a turtle at the origin that faces east.

    The drawing is hidden until a script shows and moves it.
    """
    shell = tag("ellipse", rx=15, ry=12, fill="#2f7d32", stroke="#ffffff", stroke_width=1.5)
    pattern = tag("path", d="M-6-7 L5-7 L10 0 L5 7 L-6 7 L-10 0Z", fill="none", stroke="#b9e6a5", stroke_width=1.5)
    skin: dict[str, Attribute] = {"fill": "#7cc576", "stroke": "#ffffff", "stroke_width": 1}
    head = tag("ellipse", cx=19, cy=0, rx=6, ry=5, **skin)
    legs = [tag("ellipse", cx=x, cy=y, rx=5, ry=4, **skin) for x in (-9, 9) for y in (-12, 12)]
    tail = tag("path", d="M-21 0 L-14-2.5 L-14 2.5Z", **skin)
    eyes = [tag("circle", cx=21, cy=y, r=1.2, fill=rgb(DEEP)) for y in (-2, 2)]
    gone = tag(
        "polyline", class_="gone", points="", fill="none", stroke="#ffffff", stroke_width=4, stroke_linejoin="round"
    )
    return gone + tag("g", tail, *legs, head, *eyes, shell, pattern, class_="turtle", visibility="hidden")


def sign(role: Role) -> str:
    """Return the legend symbol for a role. The symbol looks the same as on the canvas."""
    color, water = rgb(LOOKS[role].color), tag("rect", width=46, height=26, rx=3, fill=rgb(SEA))
    stroke: dict[str, Attribute] = {"stroke": color, "stroke_width": 4, "fill": "none"}
    trajectory = tag("path", d="M5 13H41", **{**stroke, "stroke": rgb(LOOKS["trajectory"].color)})
    drawn = {
        "trajectory": trajectory,
        "tick": trajectory + tag("path", d="M23 5V21", **{**stroke, "stroke_width": 2.5}),
        "other": tag("path", d="M5 13H41", **{**stroke, "stroke_width": 3}),
        "start": tag("polygon", points="34,13 14,21 19,13 14,5", fill=color),
        "wall": tag("path", d="M16 6L30 20M16 20L30 6", **stroke),
    }.get(role, tag("path", d="M6 13h8m5 0h8m5 0h8", **{**stroke, "stroke_width": 3}))
    return tag("svg", water, drawn, viewBox="0 0 46 26", width=46, height=26, aria_hidden="true", class_="sign")
