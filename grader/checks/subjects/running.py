"""Checks of the node: it starts and has the right name."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes import no_entry_point
from grader.checks.causes.crash import crash_of
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_ended import why_ended, why_no_node
from grader.checks.causes.why_node_name import why_node_name
from grader.checks.kind import Kind, NoParams
from grader.checks.outcome import Finding, Status, failed, passed
from grader.checks.subjects.entry_point import entry_point
from grader.common.words import a_list, nearest, shorten
from grader.evidence import activity
from grader.submission.constants import evaluate

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence


def starts(evidence: Evidence, _: NoParams) -> Finding:
    """A node of the submission appeared in the ROS graph, or called a callback, and ran until the scenario began."""
    recording = evidence.recording
    executable = evidence.trial.executable
    expected = "The node starts and runs until Ctrl-C."
    if executable not in evidence.built.executables:
        # An exercise may have no check of the entry point. `ros2 run` would not find the executable either.
        return entry_point(evidence, NoParams())
    if activity.ended_at_start(recording):
        crash = crash_of(evidence)
        if crash is not None:
            return crash_finding(evidence, crash, f"{executable} crashed at startup: {crash.observed}.", expected)
        why = why_ended(evidence)
        observed = f"{executable} exited on its own at startup."
        return failed(observed, expected, why)
    if not activity.nodes(recording) and not activity.spun(recording):
        return _no_node(evidence)
    return passed("The node starts.")


def _no_node(evidence: Evidence) -> Finding:
    crash = crash_of(evidence)
    observed = f"{evidence.trial.executable} ran, but no node appeared in the ROS graph."
    expected = "The program creates a node and spins it."
    if crash is not None:
        observed = f"{evidence.trial.executable} crashed before a node appeared in the ROS graph: {crash.observed}."
        return crash_finding(evidence, crash, observed, expected)
    why = why_no_node(evidence)
    return failed(observed, expected, why)


def name(evidence: Evidence, _: NoParams) -> Finding:
    """A node of the submission has the name that the exercise requires."""
    wanted = f"/{evidence.trial.node}"
    names = activity.nodes(evidence.recording)
    if not names and activity.spun(evidence.recording):
        # In wall time, a node can crash before other nodes discover it.
        names = _names_in_source(evidence)
        if not names:
            return Finding(Status.SKIPPED, "Not judged, because the node crashed before it appeared in the ROS graph.")
    if wanted in names:
        return passed(f"The node is named {evidence.trial.node}.")
    if not names:
        return failed(
            "No node appeared in the ROS graph.", f"A node named {evidence.trial.node} appears.", Cause("no-node")
        )
    guess = nearest(wanted, names) or names[0]
    observed = f"The node is named {shorten(guess)}."
    if len(names) > 1:
        observed = f"The nodes are named {a_list([shorten(each) for each in names])}."
    expected = f"The node is named {evidence.trial.node}."
    where = evidence.place("create_node", "__init__")
    if guess.endswith(wanted):
        return failed(observed, expected, Cause("node-namespace", "The node is in a namespace.", where))
    other = _other_module(evidence)
    if other is not None:
        return failed(observed, expected, other)
    return failed(observed, expected, why_node_name(evidence, guess.rpartition("/")[2]))


def _other_module(evidence: Evidence) -> Cause | None:
    """Return the cause if the entry point leads to a module, but another has the name of the executable, else None."""
    executable = evidence.trial.executable
    module = (evidence.entry_point() or "").partition(":")[0]
    folder, _, last = module.rpartition(".")
    file = f"{folder.replace('.', '/')}/{executable}.py"
    if not folder or last == executable or file not in evidence.submission.files:
        return None
    if any(each.file == file for each in evidence.code.modules):
        return None  # the module of the entry point imports the other one, so it can lead to the right node
    text = f"The entry point {executable} leads to {shorten(last)}.py, and the package also has a file {executable}.py."
    return Cause("entry-point-other", text, no_entry_point.line(evidence))


def _names_in_source(evidence: Evidence) -> tuple[str, ...]:
    """Return the names of the nodes that the source creates, each after a slash. Only constant names are included."""
    calls = [call for function in ("__init__", "create_node", "Node") for call in evidence.code.calls(function)]
    values = [evaluate(call.argument(0, "node_name"), call.module.names) for call in calls]
    return tuple(f"/{value}" for value in values if isinstance(value, str))


STARTS = Kind(
    "node_starts",
    "trial",
    "The node starts",
    NoParams,
    starts,
    about="The executable starts, its node appears in the ROS graph or calls a callback, and it runs until the "
    "scenario begins.",
)
NAME = Kind(
    "node_name",
    "trial",
    "The node has the right name",
    NoParams,
    name,
    about="The name of the node is the value of `node` in `[[trial]]`.",
)
