"""The targets: for each reader of students' files, a function that processes bytes, and its seeds."""

from __future__ import annotations

import dataclasses
import gzip
import io
import tarfile
import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.classroom.archives import unpacked
from grader.classroom.unpack import NotUnpackedError
from grader.colcon.runner import _READY, _described
from grader.errors import GraderError, UnreadableError, UsageError
from grader.evidence import recording_format
from grader.exercise.model import course_folder
from grader.report.html_class import save_class_page
from grader.report.json import to_json
from grader.sandbox.process import Finished
from grader.submission.handed_in import open_handed_in
from grader.submission.package import write_copy
from grader.submission.reader import read
from grader.tests.checks.made import FILES, NODE_FILE, evidence, good
from grader.tests.fuzz.choices import Choices
from grader.tests.fuzz.commands import STEP, graded_class, graded_files, regraded
from grader.tests.fuzz.folders import archive as odd_archive
from grader.tests.fuzz.folders import fill
from grader.tests.fuzz.odd_json import odd_json
from grader.trial.recording import Output

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

ROOT = course_folder().parent


@dataclasses.dataclass(frozen=True)
class Target:
    """`run` processes the bytes like a command. `seeds` are inputs that the fuzzer varies."""

    run: Callable[[bytes], object]
    seeds: Callable[[], Iterable[bytes]]


def names(data: bytes) -> None:
    """Run `grade` on a folder with any content."""
    with tempfile.TemporaryDirectory() as folder:
        fill(Path(folder), Choices(data))
        graded_class(Path(folder))


def archives(data: bytes) -> None:
    """Unpack an archive.

    The first byte selects whether the rest is an archive or describes how to create an archive.
    """
    made = odd_archive(Choices(data[1:])) if data[:1] == b"z" else data[1:]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder).resolve() / "a.zip"
        file.write_bytes(made)
        with suppress(NotUnpackedError), unpacked(file):
            pass


def sources(data: bytes) -> None:
    """Run `check` on a package with this node."""
    graded_files({NODE_FILE: data}, clock="auto")


def setup_py(data: bytes) -> None:
    """Run `check` on a package with this setup.py."""
    graded_files({"setup.py": data})


def package_xml(data: bytes) -> None:
    """Run `check` on a package with this package.xml."""
    graded_files({"package.xml": data}, step="04-package-files")


def answers(data: bytes) -> None:
    """Run `check` on these answers."""
    # One question is about messages that the invented trial does not contain.
    graded_files({"answers.toml": data}, step="02-discover-topics", unjudged=("pose-rate",))


def install_tree(data: bytes) -> None:
    """Run `check` on a package with this result of its build: a line of the log, and a tar stream."""
    log, _, tree = data.partition(b"\n")
    done = Finished(0, tree, _READY + log.replace(b"\r", b"\n"), 1.0)
    try:
        build, _ = read(_described, done)
    except UnreadableError:
        return
    graded_files({}, build=build)


def output(data: bytes) -> None:
    """Run `check` on a node that prints these bytes."""
    text = data.decode("utf-8", "replace")
    recording = dataclasses.replace(good(), stderr=Output(text), stdout=Output(text))
    graded_files({}, recording=recording)


def notebooks(data: bytes) -> None:
    """Run `gradebook sync` on this notebook, alone or together with a package."""
    import nbgrader.utils  # noqa: F401 - otherwise each process that reads would import it

    if data[:1] == b"j":
        data = odd_json(next(iter(TARGETS["notebooks"].seeds())), Choices(data[1:]))
    with tempfile.TemporaryDirectory() as folder:
        submitted = Path(folder) / "in"
        submitted.mkdir()
        (submitted / f"{STEP}.ipynb").write_bytes(data)
        try:
            write_copy(open_handed_in(submitted, find_exercise(STEP)), Path(folder) / "out")
        except GraderError:
            return
        graded_class(Path(folder))


