"""Attacks: submissions that try to harm or cheat the grader, and the expected result of their grading.

Each attack is a folder:

    grader/tests/hostile/NNN-name/
      files/           added to the solution of a step (`base`), or replacing its files; for a few lines, use `edit`
      make.py          make(package): creates files that git cannot store
      expected.toml    the keys are the fields of `Attack`, below, except `name`
"""

from __future__ import annotations

import importlib.util
import shutil
import sys
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.tests.case import apply_edits, copy_solution

if TYPE_CHECKING:
    from collections.abc import Mapping

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FOLDER = Path(__file__).parent / "hostile"


@dataclass(frozen=True)
class Attack:
    """The content of expected.toml.

    One key names the trace that the attack leaves if there is no sandbox. In a sandbox, the attack must not leave this
    trace. The keys for traces are `says` (a text in the output), `file` (a path in the observed host), `process` (a
    part of a command line), `socket`, `kills` (the grader itself), `secret` (the caller's secret in the node's output).
    `raw` is a shell command that is run in the package's folder, and whose trace is `says` or `file`.

    An attack on the simulator leaves a trace in the recording even in a sandbox, because the grader judges the
    recording. `passes` is a check that would pass if `without` were ignored ("interventions", "participants").
    `reaches` is a topic, an intervention or a text in the recording that shows that the attack was made.
    """

    name: str
    why: str
    base: str = "03-circle-publisher"
    """The step whose solution the attack changes, and whose exercise grades it."""
    points: float = -1.0
    """The exact points. If below 0, the points are not checked, because the node may be partly right."""
    most: float = 100.0
    """The maximum number of points."""
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
    """Text that the grader must not print."""
    never_html: tuple[str, ...] = ()
    """Text that the page must not contain."""
    edit: tuple[Mapping[str, str], ...] = ()
    """The edits of the solution: `old` in `file` is replaced with `new` everywhere."""
    sample: bool = False
    clock: str = "auto"

    @property
    def is_of_the_host(self) -> bool:
        """Return whether the sandbox must prevent the trace of this attack."""
        return bool(self.says or self.file or self.process or self.socket or self.kills or self.secret)


def read_attacks() -> tuple[Attack, ...]:
    """Return every attack, sorted by name. Raises ValueError for an unknown key."""
    return tuple(_read(folder) for folder in sorted(FOLDER.iterdir()) if (folder / "expected.toml").is_file())


def _read(folder: Path) -> Attack:
    values: dict[str, Any] = tomllib.loads((folder / "expected.toml").read_text("utf-8"))
    unknown = values.keys() - {field.name for field in fields(Attack)}
    if unknown:
        message = f"{folder.name}/expected.toml: {unknown}"
        raise ValueError(message)
    lists = {key: tuple(values.get(key, ())) for key in ("never", "never_html", "edit")}
    return Attack(name=folder.name, **{**values, **lists})


def make_attack(attack: Attack, to: Path) -> Path:
    """Write the package below the new folder `to`, and return its path."""
    package = to / "my_robot_controller"
    copy_solution(attack.base, package)
    apply_edits(attack.edit, package, attack.name)
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
