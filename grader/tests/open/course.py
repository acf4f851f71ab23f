"""`grader open`, started as a learner would start it, with a separate home folder."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from grader.tests.browser import new_page
from grader.tests.case import ROOT
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Page

CIRCLE = "03-circle-publisher"
NODE = "src/my_robot_controller/my_robot_controller/draw_circle.py"
GRADER = Path(sys.prefix, "bin/grader")


@dataclass
class Course:
    """A home folder with a workspace, and the last server that was started."""

    home: Path
    processes: list[subprocess.Popen[str]] = field(default_factory=list)
    url: str = ""

    @property
    def workspace(self) -> Path:
        return self.home / "ros2_ws"

    @property
    def node(self) -> Path:
        return self.workspace / NODE

    @property
    def host(self) -> str:
        return self.url.removeprefix("http://").partition("/")[0]

    @property
    def token(self) -> str:
        return self.url.partition("#")[2]

    @property
    def env(self) -> dict[str, str]:
        own = {"HOME": str(self.home), "XDG_STATE_HOME": str(self.home / "state")}
        cache = {"XDG_CACHE_HOME": os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")}
        return {**os.environ, **cache, **own}

    def start(self) -> str:
        """Start the server. Return the address that the server prints."""
        process = subprocess.Popen(
            [str(GRADER), "open", "--no-browser"],
            env=self.env,
            cwd=self.home,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        self.processes.append(process)
        assert process.stdout is not None
        line = process.stdout.readline()
        found = re.search(r"http://\S+", line)
        assert found, line + process.stdout.read()
        self.url = found[0]
        return self.url

    def end(self, number: int = signal.SIGINT) -> int:
        """Send a signal to the last server. Return its exit code."""
        process = self.processes[-1]
        if process.poll() is None:
            process.send_signal(number)
        return process.wait(HANG_S)

    def run(self, *arguments: str) -> str:
        """Run another command of the grader with the same home folder. Return its output."""
        done = subprocess.run(
            [str(GRADER), *arguments], env=self.env, cwd=self.home, capture_output=True, text=True, check=True
        )
        return done.stdout

    def save(self, old: str = "", new: str = "") -> None:
        """Save the solution of step 03 with this change. Like some editors, write a new file and rename it."""
        text = (ROOT / "solutions" / CIRCLE / "my_robot_controller/my_robot_controller/draw_circle.py").read_text()
        assert old in text
        new_file = self.home / "draw_circle.py.tmp"
        new_file.write_text(text.replace(old, new))
        new_file.replace(self.node)

    def opened(self, browser: Browser, path: str = "", width: int = 1400) -> Page:
        """Open a page in a new window without cookies or storage of other windows."""
        tab = new_page(browser, viewport={"width": width, "height": 900})
        tab.goto(f"http://{self.host}/{path}#{self.token}")
        tab.get_by_text("Live", exact=True).wait_for()
        return tab


def course(home: Path) -> Iterator[Course]:
    made = Course(home)
    try:
        yield made
    finally:
        for process in made.processes:
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                process.wait(HANG_S)
            assert process.stdout is not None
            process.stdout.close()
        shutil.rmtree(made.workspace, ignore_errors=True)
