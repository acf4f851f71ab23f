from __future__ import annotations

import re
import sys
from importlib import metadata
from itertools import chain

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from grader.errors import MachineError, UsageError
from grader.setup import bootstrap, lock
from grader.tests.both_worlds import of_the_wheels

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

TEXT = lock.LOCK_FILE.read_text(encoding="utf-8")
PARTS = lock.parse(TEXT)
ENTRIES = list(dict.fromkeys(entry for entries in PARTS.values() for entry in entries))
PYTHONS = {"3.10": "3.10.0", "3.11": "3.11.2", "3.12": "3.12.3", "3.13": "3.13.5", "3.14": "3.14.0"}

SMALL = """\
# a comment

# part: setup: first
uv==1.0 ; python_version < '3.15' \\
    --hash=sha256:aa \\
    --hash=sha256:bb

# part: grader: second
numpy==2.0 \\
    --hash=sha256:cc
rich==15 \\
    --hash=sha256:dd
"""


def environment(python: str) -> dict[str, str]:
    return {
        "python_version": python,
        "python_full_version": PYTHONS[python],
        "implementation_name": "cpython",
        "platform_python_implementation": "CPython",
        "sys_platform": "linux",
        "platform_machine": "x86_64",
        "platform_system": "Linux",
        "os_name": "posix",
        "extra": "",
    }


def requirement(entry: lock.Entry) -> Requirement:
    return Requirement(entry.text.split("--hash")[0].replace("\\\n", "").strip().rstrip("\\"))


def applies(entry: lock.Entry, python: str) -> bool:
    marker = requirement(entry).marker
    return marker is None or marker.evaluate(environment(python))


def applying(python: str) -> dict[str, str]:
    """Map each package that the lock file installs for a Python to its version. Names must be unique."""
    found: dict[str, str] = {}
    for entry in ENTRIES:
        if applies(entry, python):
            assert entry.name not in found, f"{entry.name} twice for Python {python}"
            found[entry.name] = entry.version
    return found


def test_every_entry_has_hashes() -> None:
    assert [entry.name for entry in ENTRIES if not re.search(r"--hash=sha256:[0-9a-f]{64}", entry.text)] == []


def test_lock_names_no_addresses() -> None:
    assert [
        word for word in ("://", " @ ", "--index", "--extra-index", "--find-links", "--trusted") if word in TEXT
    ] == []


@pytest.mark.parametrize("python", PYTHONS)
def test_lock_covers_the_project(python: str) -> None:
    locked = applying(python)
    project = tomllib.loads(lock.PROJECT.read_text(encoding="utf-8"))
    extras = project["project"]["optional-dependencies"].values()
    stated = [*project["project"]["dependencies"], *project["build-system"]["requires"], *chain.from_iterable(extras)]
    for wanted in map(Requirement, stated):
        if wanted.marker is None or wanted.marker.evaluate(environment(python)):
            version = locked.get(canonicalize_name(wanted.name))
            assert version is not None, f"{wanted} is not in the lock file: run `make lock`"
            assert wanted.specifier.contains(version), f"{wanted}, but locked is {version}: run `make lock`"


def test_parts_stand_in_order() -> None:
    assert list(PARTS) == list(lock.PARTS)


def test_ros_is_a_part_of_its_own() -> None:
    where = {entry.name: part for part, entries in PARTS.items() for entry in entries}
    assert {part for name, part in where.items() if name.startswith("ros-")} == {"ros"}
    assert [where[name] for name in ("uv", "numpy", "colcon-core", "nbgrader", "mypy")] == [
        "setup",
        "grader",
        "grader",
        "notebooks",
        "tests",
    ]


def named_by_the_project(parts: list[str]) -> list[Requirement]:
    """Return the requirements in pyproject.toml for these parts of the lock file."""
    project = tomllib.loads(lock.PROJECT.read_text(encoding="utf-8"))["project"]
    extras = {"grader": "view", "tests": "dev"}
    texts = chain.from_iterable(project["optional-dependencies"][extras.get(part, part)] for part in parts)
    return list(map(Requirement, [*(project["dependencies"] if "grader" in parts else []), *texts]))


def resolved(wanted: list[Requirement]) -> set[str]:
    """Return the names of all packages that these requirements need, according to the installed metadata."""
    found: set[tuple[str, str]] = set()
    while wanted:
        need = wanted.pop()
        for extra in {"", *need.extras} - {extra for name, extra in found if name == canonicalize_name(need.name)}:
            found.add((canonicalize_name(need.name), extra))
            needs = map(Requirement, metadata.requires(need.name) or [])
            wanted += [need for need in needs if need.marker is None or need.marker.evaluate({"extra": extra})]
    return {name for name, _ in found}


