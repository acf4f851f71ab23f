"""The lock file: the version and hashes of every package that the set-up installs, for all versions of Python.

The file is in pip's format and has sections. `# part: NAME` starts the list of packages of one part, and
`# part: NAME NAME` starts a list of packages that several optional parts need. Each set-up installs the packages of its
parts. `python -m grader.setup.lock` (`make lock`) writes the file. To read the file, this module uses only the standard
library, because the set-up reads the file before anything is installed.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.errors import MachineError, UsageError
from grader.setup.uv import uv

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

ROOT = Path(__file__).parents[2]
PROJECT = ROOT / "pyproject.toml"
LOCK_FILE = ROOT / "requirements.lock"
PARTS = {
    "setup": "the installer of the other parts",
    "grader": "the libraries of the grader",
    "ros": "ROS 2 Jazzy as wheels; not installed if a ROS 2 is sourced",
    "cluster": "grading on many machines",
    "notebooks": "JupyterLab and nbgrader",
    "docs": "the documentation as a site",
    "tests": "tests",
}
"""The name of each part and its purpose, in the order of the file."""

ALWAYS = ("setup", "grader")
"""The parts of every set-up. The packages of these two parts are not repeated in other parts. All other parts,
including `ros`, are optional. Therefore, an optional part lists all packages that it needs and that the two parts do
not have.
"""

SOURCED_BRINGS = frozenset({"numpy", "empy"})
"""The packages that a sourced ROS 2 provides. The extensions of a sourced ROS 2 need its own numpy, and its generators
need its own empy."""

_MARK = "# part: "
_NAME = re.compile(r"([A-Za-z0-9][A-Za-z0-9._-]*)==(\S+)")


@dataclass(frozen=True)
class Entry:
    """One version of a package in the lock file.

    `text` contains the lines of the entry in the file, including the hashes and the final newline.
    """

    name: str
    version: str
    text: str


def parse(text: str) -> dict[str, list[Entry]]:
    """Return the entries of each part in the order of the file.

    If several parts need an entry, the list of each of these parts contains the entry.

    Raises:
        UsageError: a line does not belong to a part or an entry.
    """
    sections: list[tuple[list[str], list[Entry]]] = []
    for line in text.splitlines(keepends=True):
        if line.startswith(_MARK):
            sections.append((line[len(_MARK) :].partition(":")[0].split(), []))
        elif line.startswith("#") or not line.strip():
            continue
        elif not sections:
            message = f"requirements.lock: this line is before the first '{_MARK}NAME': {line.strip()}"
            raise UsageError(message)
        elif match := _NAME.match(line):
            sections[-1][1].append(Entry(match.group(1), match.group(2), line))
        elif sections[-1][1] and line.startswith(" "):
            last = sections[-1][1].pop()
            sections[-1][1].append(Entry(last.name, last.version, last.text + line))
        else:
            message = f"requirements.lock: expected 'name==version' or an indented hash, but found: {line.strip()}"
            raise UsageError(message)
    parts: dict[str, list[Entry]] = {}
    for names, entries in sections:
        for name in names:
            parts.setdefault(name, []).extend(entries)
    return parts


def select(
    text: str, parts: Collection[str], *, without: Collection[str] = (), only: Collection[str] | None = None
) -> str:
    """Return the requirements of `parts` in pip's format.

    The packages in `without` are left out. If `only` is given, all packages that are not in `only` are left out. Raises
    the same error as `parse`.
    """
    entries = dict.fromkeys(entry for part, entries in parse(text).items() if part in parts for entry in entries)
    chosen = (entry for entry in entries if entry.name not in without and (only is None or entry.name in only))
    return "".join(entry.text for entry in chosen)


def split(entries: Iterable[Entry], needs: Mapping[str, Collection[str]]) -> str:
    """Return the content of the lock file. `needs` contains the names of the packages of each part.

    If a package has several versions for different Pythons, a part contains all these versions.

    Raises:
        MachineError: the packages of all parts together differ from those in `entries`.
    """
    sections: dict[tuple[str, ...], list[str]] = {(part,): [] for part in PARTS}
    rest = set().union(*needs.values())
    for entry in entries:
        parts = tuple(part for part in PARTS if entry.name in needs.get(part, ()))
        always = [part for part in ALWAYS if part in parts]
        if not parts:
            message = f"The whole lock file contains {entry.name}, but no part of the lock file needs this package."
            raise MachineError(message)
        sections.setdefault((always[0],) if always else parts, []).append(entry.text)
        rest.discard(entry.name)
    if rest:
        message = f"Parts of the lock file need packages that were not resolved for the whole file: {sorted(rest)}."
        raise MachineError(message)
    text = "# Generated by `make lock` from pyproject.toml; do not edit. All versions with hashes, for all Pythons.\n"
    order = list(PARTS)
    for parts in sorted(sections, key=lambda parts: [order.index(part) for part in reversed(parts)]):
        text += f"\n{_MARK}{' '.join(parts)}: {'; '.join(PARTS[part] for part in parts)}\n{''.join(sections[parts])}"
    return text


def make(*, upgrade: bool = False) -> str:
    """Return the content of a new lock file for pyproject.toml, resolved by uv (over the network).

    The versions in the existing lock file are kept if they are still compatible, unless `upgrade` is True.

    Raises:
        MachineError: uv could not resolve the packages, or resolved other packages for a part than for the whole file.
    """
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder, "whole.txt")
        if LOCK_FILE.exists():
            shutil.copyfile(LOCK_FILE, whole)
        _compile(whole, ["--all-extras", *(["--upgrade"] if upgrade else [])])
        entries = parse(f"{_MARK}all\n" + whole.read_text(encoding="utf-8"))["all"]
        needs = {}
        for part, requirements, arguments in [
            ("setup", "\n".join(_requirements("setup")), []),
            ("grader", None, ["--extra", "view"]),
            ("ros", None, ["--extra", "ros"]),
            ("cluster", None, ["--extra", "cluster"]),
            ("notebooks", None, ["--extra", "notebooks"]),
            ("docs", None, ["--extra", "docs"]),
            ("tests", None, ["--extra", "dev"]),
        ]:
            path = Path(folder, f"{part}.txt")
            # Limit each part to the versions in the whole file, for each Python.
            _compile(path, [*arguments, "--constraint", str(whole)], requirements)
            needs[part] = {name for name, _ in _NAME.findall(path.read_text(encoding="utf-8"))}
    return split(entries, needs)


def _requirements(extra: str) -> list[str]:
    """Return the requirements of an extra, without the project's own dependencies."""
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    project = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]
    return [str(requirement) for requirement in project["optional-dependencies"][extra]]


