"""Open a page in the user's browser."""

from __future__ import annotations

import os
import shutil
import subprocess

from grader.common.interpreter import clean, interpreter

_OPENED_S = 3.0
"""A browser that has not failed after this time (s) is considered to have opened the page."""


def there_is_one() -> bool:
    """Return whether there is a screen for a browser, or BROWSER names a program, as in a remote editor."""
    return bool(os.environ.get("BROWSER")) or _screen()


def _screen() -> bool:
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def over_ssh() -> bool:
    """Return whether this terminal belongs to an ssh session."""
    return bool(os.environ.get("SSH_CONNECTION"))


def from_elsewhere(port: int) -> str:
    """Return instructions for opening the page: over ssh, on the user's own machine, and otherwise on this machine."""
    if over_ssh():
        user = os.environ.get("USER") or "USER"
        server = os.environ["SSH_CONNECTION"].split()[2:3] or ["THIS_MACHINE"]
        login = f"{user}@{server[0]}"
        return (
            "This terminal cannot open a browser. On your own machine, type this in a new terminal, and then open the "
            f"address: ssh -N -L {port}:127.0.0.1:{port} {login}"
        )
    return "No browser was found. Open the address in a browser on this machine."


def open_page(url: str) -> bool:
    """Open a page. Return whether the browser has started and has not failed within `_OPENED_S`.

    The browser gets no terminal, so a text browser cannot be used.
    """
    if not there_is_one():
        return False
    opener = shutil.which("xdg-open")
    if _screen() and opener is not None and not os.environ.get("BROWSER"):
        return _started([opener, url], clean(os.environ))
    # Use a separate process, because some browsers return only when they are closed.
    return _started(*interpreter("-m", "webbrowser", url))


def _started(command: list[str], env: dict[str, str]) -> bool:
    try:
        started = subprocess.Popen(
            command,
            env=env,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        return started.wait(_OPENED_S) == 0
    except subprocess.TimeoutExpired:
        return True
    except OSError:
        return False
