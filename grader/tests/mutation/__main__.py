"""Run `python -m grader.tests.mutation [FILE...]` to print the changes that no case notices, and their share."""

from __future__ import annotations

import argparse
import os
import re
import shutil
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from grader.tests.case import ROOT
from grader.tests.mutation import equivalent, judging, unit
from grader.tests.mutation.mutants import KINDS, mutants_of
from grader.tests.mutation.recordings import all_cases, recordings

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from grader.tests.mutation.mutants import Mutant
    from grader.tests.mutation.recordings import Recorded

CHECKS = ROOT / "grader" / "checks"
MAKES_DIAGNOSES = re.compile(r"\b(failed|Cause)\(|diagnosis")
NOT_THESE = frozenset({"judge.py", "kind.py", "kinds.py"})
"""Modules that only pass diagnoses on."""
ALIKE_CASES, ALIKE_TESTS = 3, 12
"""The number of cases, and of tests, that are run on a mutant if they cover the same lines as others. More tests than
cases are run, because tests differ more."""
WORST = 0.10
"""If a larger share of the mutants survives, the run fails."""


def diagnosis_files() -> list[Path]:
    """Return the files of the checks that create diagnoses."""
    return [
        file
        for file in sorted(CHECKS.rglob("*.py"))
        if file.name not in NOT_THESE and MAKES_DIAGNOSES.search(file.read_text("utf-8"))
    ]


def main(argv: Sequence[str] | None = None) -> int:
    """Run the mutation test. The exit code is 1 if more than a tenth of the mutants survive."""
    requested = _arguments(argv)
    begun = time.monotonic()
    files = [path.resolve() for path in requested.files] or diagnosis_files()
    mutants = [mutant for file in files for mutant in mutants_of(file)][:: requested.every]
    equal = equivalent.read()
    counted = [mutant for mutant in mutants if not equivalent.is_known(mutant, equal)]
    by_case = counted if requested.units else _unnoticed_by_cases(counted, files, requested)
    survivors = (
        by_case if requested.cases else _unnoticed(by_case, unit.touched(files), ALIKE_TESTS, unit.fail, requested.jobs)
    )
    _print(files, counted, by_case, survivors, len(mutants) - len(counted))
    _tell(f"{time.monotonic() - begun:.0f} s")
    return 1 if len(survivors) > WORST * len(counted) else 0


def _unnoticed_by_cases(
    mutants: Sequence[Mutant], files: Sequence[Path], requested: argparse.Namespace
) -> list[Mutant]:
    materials = _materials(make=not requested.recorded)
    _tell(f"{len(materials)} cases, {len(files)} files")
    lines = judging.touched(materials.values(), files)
    survived = _unnoticed(mutants, lines, ALIKE_CASES, _by_cases(materials), requested.jobs)
    _tell(f"no case notices {len(survived)} of {len(mutants)}")
    return survived


def _materials(*, make: bool) -> dict[str, judging.Material]:
    """Return the cases by name, without cases whose recording does not give the expected report.

    The report can differ from the expected report if the machine was busy while the case was recorded. With `make`, a
    case whose recording gives another report is recorded again.
    """
    recorded = recordings(all_cases(), _tell, make=make)
    good, stale = _judged(recorded)
    if make and stale:
        for each in stale:
            shutil.rmtree(each.folder)
        more, stale = _judged(recordings([each.case for each in stale], _tell))
        good |= more
    for each in stale:
        _tell(f"{each.name} is left out: its recording does not give the expected report")
    return good


def _judged(recorded: Sequence[Recorded]) -> tuple[dict[str, judging.Material], list[Recorded]]:
    """Return the cases that get the expected report, by name, and all other cases."""
    good = {each.name: each for each in judging.load(recorded) if not judging.fails(each)}
    judging.forget()
    return good, [each for each in recorded if each.name not in good]


def _by_cases(materials: Mapping[str, judging.Material]) -> Callable[[Iterable[str]], bool]:
    return lambda names: any(judging.fails(materials[name]) for name in sorted(names))


def _unnoticed(
    mutants: Sequence[Mutant],
    lines: judging.Lines,
    alike: int,
    notice: Callable[[Iterable[str]], bool],
    at_once: int,
) -> list[Mutant]:
    """Return the mutants that no test notices. Run at most `alike` of the tests that cover the same lines."""

    def job(mutant: Mutant) -> judging.Job:
        names = judging.requested(mutant, lines, alike)
        return judging.Job(mutant, lambda: notice(names))

    survived: list[Mutant] = []
    for number, (mutant, noticed) in enumerate(judging.in_children(map(job, mutants), at_once), 1):
        if not noticed:
            survived.append(mutant)
        if number % 200 == 0:
            _tell(f"{number} of {len(mutants)}: {len(survived)} survived")
    return survived


def _arguments(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m grader.tests.mutation",
        description="Change the code that creates diagnoses, one place at a time. Print the unnoticed changes.",
        epilog="example: python -m grader.tests.mutation grader/checks/subjects/rate.py",
    )
    parser.add_argument(
        "files",
        nargs="*",
        type=Path,
        metavar="FILE",
        help="change only these files (default: all that create diagnoses)",
    )
    parser.add_argument(
        "-j",
        "--jobs",
        type=int,
        default=os.cpu_count() or 1,
        help="the number of parallel jobs (default: one per processor)",
    )
    parser.add_argument("--recorded", action="store_true", help="use only stored recordings")
    only = parser.add_mutually_exclusive_group()
    only.add_argument(
        "--cases", action="store_true", help="do not run the unit tests of the checks, which take longest"
    )
    only.add_argument("--units", action="store_true", help="do not use the cases and their recordings")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="use only every Nth mutant, for an estimate")
    return parser.parse_args(argv)


def _print(
    files: list[Path], mutants: list[Mutant], by_case: list[Mutant], survivors: list[Mutant], known: int
) -> None:
    for mutant in sorted(survivors, key=lambda each: (each.file, each.line)):
        print(mutant)
    print(f"\n{'file':<20} mutants  no case  survived")
    for file in files:
        of_file = [sum(mutant.file == file for mutant in each) for each in (mutants, by_case, survivors)]
        print(f"{file.name:<20} {of_file[0]:>7}  {of_file[1]:>7}  {of_file[2]:>8}")
    print(f"\n{'change':<20} mutants  no case  survived")
    for kind in KINDS:
        of_kind = [sum(mutant.kind == kind for mutant in each) for each in (mutants, by_case, survivors)]
        print(f"{kind:<20} {of_kind[0]:>7}  {of_kind[1]:>7}  {of_kind[2]:>8}")
    share, cases = (len(each) / len(mutants) if mutants else 0.0 for each in (survivors, by_case))
    print(
        f"\n{len(mutants)} mutants, {len(mutants) - len(survivors)} killed, {len(survivors)} survived: {share:.1%}\n"
        f"Without the tests of single checks {cases:.1%} would; {known} more are known to change nothing."
    )


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
