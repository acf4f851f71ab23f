"""Measure how often reports name the true cause of a generated mistake, and how often they contain a false statement.

    python -m grader.benchmarks.causes [--count 200] [--seed 1] [--only OPERATOR ...] [--keep FOLDER | --again FOLDER]

The benchmark puts mistakes into correct packages with the operators of grader/tests/operators (two operators in a third
of the packages), and judges the packages in simulated time. The correct packages are four of the solutions, and cases
of tests/unusual that follow ROS time. Packages that pass despite the mistake are only counted. For all other packages,
the benchmark prints how often each of these statements is true:

- first: the first failed check names the cause and a line that must change;
- at all: any failed check names the cause in this way;
- false: a failed check names a wrong cause, or a false detail of a mistake. A diagnosis that only repeats what was
  observed does not count.

Each statement is checked in two ways: against the diagnoses that the operators expect, and against facts that do not
depend on diagnoses (the difference between the two packages, the source and the recording;
grader/tests/operators/facts.py). The benchmark also lists each wrong package whose first failed check missed the cause
or whose report has a false statement, with the difference from the correct package. `--keep` stores recordings, and
`--again` judges stored recordings instead of running packages. If a run with `--keep` is stopped, the next run
continues from there. At the end, the benchmark checks a few wrong packages without and with `--explain`, and prints the
ratio of the CPU times.
"""

from __future__ import annotations

import argparse
import dataclasses
import pickle
import re
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from grader.benchmarks.measure import cost
from grader.checks.edit import difference
from grader.checks.exercises import find_exercise
from grader.checks.judge import judge
from grader.checks.outcome import Status
from grader.common.words import count
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.sandbox import bubblewrap
from grader.submission.package import open_submission
from grader.tests.grading_here import Builds
from grader.tests.gradings import GRADER
from grader.tests.operators.facts import Facts
from grader.tests.operators.made import OPERATORS, Made, bases, make
from grader.tests.operators.sentences import false_sentences

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.checks.outcome import Outcome
    from grader.evidence.evidence import Evidence

OBSERVATIONS = frozenset(
    {
        "ended-early", "ends-at-once", "wrong-rate", "uneven-rate", "late-start", "stopped-early", "published-once",
        "logged-once", "too-few-commands", "too-few-log-lines", "no-commands", "not-moving", "turns-on-the-spot",
        "straight-line", "wall", "wrong-direction", "wrong-radius", "wrong-centre", "polygon", "not-round", "too-short",
        "stops-and-goes",
        "build-failed", "wrong-position", "wrong-distance",
    }
)  # fmt: skip
"""The diagnoses that only repeat what was observed, without naming a cause."""


@dataclass(frozen=True)
class Judged:
    """A wrong package with the outcomes of its checks, and the time that judging the package took (s)."""

    made: Made
    evidence: Evidence
    outcomes: tuple[Outcome, ...]
    seconds: float

    @property
    def failed(self) -> list[Outcome]:
        """The failed checks in the order of the report, except checks that only give advice."""
        return [each for each in self.outcomes if each.status is Status.FAILED and not each.advice]

    @property
    def first(self) -> bool:
        """Whether the first failed check names the actual cause."""
        return names(self.failed[0], self.made)

    @property
    def at_all(self) -> bool:
        """Whether any failed check names the cause."""
        return any(names(outcome, self.made) for outcome in self.failed)

    @property
    def false(self) -> bool:
        """Whether a failed check contains a false statement."""
        return any(is_false(outcome, self.made) for outcome in self.failed)

    @cached_property
    def facts(self) -> Facts:
        """Facts about the package that were determined without the tables of diagnoses."""
        return Facts(self.made.right, self.made.files, self.evidence)

    @property
    def contradicted(self) -> list[str]:
        """The statements of the report that contradict a fact."""
        return [sentence for outcome in self.failed for sentence in false_sentences(self.facts, outcome)]

    def marks(self) -> dict[str, bool]:
        """Return, for each statement that the benchmark counts, whether the statement is true for this package."""
        by_fact = [self.facts.names(outcome) for outcome in self.failed]
        return {
            "cause named first": self.first,
            "cause named at all": self.at_all,
            "false statements": self.false,
            "cause named first, checked against facts": by_fact[0],
            "cause named at all, checked against facts": any(by_fact),
            "false statements, checked against facts": bool(self.contradicted),
        }


