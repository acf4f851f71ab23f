"""A Jupyter server extension that hides nbgrader's tools in JupyterLab from learners.

Jupyter finds the extension through jupyter_server.json, which the set-up copies to a folder in etc/jupyter.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

CONFIG = "nbgrader_config.py"
EXTENSION = "@jupyter/nbgrader"


def _jupyter_server_extension_points() -> list[dict[str, str]]:
    return [{"module": __name__}]


def _load_jupyter_server_extension(app: Any) -> None:  # noqa: ANN401 - Jupyter's ServerApp, which has no types
    """Hide the tools, unless JupyterLab was started in a folder with nbgrader's configuration."""
    if not Path(CONFIG).is_file():
        app.web_app.settings["page_config_hook"] = _hidden


def _hidden(_handler: object, page_config: dict[str, Any]) -> dict[str, Any]:
    """Return JupyterLab's page settings with nbgrader's extension disabled."""
    return {**page_config, "disabledExtensions": [*page_config.get("disabledExtensions", []), EXTENSION]}
