"""Judge recorded cases again, with the unchanged checks or with one changed file.

A child of this process imports the checks after the fork. Each child process contains only one mutant, and all effects
of the mutant end with the process.
"""

from __future__ import annotations

import dataclasses
import importlib.util
import os
import resource
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.report.json import to_data
from grader.report.report import Report
from grader.tests.case import ROOT
from grader.tests.gradings import Graded, compare

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator
    from pathlib import Path

    from coverage import Coverage

    from grader.evidence.evidence import Evidence
    from grader.tests.case import Case
    from grader.tests.mutation.mutants import Mutant
    from grader.tests.mutation.recordings import Recorded

Lines = dict[tuple["Path", int], set[str]]
"""Maps (file, line) to the names of the cases or tests that run this line. Lines are counted from 1."""

PACKAGE = "grader.checks"
SHARED = "grader.checks.outcome"
"""All modules use Status from this module. The module has no mutants, because Status must remain the same object in all
modules."""
SURVIVED, KILLED = 0, 1
LIMIT_S = 60
"""The limit on CPU time. A mutant that exceeds this limit never ends, and counts as noticed. Other load on the machine
does not matter."""


@dataclass(frozen=True)
class Material:
    """A case and its evidence.

    `observed` is an Evidence object whose class belongs to the first import of the checks.
    """

    name: str
    case: Case
    observed: Evidence
    ros: str


@dataclass(frozen=True)
class Job:
    """A mutant and its witnesses: the cases or tests that might notice the mutant.

    A witness is a function that is called with the mutant installed.
    """

    mutant: Mutant
    notices: Callable[[], bool]


def load(recorded: Iterable[Recorded]) -> list[Material]:
    """Read recordings. At the end, unload the checks, so that the next import loads them again."""
    from grader.checks.exercises import load_exercise
    from grader.evidence.recording_format import load as open_archive

    loaded = []
    for each in recorded:
        archived = open_archive(each.folder, load_exercise)
        loaded.append(Material(each.name, each.case, archived.evidence, archived.ros))
    # The checks import this module lazily. Import it once for all mutants.
    import catkin_pkg.package  # type: ignore[import-untyped]  # noqa: F401

    forget()
    return loaded


def forget() -> None:
    """Remove the modules of the checks from sys.modules."""
    for name in [name for name in sys.modules if name.startswith(f"{PACKAGE}.") and name != SHARED]:
        del sys.modules[name]


def fails(material: Material) -> bool:
    """Return whether the currently imported checks no longer give the case its expected report."""
    try:
        compare(material.case, _graded(material))
    except Exception:  # (an AssertionError of the case, or any exception that a mutant causes)
        return True
    return False


def _graded(material: Material) -> Graded:
    from grader.checks.judge import judge

    evidence = _anew(material.observed)
    recording = evidence.run.recording
    report = Report(
        exercise=evidence.exercise.id,
        exercise_title=evidence.exercise.title,
        submission=material.name,
        digest="",
        grader="",
        ros=material.ros,
        clock=recording.clock if recording else "none",
        clock_why="",
        seed=None,
        outcomes=judge(evidence),
    )
    return Graded(report.exit_code, "", "", to_data(report))


def _anew(observed: Evidence) -> Evidence:
    """Return the same evidence as objects of the currently imported classes, without cached values."""
    from grader.evidence.evidence import Evidence as Anew
    from grader.evidence.evidence import Fault

    fault = None if observed.fault is None else Fault(observed.fault.stage, observed.fault.message)
    plain = {field.name: getattr(observed, field.name) for field in dataclasses.fields(observed)}
    return Anew(**{**plain, "fault": fault})


def touched(materials: Iterable[Material], files: Collection[Path]) -> Lines:
    """Return the names of the cases that run each line of these files. Lines are counted from 1."""
    from coverage import Coverage

    measured = Coverage(data_file=None, include=[str(file) for file in files], config_file=False)
    measured.start()
    for material in materials:
        measured.switch_context(material.name)
        fails(material)
    measured.stop()
    forget()
    return lines_of(measured, files)


def lines_of(measured: Coverage, files: Iterable[Path]) -> Lines:
    """Return the names of the tests or cases that ran each line, from a coverage measurement."""
    data = measured.get_data()
    return {
        (file, line): {name for name in names if name}
        for file in files
        for line, names in data.contexts_by_lineno(str(file)).items()
    }


def who_runs(mutant: Mutant, lines: Lines) -> set[str]:
    """Return the cases or tests that run the mutant's lines, or any line of the file if these lines run at import."""
    if mutant.at_import:
        return {name for (file, _), names in lines.items() if file == mutant.file for name in names}
    numbers = range(mutant.line, mutant.end_line + 1)
    return {name for number in numbers for name in lines.get((mutant.file, number), ())}


def requested(mutant: Mutant, lines: Lines, alike: int) -> list[str]:
    """Return some of the cases or tests that run the mutant's lines. Many cases that run the same lines are left out.

    Hundreds of passing cases run the same lines of a check. A mutant can seem to survive although a case that was not
    run would detect it. A case that was not run can never make a mutant seem detected.
    """
    names = sorted(who_runs(mutant, lines))
    if mutant.at_import:
        return names
    runs: dict[str, set[int]] = {name: set() for name in names}
    for (file, line), who in lines.items():
        if file == mutant.file:
            for name in who & runs.keys():
                runs[name].add(line)
    groups: dict[frozenset[int], list[str]] = {}
    for name, ran in runs.items():
        groups.setdefault(frozenset(ran), []).append(name)
    return [name for group in groups.values() for name in group[:alike]]


def install(mutant: Mutant) -> None:
    """Import the mutant's file instead of the original file."""
    name = ".".join(mutant.file.relative_to(ROOT).with_suffix("").parts)
    spec = importlib.util.spec_from_loader(name, loader=None, origin=str(mutant.file))
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    module.__file__ = str(mutant.file)
    sys.modules[name] = module
    exec(compile(mutant.source, str(mutant.file), "exec"), module.__dict__)


def in_children(jobs: Iterable[Job], at_once: int) -> Iterator[tuple[Mutant, bool]]:
    """Run each job in a child process with its mutant.

    Yield whether each mutant was noticed, in the order of completion.
    """
    waiting = iter(jobs)
    running: dict[int, Mutant] = {}
    while True:
        while len(running) < at_once and (job := next(waiting, None)) is not None:
            running[_begin(job)] = job.mutant
        if not running:
            return
        pid, status = os.wait()
        if pid in running:
            survived = os.WIFEXITED(status) and os.WEXITSTATUS(status) == SURVIVED
            yield running.pop(pid), not survived


def _begin(job: Job) -> int:
    sys.stdout.flush()
    pid = os.fork()
    if pid:
        return pid
    code = KILLED
    try:
        resource.setrlimit(resource.RLIMIT_CPU, (LIMIT_S, LIMIT_S))
        _be_quiet()
        install(job.mutant)
        code = KILLED if job.notices() else SURVIVED
    finally:
        os._exit(code)


def _be_quiet() -> None:
    nothing = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1, 2):
        os.dup2(nothing, descriptor)