def names(outcome: Outcome, made: Made) -> bool:
    """Return whether an outcome names one of the mistakes and a line that must change."""
    finding = outcome.finding
    for operator, change in made.mistakes:
        where = finding.where
        here = where is not None and where.file == change.file and (not change.lines or where.line in change.lines)
        if finding.diagnosis in operator.says and here:
            return True
    return False


def is_false(outcome: Outcome, made: Made) -> bool:
    """Return whether an outcome names a cause that is not one of the mistakes, or a false detail about a mistake."""
    finding = outcome.finding
    text = f"{finding.observed} {finding.cause}"
    if any(operator.never and re.search(operator.never, text) for operator, _ in made.mistakes):
        return True
    says = {diagnosis for operator, _ in made.mistakes for diagnosis in operator.says | operator.also}
    return finding.diagnosis not in says | OBSERVATIONS


def written(made: Made, folder: Path) -> Path:
    """Write a wrong package into the folder. Return the path of the submission."""
    for path, text in made.files.items():
        target = folder / made.name / "my_robot_controller" / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, "utf-8")
    return folder / made.name


def judged(made: Made, folder: Path, builds: Builds, keep: Path | None) -> Judged:
    """Judge a wrong package in simulated time."""
    submission = open_submission(written(made, folder))
    begun = time.monotonic()
    options = Options(bubblewrap.usable(), "simulated", trials_at_once=1)
    graded = grade(find_exercise(made.exercise), submission, options, build=builds)
    seconds = time.monotonic() - begun
    if keep is not None:
        mistakes = [(operator.name, change) for operator, change in made.mistakes]
        kept = (dataclasses.replace(made, mistakes=()), mistakes, dataclasses.replace(graded.evidence))
        unfinished = keep / f"{made.name}.unfinished"
        unfinished.write_bytes(pickle.dumps(kept))
        unfinished.replace(keep / f"{made.name}.pickle")
    return Judged(made, graded.evidence, graded.report.outcomes, seconds)


def once(made: Made, folder: Path, builds: Builds, keep: Path | None) -> Judged:
    """Judge a wrong package.

    If the recording of the package is already stored, judge the recording and do not run the package.
    """
    kept = keep and keep / f"{made.name}.pickle"
    return again(kept) if kept and kept.is_file() else judged(made, folder, builds, keep)


def again(kept: Path) -> Judged:
    """Judge a stored recording again."""
    made, mistakes, evidence = pickle.loads(kept.read_bytes())
    known = {operator.name: operator for operator in OPERATORS}
    made = dataclasses.replace(made, mistakes=tuple((known[name], change) for name, change in mistakes))
    begun = time.monotonic()
    return Judged(made, evidence, judge(evidence), time.monotonic() - begun)


def cost_of_explain(mades: Iterable[Made], folder: Path) -> float:
    """Return the CPU time of `grader check --explain` for these packages, divided by the CPU time of `grader check`."""
    with_s = without_s = 0.0
    for made in mades:
        check = [str(GRADER), "check", str(written(made, folder)), "--exercise", made.exercise, "--clock", "simulated"]
        # `grader check` exits with code 1 if the package is wrong.
        without_s += cost(["sh", "-c", '"$@" || true', "sh", *check]).cpu_s
        with_s += cost(["sh", "-c", '"$@" || true', "sh", *check, "--explain"]).cpu_s
    return with_s / without_s