def _compile(output: Path, arguments: list[str], requirements: str | None = None) -> None:
    """Resolve the project's dependencies, or `requirements` (one per line) if given, and write them to `output`."""
    command = [
        *uv("pip", "compile", str(PROJECT) if requirements is None else "-"),
        *("--output-file", str(output), "--quiet", *arguments),
        *("--universal", "--python-version", "3.10", "--no-python-downloads"),
        # Each machine decides from where it downloads packages, so the file contains no index and no URLs.
        *("--generate-hashes", "--no-emit-index-url", "--no-annotate", "--no-header"),
    ]
    done = subprocess.run(command, cwd=ROOT, check=False, input=requirements, text=True)
    if done.returncode != 0:
        message = f"uv could not create the lock file (exit code {done.returncode}; its messages are above)."
        raise MachineError(message)


def main(arguments: list[str]) -> int:
    """Write the lock file. With `--upgrade`, use the newest compatible versions."""
    text = make(upgrade="--upgrade" in arguments)
    parts = parse(text)
    unchanged = LOCK_FILE.exists() and LOCK_FILE.read_text(encoding="utf-8") == text
    if not unchanged:
        LOCK_FILE.write_text(text, encoding="utf-8")
    counts = ", ".join(f"{part} {len(entries)}" for part, entries in parts.items())
    print(f"requirements.lock: {'unchanged' if unchanged else 'written'}; packages by part: {counts}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
