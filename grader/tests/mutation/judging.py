"""Judge recorded cases again, by the grader's checks as they are or with one file of them changed.

The checks are imported in a child of this process, after it was forked: so each mutant is the only one that its process
ever knew, and whatever it does ends with it.
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
"""Who runs a line (from 1) of a file."""

PACKAGE = "grader.checks"
SHARED = "grader.checks.outcome"
"""What reports are made of, by everybody: no mutants are made of it, and its Status must stay the same object."""
SURVIVED, KILLED = 0, 1
LIMIT_S = 60
"""CPU time after which a mutant is one that never ends, which is noticed as well; a loaded machine changes nothing."""


@dataclass(frozen=True)
class Material:
    """A case and what it is judged from; `observed` is Evidence of the checks that were imported first."""

    name: str
    case: Case
    observed: Evidence
    ros: str


@dataclass(frozen=True)
class Job:
    """A mutant, and who may notice it: a function that is called where the mutant is installed."""

    mutant: Mutant
    notices: Callable[[], bool]


def load(recorded: Iterable[Recorded]) -> list[Material]:
    """Read recordings; then forget the checks, so that whoever imports them next gets them fresh."""
    from grader.checks.exercises import load_exercise
    from grader.evidence.recording_format import load as open_archive

    loaded = []
    for each in recorded:
        archived = open_archive(each.folder, load_exercise)
        loaded.append(Material(each.name, each.case, archived.evidence, archived.ros))
    # What checks import late is imported here, once for all mutants.
    import catkin_pkg.package  # type: ignore[import-untyped]  # noqa: F401

    forget()
    return loaded


def forget() -> None:
    """Forget the checks."""
    for name in [name for name in sys.modules if name.startswith(f"{PACKAGE}.") and name != SHARED]:
        del sys.modules[name]


def fails(material: Material) -> bool:
    """Whether the case no longer gets the report that it expects, by the checks as they are imported now."""
    try:
        compare(material.case, _graded(material))
    except Exception:  # (an AssertionError of the case, or whatever a mutant made break)
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
    """The same, made of the classes as they are imported now, with nothing kept from an earlier judging."""
    from grader.evidence.evidence import Evidence as Anew
    from grader.evidence.evidence import Fault

    fault = None if observed.fault is None else Fault(observed.fault.stage, observed.fault.message)
    plain = {field.name: getattr(observed, field.name) for field in dataclasses.fields(observed)}
    return Anew(**{**plain, "fault": fault})


def touched(materials: Iterable[Material], files: Collection[Path]) -> Lines:
    """The names of the cases that run each line (from 1) of these files, as far as any does."""
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
    """Who ran which line, of what was measured with a context each."""
    data = measured.get_data()
    return {
        (file, line): {name for name in names if name}
        for file in files
        for line, names in data.contexts_by_lineno(str(file)).items()
    }


def who_runs(mutant: Mutant, lines: Lines) -> set[str]:
    """Who runs the mutant's lines; of what is run when the file is imported, whoever runs anything of the file."""
    if mutant.at_import:
        return {name for (file, _), names in lines.items() if file == mutant.file for name in names}
    numbers = range(mutant.line, mutant.end_line + 1)
    return {name for number in numbers for name in lines.get((mutant.file, number), ())}


def requested(mutant: Mutant, lines: Lines, alike: int) -> list[str]:
    """Of those who run the mutant's lines, at most so many that are alike: that run the same lines of its file.

    Hundreds of cases pass a check in the same way. So a mutant may seem to survive that one of the others would notice,
    never the other way round.
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
    """Import the changed file in place of the grader's own."""
    name = ".".join(mutant.file.relative_to(ROOT).with_suffix("").parts)
    spec = importlib.util.spec_from_loader(name, loader=None, origin=str(mutant.file))
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    module.__file__ = str(mutant.file)
    sys.modules[name] = module
    exec(compile(mutant.source, str(mutant.file), "exec"), module.__dict__)


def in_children(jobs: Iterable[Job], at_once: int) -> Iterator[tuple[Mutant, bool]]:
    """Run each job in a child that has installed its mutant; yields whether it was noticed, as they end."""
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