def recordings(data: bytes) -> None:
    """Run `regrade` on a recording with one changed file.

    The first byte selects the file, and the second byte selects the change.
    """
    files = _recording()
    changed = sorted(files)[data[0] % len(files)] if data else ""
    content = data[1:]
    if changed.endswith(".json") and content[:1] == b"j":
        content = odd_json(files[changed], Choices(content[1:]))
    with tempfile.TemporaryDirectory() as folder:
        for path, kept in files.items():
            (Path(folder) / path).parent.mkdir(parents=True, exist_ok=True)
            (Path(folder) / path).write_bytes(content if path == changed else kept)
        with suppress(UsageError):
            regraded(Path(folder))


def reports(data: bytes) -> None:
    """Run `class-page` on this report and a valid report. The first byte can select a report with replaced values."""
    data = odd_json(_report(), Choices(data[1:])) if data[:1] == b"j" else data
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "anna.json").write_bytes(data)
        (Path(folder) / "ben.json").write_bytes(_report())
        save_class_page(Path(folder), Path(folder) / "index.html")


@cache
def _recording() -> dict[str, bytes]:
    with tempfile.TemporaryDirectory() as folder:
        recording_format.save(Path(folder), evidence(good()), "none", ())
        return {str(path.relative_to(folder)): path.read_bytes() for path in Path(folder).rglob("*") if path.is_file()}


@cache
def _report() -> bytes:
    return to_json(graded_files({})).encode()


def _files(pattern: str) -> Callable[[], Iterable[bytes]]:
    return lambda: [path.read_bytes() for path in sorted(ROOT.glob(pattern))]


def _archives() -> Iterable[bytes]:
    yield b"z" + bytes(range(1, 200))
    plain = io.BytesIO()
    with tarfile.open(fileobj=plain, mode="w") as tar:
        tar.add(ROOT / "solutions" / STEP, "p")
    yield b"a" + plain.getvalue()
    yield b"a" + gzip.compress(plain.getvalue())


def _install_trees() -> Iterable[bytes]:
    tree = io.BytesIO()
    with tarfile.open(fileobj=tree, mode="w", format=tarfile.GNU_FORMAT) as tar:
        for path, text in {
            "my_robot_controller/lib/my_robot_controller/draw_circle": b"x",
            "my_robot_controller/lib/p.egg-info/entry_points.txt": b"[console_scripts]\ndraw_circle = a.b:main\n",
            f"my_robot_controller/{'long' * 40}": b"",
        }.items():
            member = tarfile.TarInfo(path)
            member.size = len(text)
            tar.addfile(member, io.BytesIO(text))
    log = b"Traceback (most recent call last):\r  File \"setup.py\", line 3, in <module>\rNameError: name 'x'"
    yield log + b"\n" + tree.getvalue()


def _outputs() -> Iterable[bytes]:
    yield b"[INFO] [1795197264.452119571] [draw_circle]: x=5.5, y=5.5\n" * 3
    yield (
        b'Traceback (most recent call last):\n  File "/ws/install/my_robot_controller/lib/python3.11/site-packages/'
        b'my_robot_controller/draw_circle.py", line 12, in send\n    msg.linear.y.z = 2\n'
        b"AttributeError: 'float' object has no attribute 'z'. Did you mean: 'x'?\n"
    )


def _recordings() -> Iterable[bytes]:
    files = _recording()
    return [bytes([n]) + how for n, path in enumerate(sorted(files)) for how in (files[path], b"jabc")]


TARGETS = {
    "names": Target(names, lambda: [bytes(range(n, 250, 3)) for n in range(8)]),
    "archives": Target(archives, _archives),
    "sources": Target(sources, _files("grader/tests/mistakes/*/**/draw_circle.py")),
    "setup.py": Target(setup_py, _files("grader/tests/mistakes/*/**/setup.py")),
    "package.xml": Target(
        package_xml, lambda: [*_files("solutions/*/**/package.xml")(), FILES["package.xml"].encode()]
    ),
    "answers": Target(answers, _files("solutions/*/answers.toml")),
    "install tree": Target(install_tree, _install_trees),
    "output": Target(output, _outputs),
    "notebooks": Target(notebooks, _files("exercises/*/*.ipynb")),
    "recordings": Target(recordings, _recordings),
    "reports": Target(reports, lambda: [_report(), b"j123", b"jabcdefg"]),
}
