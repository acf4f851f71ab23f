"""JupyterLab for the browser tests: start it, and use it like a student."""

from __future__ import annotations

import os
import re
import secrets
import subprocess
import sys
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Page

STARTED = re.compile(r"http://127\.0\.0\.1:(\d+)/lab\?token=")


@contextmanager
def serving(folder: Path, home: Path) -> Iterator[str]:
    """Start JupyterLab for the notebooks in `folder`, with its settings below `home`.

    Yield the address of a notebook, with PATH in place of the notebook's path.
    """
    token = secrets.token_hex(16)
    env = {
        **os.environ,
        "HOME": str(home),
        "JUPYTER_CONFIG_DIR": str(home / "config"),
        "JUPYTER_DATA_DIR": str(home / ".local/share/jupyter"),
        "JUPYTERLAB_SETTINGS_DIR": str(home / "settings"),
        "JUPYTERLAB_WORKSPACES_DIR": str(home / "workspaces"),
        "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
    }
    argv = [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", "--ip=127.0.0.1", "--port=0"]
    argv += [f"--IdentityProvider.token={token}", f"--ServerApp.root_dir={folder}"]
    # JupyterLab would request news from the network.
    argv += ["--LabApp.news_url=", "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate"]
    server = subprocess.Popen(argv, env=env, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    address: list[str] = []
    said: list[str] = []
    ready = threading.Event()

    def listen() -> None:
        assert server.stderr is not None
        for line in server.stderr:
            said.append(line)
            found = STARTED.search(line)
            if found and not address:
                address.append(f"http://127.0.0.1:{found[1]}")
                ready.set()
        ready.set()

    threading.Thread(target=listen, daemon=True).start()
    try:
        ready.wait(HANG_S)
        assert address, "".join(said)[-3000:]
        yield f"{address[0]}/lab/tree/PATH?token={token}"
    finally:
        server.terminate()
        try:
            server.wait(20)
        except subprocess.TimeoutExpired:
            server.kill()
            server.wait()


def type_cell(page: Page, begins: str, text: str) -> None:
    """Type a new text in the first cell that contains `begins`, in place of the old text."""
    cell = page.locator(".jp-CodeCell", has_text=begins).first
    cell.scroll_into_view_if_needed()
    cell.locator(".cm-content").click()
    page.keyboard.press("Control+a")
    page.keyboard.press("Delete")
    # Paste the text, because the editor would indent typed lines and close brackets.
    page.keyboard.insert_text(text)


def run_all(page: Page) -> None:
    """Choose Run All Cells in the menu Run."""
    page.get_by_role("menuitem", name="Run", exact=True).click()
    page.get_by_role("menuitem", name="Run All Cells", exact=True).click()
