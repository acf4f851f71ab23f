"""Evidence: everything that a check may use."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from grader.evidence import activity
from grader.evidence.arrivals import Measured, measure_arrivals
from grader.evidence.late_exit import with_crash_first
from grader.evidence.trajectory import Trajectory, trajectory_of
from grader.evidence.tries import Tries
from grader.submission.answers_toml import Answers, read_answers
from grader.submission.bag_folder import BagFolder, read_bag
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
    from grader.testbench.result import BenchResult
    from grader.trial.called import Called
    from grader.trial.recording import Command, Recording


@dataclass(frozen=True)
class Fault:
    """The reason why `stage` and all later stages could not be completed: a fault of the machine, and its remedy.

    If `unreadable` is set, the machine is not at fault: something that the submission produced could not be read.
    """

    stage: Stage
    message: str
    unreadable: bool = False


@dataclass(frozen=True)
class Run:
    """The result of one trial. All fields are None if the trial was not run."""

    recording: Recording | None = None
    overwhelmed: str | None = None
    """How the simulator failed, if the node is considered the cause. There is no recording in that case."""
    called: tuple[Called, ...] | None = None
    """The results of the calls in a trial without a simulator. There is no recording in that case."""
    bench: BenchResult | None = None
    """The result of the student's tests, for a trial that runs them. There is no recording in that case."""

    @property
    def made(self) -> bool:
        """Whether the trial was completed."""
        return self.recording is not None or self.called is not None or self.bench is not None


