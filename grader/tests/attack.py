"""An attack: a submission that wants more than to be graded, and what must hold.

grader/tests/hostile/NNN-name/
  files/           laid over the solution of step 03
  make.py          make(package): what a folder in git cannot hold
  expected.toml    the keys are the fields of `Attack`, below
"""

from __future__ import annotations

import importlib.util
import shutil
import sys
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from grader.tests.case import copy_solution

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FOLDER = Path(__file__).parent / "hostile"


@dataclass(frozen=True)
class Attack:
    """What stands in expected.toml.

    One of these names the trace that the attack leaves where nothing is defended, and that must not be there otherwise:
    `says` (in what build and node wrote), `file` (a path in the observed host), `process` (a part of a command line),
    `socket`, `kills` (the grader itself), `secret` (the caller's secret in the node's output). `raw` is a shell
    command, run in the package's folder: its trace is `says` or `file`.

    What reaches the simulator leaves its trace in the recording either way, since there it belongs to what is judged:
    `passes` is a check that would pass if `without` were not looked at ("interventions", "participants"), `reaches` a
    topic, an intervention or a text that must be in the recording to show that the attack was made.
    """

    name: str
    why: str
    points: float = -1.0
    """No fewer and no more; below 0, what the node does right may count."""
    most: float = 100.0
    """No more than that."""
    says: str = ""
    file: str = ""
    process: str = ""
    socket: str = ""
    kills: bool = False
    secret: bool = False
    raw: str = ""
    passes: str = ""
    without: str = ""
    reaches: str = ""
    never: tuple[str, ...] = ()
    """What the grader may not print."""
    never_html: tuple[str, ...] = ()
    """What the page may not contain."""
    sample: bool = False
    clock: str = "auto"

    @property
    def is_of_the_host(self) -> bool:
        """Whether the trace is one that the sandbox prevents."""
        return bool(self.says or self.file or self.process or self.socket or self.kills or self.secret)


def read_attacks() -> tuple[Attack, ...]:
    """Every attack, in the order of their names; ValueError for a key that there is not."""
    return tuple(_read(folder) for folder in sorted(FOLDER.iterdir()) if (folder / "expected.toml").is_file())


def _read(folder: Path) -> Attack:
    values: dict[str, Any] = tomllib.loads((folder / "expected.toml").read_text("utf-8"))
    unknown = values.keys() - {field.name for field in fields(Attack)}
    if unknown:
        message = f"{folder.name}/expected.toml: {unknown}"
        raise ValueError(message)
    lists = {key: tuple(values.get(key, ())) for key in ("never", "never_html")}
    return Attack(name=folder.name, **{**values, **lists})


def make_attack(attack: Attack, to: Path) -> Path:
    """Write the package below the new folder `to`, and return its path."""
    package = to / "my_robot_controller"
    copy_solution("03-circle-publisher", package)
    files = FOLDER / attack.name / "files"
    if files.is_dir():
        shutil.copytree(files, package, dirs_exist_ok=True)
    generator = FOLDER / attack.name / "make.py"
    if generator.is_file():
        spec = importlib.util.spec_from_file_location("make", generator)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        module.make(package)
    return package
