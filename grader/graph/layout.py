"""Draw a graph in DOT with Graphviz, with the same font on every machine that has matplotlib.

Graphviz runs in a separate process, because fontconfig reads its settings from the environment and writes warnings to
standard error. The settings and the warnings must not affect the caller.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import Literal
from xml.sax.saxutils import escape

from grader.common.interpreter import interpreter
from grader.errors import MachineError

Format = Literal["svg", "png", "json0"]
_PNG_DPI = 144
_HANG_S = 60.0


def render(dot: str, kind: Format) -> bytes:
    """Lay out a DOT graph and draw it: SVG is UTF-8 text, PNG has 144 pixels per inch, and json0 holds all positions.

    Raises:
        MachineError: Graphviz is not installed or cannot draw the graph.
    """
    with tempfile.TemporaryDirectory() as folder:
        start = interpreter("-m", "grader.graph.layout", kind, env={**os.environ, **_our_font(Path(folder))})
        try:
            done = subprocess.run(
                start.argv, input=dot.encode(), capture_output=True, env=start.env, timeout=_HANG_S, check=False
            )
        except subprocess.TimeoutExpired as error:
            message = (
                f"Graphviz did not draw the graph within {_HANG_S:.0f} s. `rqt_graph --output graph.dot` works without "
                "Graphviz."
            )
            raise MachineError(message) from error
    if done.returncode != 0:
        last = done.stderr.decode(errors="replace").strip().rpartition("\n")[2] or "no message"
        message = (
            f"The graph could not be drawn ({last}). This needs pygraphviz, which `make demo` in the course's folder "
            "installs. Without it, `rqt_graph --text` and `rqt_graph --output graph.dot` still work."
        )
        raise MachineError(message)
    if kind == "svg":
        # A viewer without this font uses the next font in the list. Verdana is equally wide, and most sans-serif fonts
        # are narrower.
        return done.stdout.replace(b'font-family="DejaVu Sans"', b'font-family="DejaVu Sans,Verdana,sans-serif"')
    return done.stdout


def _our_font(folder: Path) -> dict[str, str]:
    """Return environment variables that limit fontconfig to matplotlib's fonts, or {} if matplotlib is not installed.

    With these fonts, text has the same width on every machine.
    """
    spec = find_spec("matplotlib")
    if spec is None or spec.origin is None:
        return {}
    fonts = Path(spec.origin).parent / "mpl-data" / "fonts" / "ttf"
    file = folder / "fonts.conf"
    file.write_text(
        '<?xml version="1.0"?><fontconfig>'
        f"<dir>{escape(str(fonts))}</dir><cachedir>{escape(str(folder))}</cachedir></fontconfig>"
    )
    return {"FONTCONFIG_FILE": str(file)}


def _main(kind: str) -> None:
    """Read DOT from standard input, and write the picture to standard output."""
    import pygraphviz  # type: ignore[import-untyped]

    graph = pygraphviz.AGraph(string=sys.stdin.read())
    if kind == "png":
        graph.graph_attr["dpi"] = str(_PNG_DPI)
    graph.layout("dot")
    sys.stdout.buffer.write(graph.draw(format=kind))


if __name__ == "__main__":
    _main(sys.argv[1])
