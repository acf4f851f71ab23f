"""Checks of answers.toml: compare the student's answers with expected answers, or with the recorded graph and rates."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.answer_spelling import bare, matching, plain
from grader.checks.cause import Cause
from grader.checks.causes.why_answer import KEEP_LOOKING, why_list, why_name, why_unreadable
from grader.checks.kind import Kind, NoParams, choice, number, string, strings
from grader.checks.outcome import Finding, Status, failed, passed
from grader.checks.tolerance import Band
from grader.common.words import a_list, nearest, shorten
from grader.errors import MachineError
from grader.evidence import activity
from grader.submission.answers_toml import FILE, Answer
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Collection

    from grader.checks.diagnosis import Diagnosis
    from grader.evidence.evidence import Evidence
    from grader.trial.recording import Endpoint, Recording

KEY = "the name of the answer in answers.toml"
STRING = "a string in quotation marks"
LIST_OF_STRINGS = "a list of strings in quotation marks"
NUMBER = "a number without quotation marks"
EXAMPLES = {STRING: '"answer"', LIST_OF_STRINGS: '["first", "second"]', NUMBER: "12.5"}
"""Maps each form of an answer to an example."""


def answers(evidence: Evidence, _: NoParams) -> Finding:
    """answers.toml can be read and has an answer. If it has other names too, it has a line for each question."""
    found = evidence.answers
    expected = f"{FILE} is a TOML file with a table [answers] and one line per question."
    if found is None:
        return failed(f"There is no {FILE}.", expected, Cause("no-answers"))
    if found.problem is not None:
        source = evidence.submission.files.get(FILE, b"")
        why = Cause("answers-unreadable", why_unreadable(source, found.line), Where(FILE, found.line))
        return failed(f"{FILE} cannot be read: {found.problem}.", expected, why)
    questions = {str(check.params["answer"]) for check in evidence.exercise.checks if "answer" in check.params}
    named = set(found.given) | found.unusable
    missing, other = sorted(questions - named - found.lines.keys()), sorted(named - questions)
    if missing and other:  # in a workspace, the file may also contain the answers of other steps
        names = a_list(missing, most=len(missing))
        if misspelt := [name for name in other if nearest(name, missing)]:
            observed = f"{FILE} contains {a_list([shorten(name) for name in misspelt])}, "
            observed += f"but no question of this step has {'that name' if len(misspelt) == 1 else 'these names'}."
            where = Where(FILE, found.lines.get(misspelt[0]))
            return failed(observed, expected, Cause("unknown-answer", f"There is no line for {names}.", where))
        reason = f"`grader start {evidence.exercise.id[:2]}` prints the lines that you need."
        return failed(f"{FILE} has no line for {names}.", expected, Cause("unknown-answer", reason, Where(FILE)))
    if not named:
        return failed(f"{FILE} has no answers yet.", expected, Cause("answers-empty", where=Where(FILE)))
    return passed(f"{FILE} can be read.")


@dataclass(frozen=True, kw_only=True)
class OneOf:
    """The correct strings. Capitals, the number of spaces, quotation marks and final punctuation do not matter."""

    answer: str = string(KEY, about="The name of the answer in answers.toml.")
    accepts: tuple[str, ...] = strings(
        about="The accepted answers. Upper and lower case do not matter, and several spaces count as one. Quotation "
        "marks around the answer and punctuation after it do not matter."
    )
    cause: str = string("a reason", default=" ", about="The reason that the student reads if the answer is wrong.")


def answer_text(evidence: Evidence, params: OneOf) -> Finding:
    """The answer is one of the correct strings."""
    given = _given(evidence, params.answer, STRING, str)
    if isinstance(given, Finding):
        return given
    if matching(str(given), params.accepts) in {plain(each) for each in params.accepts}:
        return passed(f'"{shorten(str(given))}" is right.')
    expected = f"{params.answer} is the right answer to this question."
    return _wrong(evidence, params.answer, given, expected, Cause("wrong-answer", params.cause.strip()))


@dataclass(frozen=True, kw_only=True)
class AllOf:
    """The strings that the student's list must contain, in any order and with any capitals, and no other string."""

    answer: str = string(KEY, about="The name of the answer in answers.toml.")
    items: tuple[str, ...] = strings(about="All items of the right answer, in any order.")
    cause: str = string("a reason", default=" ", about="The reason that the student reads if the answer is wrong.")