@dataclass(frozen=True)
class Evidence:
    """A submission with everything that was observed. `build` is None if the submission was not built.

    A check gets the evidence from the viewpoint of one of the exercise's trials: `trial` is this trial, and `recording`
    is the recording of this trial. The source files are parsed on first use, from `submission.files`.
    """

    exercise: Exercise
    submission: Submission
    build: Build | None = None
    runs: Mapping[str, Run] = field(default_factory=dict)
    """The results of the trials that were run, by their ids."""
    fault: Fault | None = None
    tries: Tries = field(default_factory=Tries)
    """The changes that were tested because each may fix the cause of a failed check, and their results."""
    trial_id: str = ""
    """The id of the trial that this evidence is about; empty for the first trial of the exercise."""

    def __getstate__(self) -> dict[str, Any]:
        """Return only the fields. Cached values are not sent to another process."""
        return {each.name: getattr(self, each.name) for each in fields(self)}

    @property
    def trial(self) -> TrialSpec:
        """The trial that this evidence is about."""
        return self.exercise.trial(self.trial_id) if self.trial_id else self.exercise.trials[0]

    @property
    def run(self) -> Run:
        """The result of this trial."""
        return self.runs.get(self.trial.id, Run())

    def from_trial(self, id_: str) -> Evidence:
        """Return the same evidence from the viewpoint of this trial."""
        return self if id_ == self.trial.id else self._views[id_]

    def views(self) -> tuple[Evidence, ...]:
        """Return a view of the evidence for the first trial, and a view for each other trial that was run."""
        ids = [trial.id for trial in self.exercise.trials]
        return tuple(self.from_trial(id_) for id_ in ids if id_ in self.runs or id_ == ids[0])

    def with_run(self, run: Run) -> Evidence:
        """Return the evidence with the result of this trial, for its own node and for the other nodes that it runs."""
        specs = (self.trial, *self.exercise.beside(self.trial.id))
        return replace(self, runs={**self.runs, **{spec.id: _seen_by(spec, run, specs) for spec in specs}})

    @cached_property
    def _views(self) -> dict[str, Evidence]:
        return {trial.id: replace(self, trial_id=trial.id) for trial in self.exercise.trials}

    @cached_property
    def manifest(self) -> Manifest | None:
        """The content of package.xml, or None if there is no package.xml."""
        data = self.submission.files.get("package.xml")
        return None if data is None else read_manifest(data)

    @cached_property
    def setup_py(self) -> SetupPy | None:
        """The content of setup.py, read without running it, or None if there is no setup.py."""
        data = self.submission.files.get("setup.py")
        return None if data is None else read_setup_py(data)

    @cached_property
    def answers(self) -> Answers | None:
        """The content of answers.toml, or None if there is no answers.toml."""
        data = self.submission.files.get("answers.toml")
        return None if data is None else read_answers(data)

    def bag(self, folder: str) -> BagFolder:
        """Return the bag in this folder of the submission."""
        if folder not in self._bags:
            self._bags[folder] = read_bag(self.submission.files, folder)
        return self._bags[folder]

    @cached_property
    def _bags(self) -> dict[str, BagFolder]:
        return {}

    @cached_property
    def node_file(self) -> str | None:
        """The source file of the node or of the function that the trial calls, or None.

        This is the module of the entry point or of the function, or else the file named after the executable.
        """
        target = self.trial.calls.function or self.entry_point()
        files = self.submission.files
        if target is not None:
            found = module_file(target.partition(":")[0].strip(), files)
            if found is not None:
                return found
        named = sorted(path for path in files if path.rpartition("/")[2] == f"{self.trial.executable}.py")
        return named[0] if named else None

    @cached_property
    def code(self) -> Code:
        """The code of the node's file and of the submission's files that it imports (see `Code`)."""
        return read_code(self.submission.files, first=self.node_file)

    @cached_property
    def commands(self) -> tuple[Command, ...]:
        """The commands that arrived before the end of the scenario (see `activity.commands`)."""
        return activity.commands(self.recording)

    @cached_property
    def command_arrivals(self) -> Measured:
        """The arrivals of `commands`, and the intervals between these arrivals."""
        return measure_arrivals(self.recording, (command.t_s for command in self.commands))

    @cached_property
    def trajectory(self) -> Trajectory:
        """The trajectory of the turtle (see `trajectory_of`)."""
        return trajectory_of(self.recording)

    def entry_point(self) -> str | None:
        """Return the executable's entry point "module:attribute" as installed, or as setup.py defines it, or None."""
        executable = self.trial.executable
        if self.build is not None and executable in self.build.entry_points:
            return self.build.entry_points[executable]
        declared = self.setup_py.entry_point(executable) if self.setup_py is not None else None
        return declared.target if declared is not None else None

    @property
    def recording(self) -> Recording:
        """The recording of this trial.

        Only checks of the stage "trial" may use the recording, since other checks are also judged without a recording.
        """
        if self.run.recording is None:
            message = "a check of a trial was judged without a recording"
            raise ValueError(message)
        return self.run.recording

    def called(self, id_: str) -> Called:
        """Return the result of the call with this id.

        Only checks of a trial without a simulator may use this result.
        """
        found = [each for each in self.run.called or () if each.id == id_]
        if not found:
            message = f"a check was judged without the call {id_}"
            raise ValueError(message)
        return found[0]

    @property
    def bench(self) -> BenchResult:
        """The result of the student's tests. Only checks of a trial that runs tests may use this result."""
        if self.run.bench is None:
            message = "a check of tests was judged without the result of the tests"
            raise ValueError(message)
        return self.run.bench

    @property
    def built(self) -> Build:
        """The result of the build. Only checks of the stages "build" and "trial" may use the result."""
        if self.build is None:
            message = "a check of a build was judged without a build"
            raise ValueError(message)
        return self.build

    def place(self, *calls: str) -> Where | None:
        """Return the place of the first call to one of these functions, which are tried in the given order.

        If the code calls none of them, return the node's file, or None.
        """
        for name in calls:
            found = self.code.calls(name)
            if found:
                return found[0].where
        return self.code.start


def _seen_by(spec: TrialSpec, run: Run, specs: tuple[TrialSpec, ...]) -> Run:
    """Return the result of a trial from the viewpoint of one of its nodes.

    The other nodes in this trial are treated like nodes of the grader.
    """
    recording = run.recording
    if recording is None:
        return run
    if spec.beside:
        recording = recording.seen_from(spec.executable)
    others = tuple(f"/{each.node}" for each in specs if each is not spec)
    return replace(run, recording=with_crash_first(replace(recording, own_nodes=(*recording.own_nodes, *others))))