def tell(all_: Iterable[Judged], *, everything: bool = False) -> None:
    """Print each wrong package whose first failed check missed the cause or whose report has a false statement.

    Then print the statistics.

    With `everything`, print every package that failed a check.
    """
    every = list(all_)
    wrong = [each for each in every if each.failed]
    for each in wrong:
        bad = [label for label, holds in each.marks().items() if holds == label.startswith("false")]
        if bad or everything:
            print(f"\n{each.made.name} {each.made.exercise} {each.made.operators}: {', '.join(bad)}")
            _explain(each)
    passed = [each.made.operators for each in every if not each.failed]
    for each in every:
        broken = [outcome.finding.observed for outcome in each.outcomes if outcome.status is Status.ERROR]
        if broken:
            print(f"\n{each.made.name} {each.made.operators}: error: {broken[0]}")
    print(f"\nstill passing: {len(passed)}" + (f" ({', '.join(sorted(set(passed)))})" if passed else ""))
    marks = [each.marks() for each in wrong]
    for label in marks[0] if marks else ():
        hits = sum(mark[label] for mark in marks)
        print(f"{label}: {hits} of {len(wrong)} ({100.0 * hits / len(wrong):.1f} %)")


def _explain(judged: Judged) -> None:
    """Print the changes to the package and the failed checks in the report."""
    encoded = [
        {path: text.encode() for path, text in files.items()} for files in (judged.made.right, judged.made.files)
    ]
    print("  " + difference({**dict.fromkeys(encoded[1], b""), **encoded[0]}, encoded[1]).replace("\n", "\n  "))
    gone = sorted(encoded[0].keys() - encoded[1].keys())
    if gone:
        print(f"  removed: {', '.join(gone)}")
    for outcome in judged.failed:
        finding = outcome.finding
        print(f"  {outcome.id} [{finding.diagnosis}] {finding.where}: {finding.observed} | {finding.cause}")
    if judged.contradicted:
        print(f"  false: {judged.contradicted}")


def main() -> None:
    """Create the wrong packages, judge them, and print the result."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--count", type=int, default=200, help="number of wrong packages to create")
    parser.add_argument("--seed", type=int, default=1, help="seed for the choice of packages and mistakes")
    parser.add_argument("--only", nargs="*", default=[], help="names of the operators to use (default: all)")
    parser.add_argument("--keep", type=Path, help="keep the recordings in this folder")
    parser.add_argument("--all", action="store_true", help="list all wrong packages, even those with a right report")
    parser.add_argument(
        "--again", type=Path, help="judge the recordings in this folder again, instead of running packages"
    )
    parser.add_argument(
        "--explained", type=int, default=8, help="number of packages for measuring the cost of --explain"
    )
    parser.add_argument("--workers", type=int, default=2, help="number of packages judged in parallel")
    wanted = parser.parse_args()
    operators = [operator for operator in OPERATORS if not wanted.only or operator.name in wanted.only]
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(wanted.workers) as pool:
        right = bases(Path(name) / "right")
        mades = [make(right, number, wanted.seed, operators) for number in range(wanted.count)]
        begun = time.monotonic()
        if wanted.again:
            found = [again(kept) for kept in sorted(wanted.again.glob("*.pickle"))]
        else:
            if wanted.keep:
                wanted.keep.mkdir(parents=True, exist_ok=True)
            builds = Builds()
            found = list(pool.map(lambda made: once(made, Path(name) / "made", builds, wanted.keep), mades))
        tell(found, everything=wanted.all)
        proved = [each.made for each in found if any(outcome.finding.fix for outcome in each.failed)][
            : wanted.explained
        ]
        if proved:
            ratio, packages = cost_of_explain(proved, Path(name) / "explained"), count(len(proved), "package")
            print(f"Testing the causes multiplies the CPU time of a check by {ratio:.2f} ({packages})")
        print(f"{len(right)} correct packages, seed {wanted.seed}: {time.monotonic() - begun:.0f} s")


if __name__ == "__main__":
    main()