def answer_list(evidence: Evidence, params: AllOf) -> Finding:
    """The answer is a list that contains all correct strings and no other string."""
    given = _given(evidence, params.answer, LIST_OF_STRINGS, tuple)
    return given if isinstance(given, Finding) else _compare(evidence, params.answer, given, params.items, params.cause)


@dataclass(frozen=True, kw_only=True)
class GraphQuestion:
    """A question about the topics, types or nodes in the ROS graph. Only endpoints that match all parameters count.

    If `connected_to` is set, a topic counts only if the node with that name has an endpoint of the opposite kind on
    the topic (of any kind if `among` is "all").
    """

    answer: str = string(KEY, about="The name of the answer in answers.toml.")
    find: str = choice(
        "topic", "type", "node", about="What the question asks for: the topic, the type or the node of each endpoint."
    )
    among: str = choice("publisher", "subscription", "all", about="The kind of endpoint that counts.")
    node: str = string("a node's full name", start="/", default="", about="Only endpoints of this node count.")
    type_starts: str = string(
        "the beginning of a type name", default="", about="Only types that start with this string count."
    )
    type_ends: str = string("the end of a type name", default="", about="Only types that end with this string count.")
    connected_to: str = string(
        "a node's full name",
        start="/",
        default="",
        about='A topic counts only if this node has an endpoint of the opposite kind (with "all", of any kind) on it.',
    )
    form: str = choice("text", "list", about="Whether the answer is a single string or a list of all matching strings.")


def answer_graph(evidence: Evidence, params: GraphQuestion) -> Finding:
    """The answer matches the ROS graph during the trial."""
    truth = _right_answers(evidence.recording, params)
    if params.form == "list":
        given = _given(evidence, params.answer, LIST_OF_STRINGS, tuple)
        return given if isinstance(given, Finding) else _compare(evidence, params.answer, given, truth, KEEP_LOOKING)
    given = _given(evidence, params.answer, STRING, str)
    if isinstance(given, Finding):
        return given
    answer = bare(str(given))  # no name in the graph contains spaces or punctuation
    if answer in truth:
        return passed(f"{shorten(answer)} is right.")
    if not truth:
        # The node is not yet as the question describes it, and another check says why. No answer could be right.
        text = f"Not judged, because during the trial no {params.find} matched the description in the question."
        return Finding(Status.SKIPPED, text)
    expected = f"{params.answer} is the {params.find} that the question asks for, spelled as `ros2` prints it."
    why = why_name(answer, params.find, truth, _all(evidence.recording, params.find))
    return _wrong(evidence, params.answer, given, expected, why)


def _right_answers(recording: Recording, params: GraphQuestion) -> tuple[str, ...]:
    endpoints = [end for graph in recording.graphs for end in graph.endpoints if _counts(end, params)]
    if params.connected_to:
        both = [end for graph in recording.graphs for end in graph.endpoints if end.node == params.connected_to]
        other = {(end.topic, end.type) for end in both if end.kind != params.among}
        endpoints = [end for end in endpoints if (end.topic, end.type) in other]
    return tuple(sorted({getattr(end, params.find) for end in endpoints}))


def _all(recording: Recording, find: str) -> set[str]:
    """Return all topics, types or nodes of the graph, depending on `find`."""
    return {getattr(end, find) for graph in recording.graphs for end in graph.endpoints}


def _counts(end: Endpoint, params: GraphQuestion) -> bool:
    return (
        (params.find == "node" or end.topic not in activity.ROS_TOPICS)
        and params.among in (end.kind, "all")
        and params.node in (end.node, "")
        and end.type.startswith(params.type_starts)
        and end.type.endswith(params.type_ends)
    )


@dataclass(frozen=True, kw_only=True)
class AnswerRate:
    """The mean rate (Hz) of the messages whose type name ends with `type_ends`."""

    answer: str = string(KEY, about="The name of the answer in answers.toml.")
    type_ends: str = string("the end of a type name", about="Only messages whose type ends with this string count.")
    tolerance_percent: float = number(5.0, above=0, at_most=100, about="The maximum error in the answer.")