@pytest.mark.parametrize("sourced", [pytest.param(False, marks=of_the_wheels), True], ids=["wheels", "sourced"])
@pytest.mark.parametrize("parts", bootstrap.PARTS.values(), ids=list(bootstrap.PARTS))
def test_each_set_up_has_all_that_its_packages_need(parts: list[str], *, sourced: bool) -> None:
    # Check this Python. test_resolved.py checks the other versions with uv, which needs the network.
    chosen = [part for part in parts if not (sourced and part == "ros")]
    needed = resolved([need for need in named_by_the_project(chosen) if not need.marker or need.marker.evaluate()])
    assert len(needed) > 70
    here = {entry.name for part in chosen for entry in PARTS[part] if applies(entry, f"3.{sys.version_info.minor}")}
    assert needed - here == set()


def test_a_part_has_all_versions_of_a_package() -> None:
    # The version of Python decides which one is installed.
    for part, entries in PARTS.items():
        names = {entry.name for entry in entries}
        if part not in lock.ALWAYS:
            names -= {entry.name for always in lock.ALWAYS for entry in PARTS[always]}
        assert {entry for entry in ENTRIES if entry.name in names} - set(entries) == set(), part


def test_no_two_packages_write_the_same_file() -> None:
    # uv installs in parallel, so either of the two files could remain.
    names = {canonicalize_name(entry.name) for entry in ENTRIES}
    writers: dict[str, set[str]] = {}
    for package in metadata.distributions():
        name = canonicalize_name(package.name)
        for line in (package.read_text("RECORD") or "").splitlines() if name in names else ():
            writers.setdefault(line.partition(",")[0], set()).add(name)
    assert len(writers) > 1000
    assert {file: packages for file, packages in writers.items() if len(packages) > 1} == {}


def test_select_takes_whole_entries_of_the_parts_requested() -> None:
    assert lock.select(SMALL, ["setup"]) == SMALL.split("first\n")[1].split("\n\n")[0] + "\n"
    assert [entry.name for entry in lock.parse("# part: x\n" + lock.select(SMALL, ["setup", "grader"]))["x"]] == [
        "uv",
        "numpy",
        "rich",
    ]


def test_select_leaves_out_and_picks() -> None:
    assert "numpy" not in lock.select(SMALL, ["grader"], without={"numpy"})
    assert lock.select(SMALL, ["setup", "grader"], only={"rich"}) == "rich==15 \\\n    --hash=sha256:dd\n"


def split(needs: dict[str, str]) -> dict[str, list[str]]:
    """Return the packages that `split` puts into each part. Each letter is a package that the part needs."""
    entries = [lock.Entry(name, "1", f"{name}==1\n") for name in "abcdefg"]
    text = lock.split(entries, needs)
    return {part: [entry.name for entry in found] for part, found in lock.parse(text).items()}


def test_split_gives_each_part_all_that_it_needs() -> None:
    needs = {"setup": "b", "grader": "abg", "ros": "ace", "cluster": "ade", "notebooks": "aef"}
    needs |= {"docs": "ad", "tests": "abfg"}
    assert split(needs) == {
        "setup": ["b"],
        "grader": ["a", "g"],
        "ros": ["c", "e"],
        "cluster": ["e", "d"],
        "notebooks": ["e", "f"],
        "docs": ["d"],
        "tests": ["f"],
    }


def test_split_refuses_parts_that_are_not_the_whole() -> None:
    with pytest.raises(MachineError, match="contains g, but no part"):
        split({"setup": "abcdef"})
    with pytest.raises(MachineError, match="'h'"):
        split({"setup": "abcdefg", "tests": "h"})


def test_what_two_parts_need_is_selected_once() -> None:
    text = "# part: cluster notebooks: both\ntornado==6 \\\n    --hash=sha256:aa\n"
    assert lock.select(text, ["cluster", "notebooks"]) == lock.select(text, ["cluster"]) == text.partition("\n")[2]


@pytest.mark.parametrize("text", ["uv==1.0\n", "# part: setup\n    --hash=sha256:aa\n", "# part: setup\nuv>=1\n"])
def test_a_line_out_of_place_is_reported(text: str) -> None:
    with pytest.raises(UsageError, match=re.escape(text.splitlines()[-1].strip())):
        lock.parse(text)
