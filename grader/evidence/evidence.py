"""Evidence: all that a check may look at."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from grader.evidence import activity
from grader.evidence.arrivals import Measured, measure_arrivals
from grader.evidence.trajectory import Trajectory, trajectory_of
from grader.evidence.tries import Tries
from grader.submission.answers import Answers, read_answers
from grader.submission.code import Code, module_file, read_code
from grader.submission.package_xml import Manifest, read_manifest
from grader.submission.setup_py import SetupPy, read_setup_py

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.colcon.build import Build
    from grader.evidence.stage import Stage
    from grader.exercise.model import Exercise, TrialSpec
    from grader.submission.package import Submission
    from grader.submission.where import Where
    from grader.trial.recording import Command, Recording


@dataclass(frozen=True)
class Fault:
    """Why `stage` and all later ones could not be done: a fault of the machine, and what to do.

    `unreadable`: not the machine's, but what the submission has made could not be read.
    """

    stage: Stage
    message: str
    unreadable: bool = False


@dataclass(frozen=True)
class Run:
    """What came of one trial; nothing as long as it was not made."""

    recording: Recording | None = None
    overwhelmed: str | None = None
    """How the node brought the simulator down, twice; then there is no recording."""


@dataclass(frozen=True)
class Evidence:
    """A submission and what was observed of it; `build` is None as long as it was not made.

    A check looks at it from one of the exercise's trials: `trial` says which, `recording` is what that one saw.
    What the source files say is read on first use, from `submission.files` alone.
    """

    exercise: Exercise
    submission: Submission
    build: Build | None = None
    runs: Mapping[str, Run] = field(default_factory=dict)
    """What came of the trials, by their ids; those that were not made yet are left out."""
    fault: Fault | None = None
    tries: Tries = field(default_factory=Tries)
    """What came of trying to mend the causes."""
    trial_id: str = ""
    """The trial that it is looked at from; empty for the exercise's first."""

    def __getstate__(self) -> dict[str, Any]:
        """What is handed to another process: not what was read on first use."""
        return {each.name: getattr(self, each.name) for each in fields(self)}

    @property
    def trial(self) -> TrialSpec:
        """The trial that it is looked at from."""
        return self.exercise.trial(self.trial_id) if self.trial_id else self.exercise.trials[0]

    @property
    def run(self) -> Run:
        """What came of this trial."""
        return self.runs.get(self.trial.id, Run())

    def from_trial(self, id_: str) -> Evidence:
        """The same, looked at from this trial."""
        return self if id_ == self.trial.id else self._views[id_]

    def views(self) -> tuple[Evidence, ...]:
        """The same, looked at from each trial that was run; from the first in any case."""
        ids = [trial.id for trial in self.exercise.trials]
        return tuple(self.from_trial(id_) for id_ in ids if id_ in self.runs or id_ == ids[0])

    def with_run(self, run: Run) -> Evidence:
        """The same, with what came of this trial."""
        return replace(self, runs={**self.runs, self.trial.id: run})

    @cached_property
    def _views(self) -> dict[str, Evidence]:
        return {trial.id: replace(self, trial_id=trial.id) for trial in self.exercise.trials}

    @cached_property
    def manifest(self) -> Manifest | None:
        """What package.xml says; None when there is no package.xml."""
        data = self.submission.files.get("package.xml")
        return None if data is None else read_manifest(data)

    @cached_property
    def setup_py(self) -> SetupPy | None:
        """What setup.py says, read without running it; None when there is no setup.py."""
        data = self.submission.files.get("setup.py")
        return None if data is None else read_setup_py(data)

    @cached_property
    def answers(self) -> Answers | None:
        """What answers.toml says; None when there is no answers.toml."""
        data = self.submission.files.get("answers.toml")
        return None if data is None else read_answers(data)

    @cached_property
    def node_file(self) -> str | None:
        """The file of the exercise's node: where the entry point leads, else the file named after the executable."""
        target = self.entry_point()
        files = self.submission.files
        if target is not None:
            found = module_file(target.partition(":")[0].strip(), files)
            if found is not None:
                return found
        named = sorted(path for path in files if path.rpartition("/")[2] == f"{self.trial.executable}.py")
        return named[0] if named else None

    @cached_property
    def code(self) -> Code:
        """What the node's file says, and the files that it imports."""
        return read_code(self.submission.files, first=self.node_file)

    @cached_property
    def commands(self) -> tuple[Command, ...]:
        """The commands that arrived before SIGINT."""
        return activity.commands(self.recording)

    @cached_property
    def command_arrivals(self) -> Measured:
        """The arrivals of these commands, and the intervals between them."""
        return measure_arrivals(self.recording, (command.t_s for command in self.commands))

    @cached_property
    def trajectory(self) -> Trajectory:
        """The trajectory of the turtle until SIGINT."""
        return trajectory_of(self.recording)

    def entry_point(self) -> str | None:
        """Return "module:attribute" of the exercise's executable: as installed, else as setup.py says."""
        executable = self.trial.executable
        if self.build is not None and executable in self.build.entry_points:
            return self.build.entry_points[executable]
        declared = self.setup_py.entry_point(executable) if self.setup_py is not None else None
        return declared.target if declared is not None else None

    @property
    def recording(self) -> Recording:
        """What this trial saw; only for checks of the stage "trial", which are not judged without it."""
        if self.run.recording is None:
            message = "a check of a trial was judged without a recording"
            raise ValueError(message)
        return self.run.recording

    @property
    def built(self) -> Build:
        """The build; only for checks of the stages "build" and "trial"."""
        if self.build is None:
            message = "a check of a build was judged without a build"
            raise ValueError(message)
        return self.build

    def place(self, *calls: str) -> Where | None:
        """Where in the submission one of these functions is called, the first that is; else the node's file."""
        for name in calls:
            found = self.code.calls(name)
            if found:
                return found[0].where
        return self.code.start