def answer_rate(evidence: Evidence, params: AnswerRate) -> Finding:
    """The answer is the rate (Hz) measured in the trial. Raises MachineError if no rate was measured."""
    arrivals = [each.t_s for each in evidence.recording.messages if each.type.endswith(params.type_ends)]
    steps = [later - earlier for earlier, later in pairwise(arrivals)]
    if not any(steps):
        # The course uses this check only in trials without a student's node, so the machine is at fault.
        message = "Too few messages were recorded to measure the rate with which the answer is compared. Try again."
        raise MachineError(message)
    truth = len(steps) / sum(steps)
    given = _given(evidence, params.answer, NUMBER, float)
    if isinstance(given, Finding):
        return given
    assert isinstance(given, float)
    if Band.around(truth, truth * params.tolerance_percent / 100.0).holds(given):
        return passed(f"{given:g} Hz is right.")
    why = Cause("wrong-answer", "`ros2 topic hz` shows the number of messages per second.")
    # The answer cannot be 0 here: the handout contains 0 for an answer that is still missing.
    if Band.around(truth, truth * params.tolerance_percent / 100.0).holds(1.0 / given):
        text = "This is the period, the time between two messages in seconds. The rate is 1 divided by the period."
        why = Cause("period-for-rate", text)
    return _wrong(evidence, params.answer, given, f"{params.answer} is the rate that `ros2 topic hz` measures.", why)


def _given(evidence: Evidence, name: str, form: str, kind: type) -> Answer | Finding:
    """Return the answer, or a failed finding if the answer is missing or has the wrong type."""
    found = evidence.answers
    where = Where(FILE, found.lines.get(name) if found is not None else None)
    answer = found.given.get(name) if found is not None else None
    unusable = found is not None and name in found.unusable
    if answer is None and not unusable:
        return failed(f"{name} is not answered yet.", f"{name} is {form}.", Cause("no-answer", where=where))
    if answer is None or not isinstance(answer, kind):
        observed = f"{name} is not {form}." if answer is None else f"{name} is {shown_answer(answer)}."
        cause = f"Write the answer in this form: `{name} = {EXAMPLES[form]}`."
        return failed(observed, f"{name} is {form}.", Cause("answer-form", cause, where))
    return answer


def _compare(evidence: Evidence, name: str, given: Answer, truth: Collection[str], cause: str) -> Finding:
    assert isinstance(given, tuple)
    answers_, right = {matching(each, truth) for each in given}, {plain(each) for each in truth}
    if answers_ == right:
        return passed(f"Right: {a_list(sorted(given))}.")
    surplus, missing = len(answers_ - right), len(right - answers_)
    parts = [f"{surplus} too many" if surplus else "", f"{missing} missing" if missing else ""]
    difference = " and ".join(part for part in parts if part)
    where = Where(FILE, evidence.answers.lines.get(name) if evidence.answers is not None else None)
    observed = f"{name} is {shown_answer(given)}: {difference}."
    diagnosis: Diagnosis = "wrong-list" if surplus and missing else "list-too-long" if surplus else "list-incomplete"
    expected = "The list contains all correct items, and no other items."
    why = why_list([bare(each) for each in given], truth) or Cause(diagnosis, cause.strip())
    return failed(observed, expected, why.at(where))


def _wrong(evidence: Evidence, name: str, given: Answer, expected: str, why: Cause) -> Finding:
    where = Where(FILE, evidence.answers.lines.get(name) if evidence.answers is not None else None)
    return failed(f"{name} is {shown_answer(given)}.", expected, why.at(where))


def shown_answer(answer: Answer) -> str:
    """Return an answer as text for a finding."""
    if isinstance(answer, tuple):
        shown = [f'"{shorten(each, 30)}"' if "," in each else shorten(each, 30) for each in answer[:8]]
        return f"[{', '.join(shown)}]"
    return f'"{shorten(answer)}"' if isinstance(answer, str) else f"{answer:g}"


ANSWERS = Kind(
    "answers",
    "source",
    "answers.toml can be read",
    NoParams,
    answers,
    about="`answers.toml` exists, is valid TOML, and contains an answer. If it contains answers with other names, such "
    "as those of an earlier step, it also has a line for each question of the exercise.",
)
TEXT = Kind(
    "answer_text", "source", "The answer is right", OneOf, answer_text, about="The answer is one of the given strings."
)
LIST = Kind(
    "answer_list",
    "source",
    "The answers are right",
    AllOf,
    answer_list,
    about="The answer is a list of the given strings and no others, in any order. Upper and lower case do not matter.",
)
GRAPH = Kind(
    "answer_graph",
    "trial",
    "The answer matches the ROS graph",
    GraphQuestion,
    answer_graph,
    about="The answer matches the ROS graph during the trial. The topics /rosout, /parameter_events and /clock count "
    "only if the question asks for nodes.",
)
RATE = Kind(
    "answer_rate",
    "trial",
    "The rate matches the measurement",
    AnswerRate,
    answer_rate,
    about="The answer is the rate (Hz) that was measured in the trial.",
)
