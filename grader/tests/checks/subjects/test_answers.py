from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.answers import ANSWERS, GRAPH, LIST, RATE, TEXT
from grader.errors import MachineError
from grader.evidence.evidence import Run
from grader.tests.checks.made import evidence, found, recording, submission
from grader.tests.checks.told import told
from grader.trial.recording import Endpoint, Graph, Message

if TYPE_CHECKING:
    from grader.checks.kind import Kind
    from grader.evidence.evidence import Evidence

COFFEE = Graph(
    0.0,
    ("/kitchen/cook", "/waiter"),
    (
        Endpoint("publisher", "/kitchen/cook", "/cups", "std_msgs/msg/String"),
        Endpoint("subscription", "/waiter", "/cups", "std_msgs/msg/String"),
        Endpoint("publisher", "/waiter", "/bills", "std_msgs/msg/Float32"),
        Endpoint("publisher", "/waiter", "/rosout", "rcl_interfaces/msg/Log"),
    ),
)
TOPIC = {"find": "topic", "among": "publisher", "type_ends": "/String"}
NODES = {"find": "node", "among": "all", "form": "list"}


def given(answers: str | None, **changes: Any) -> Evidence:  # noqa: ANN401
    """Return evidence with a graph of two nodes, the answer `name = ...`, and one message every 0.25 s."""
    beats = tuple(Message("/cups", "std_msgs/msg/String", b"", 0.25 * beat, 0.25 * beat) for beat in range(1, 40))
    trial = recording([], graphs=(COFFEE,), messages=beats)
    text = None if answers is None else f"[answers]\n{answers}\n"
    return replace(evidence(trial, submission({"answers.toml": text})), **changes)


def judged(kind: Kind[Any], answer: str, **values: Any) -> Finding:  # noqa: ANN401
    return found(kind, given(f"name = {answer}"), answer="name", **values)


@pytest.mark.parametrize(
    ("answers", "diagnosis"),
    [
        (None, "no-answers"),
        ("name = word", "answers-unreadable"),
        ("", "answers-empty"),
        ("node = 1\nother = 2", None),
        ("lines = 1\nnade = 2", "unknown-answer"),
    ],
)
def test_the_file_is_looked_at_before_its_answers(answers: str | None, diagnosis: str) -> None:
    checks = (replace(evidence().exercise.checks[0], params={"answer": "node"}),)
    exercise = replace(evidence().exercise, checks=checks)
    finding = found(ANSWERS, given(answers, exercise=exercise))
    assert (finding.status is Status.FAILED, finding.diagnosis) == (diagnosis is not None, diagnosis)
    if diagnosis is None:
        return
    if diagnosis == "unknown-answer":
        assert finding.observed == "answers.toml contains nade, but no question of this step has that name."
    line = {"unknown-answer": "answers.toml:3", "answers-unreadable": "answers.toml:2", "no-answers": "None"}.get(
        str(diagnosis), "answers.toml"
    )
    assert str(finding.where) == line


def test_answers_to_the_questions_of_another_step_do_not_matter() -> None:
    def judge(answers: str) -> Finding:
        checks = tuple(replace(evidence().exercise.checks[0], params={"answer": name}) for name in ("node", "rate"))
        return found(ANSWERS, given(answers, exercise=replace(evidence().exercise, id="11-bags", checks=checks)))

    assert judge('overlay = "install"\nnode = "a"\nrate = 0').status is Status.PASSED
    finding = judge('overlay = "install"')
    assert finding.observed == "answers.toml has no line for node and rate."
    assert finding.cause == "`grader start 11` prints the lines that you need."
    finding = judge('overlay = "install"\nnode = "a"\nrates = 3')
    assert finding.observed == "answers.toml contains rates, but no question of this step has that name."
    assert (finding.cause, str(finding.where)) == ("There is no line for rate.", "answers.toml:4")


@pytest.mark.parametrize("answer", ['"left"', '"  LEFT "', '"to the   Left"'])
def test_capitals_and_spaces_of_words_do_not_matter(answer: str) -> None:
    assert judged(TEXT, answer, accepts=("left", "to the left")).status is Status.PASSED


def test_other_words_are_shown_with_the_authors_reason_and_the_line() -> None:
    finding = judged(TEXT, '"right"', accepts=("left",), cause="Look at the sign.")
    assert (finding.observed, finding.cause) == ('name is "right".', "Look at the sign.")
    assert str(finding.where) == "answers.toml:2"
    assert "left" not in finding.expected


@pytest.mark.parametrize("kind", [TEXT, LIST, GRAPH, RATE])
def test_no_answer_and_one_of_another_form_are_reported(kind: Kind[Any]) -> None:
    values: dict[str, Any] = {"answer": "name"}
    if kind is TEXT:
        values |= {"accepts": ("a",)}
    elif kind is LIST:
        values |= {"items": ("a",)}
    else:
        values |= {"type_ends": "/String"} if kind is RATE else TOPIC
    for answers in ('other = "a"', None):
        nothing = found(kind, given(answers), **values)
        assert (nothing.diagnosis, str(nothing.where)) == ("no-answer", "answers.toml")
    other = "1.5" if kind is not RATE else '"4"'
    finding = found(kind, given(f"name = {other}"), **values)
    assert (finding.diagnosis, str(finding.where)) == ("answer-form", "answers.toml:2")
    assert finding.observed == f"name is {other}."


@pytest.mark.parametrize(
    ("answer", "reported", "diagnosis"),
    [
        ('["y", "x"]', None, None),
        ('["x", "y", "y"]', None, None),
        ('["x"]', "name is [x]: 1 missing.", "list-incomplete"),
        ('["x", "y", "z"]', "name is [x, y, z]: 1 too many.", "list-too-long"),
        ('["x", "z"]', "name is [x, z]: 1 too many and 1 missing.", "wrong-list"),
    ],
)
def test_a_list_is_compared_whatever_its_order(answer: str, reported: str | None, diagnosis: str | None) -> None:
    finding = judged(LIST, answer, items=("x", "y"))
    assert (finding.status is Status.PASSED, finding.diagnosis) == (reported is None, diagnosis)
    if reported:
        assert (finding.observed, str(finding.where)) == (reported, "answers.toml:2")


@pytest.mark.parametrize(
    ("answer", "values", "diagnosis"),
    [
        ('"/cups"', TOPIC, None),
        ('"cups"', TOPIC, "no-slash"),
        ('"/Cups"', TOPIC, "capitals"),
        ('"/bills"', TOPIC, "answer-another"),
        ('"/rosout"', {"find": "topic"}, "answer-another"),
        ('"/bills"', {"find": "topic", "node": "/waiter"}, None),
        ('"/cups"', {"find": "topic", "among": "subscription"}, None),
        ('"/cups"', {"find": "topic", "among": "publisher", "connected_to": "/waiter"}, None),
        ('"/bills"', {"find": "topic", "among": "publisher", "connected_to": "/waiter"}, "answer-another"),
        ('"std_msgs/msg/String"', {"find": "type", "node": "/kitchen/cook"}, None),
        ('"std_msgs/String"', {"find": "type", "node": "/kitchen/cook"}, "type-without-msg"),
        ('"String"', {"find": "type", "node": "/kitchen/cook"}, "type-without-package"),
        ('["/waiter", "/kitchen/cook"]', NODES, None),
        ('["/waiter"]', NODES, "list-incomplete"),
        ('"kitchen/cook"', {"find": "node", "among": "publisher", "type_ends": "/String"}, "no-slash"),
        ('"/waiter"', {"find": "node", "type_starts": "rcl_"}, None),
        ('"/cups"', {"find": "topic", "type_starts": "std_", "type_ends": "/Float32"}, "answer-another"),
        ('"/nowhere"', TOPIC, "wrong-answer"),
    ],
)
def test_the_truth_is_the_graph_as_it_was_recorded(answer: str, values: dict[str, str], diagnosis: str | None) -> None:
    assert judged(GRAPH, answer, **values).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("answer", "values", "judged_too"),
    [
        ('"/bills"', {"connected_to": "/nobody"}, False),
        ('"/rosout"', {"type_starts": "rcl_"}, False),
        ('"/bills"', {"connected_to": "/waiter"}, True),
    ],
)
def test_an_answer_is_not_judged_if_the_graph_has_no_right_answer(
    answer: str, values: dict[str, str], *, judged_too: bool
) -> None:
    finding = judged(GRAPH, answer, find="topic", among="publisher", **values)
    assert finding.status is (Status.FAILED if judged_too else Status.SKIPPED)
    assert ("during the trial no topic matched the description in the question" in finding.observed) != judged_too
    assert ("exists, but it is not the one" in finding.cause) == judged_too


def test_another_graph_has_other_right_answers() -> None:
    renamed = replace(COFFEE, endpoints=(Endpoint("publisher", "/cook", "/mugs", "std_msgs/msg/String"),))
    trial = recording([], graphs=(renamed,))
    mugs = given('name = "/mugs"').with_run(Run(trial))
    assert found(GRAPH, mugs, answer="name", **TOPIC).status is Status.PASSED
    cups = given('name = "/cups"').with_run(Run(trial))
    assert found(GRAPH, cups, answer="name", **TOPIC).diagnosis == "wrong-answer"


@pytest.mark.parametrize(
    ("answer", "diagnosis"),
    [
        ("4", None),
        ("4.1", None),
        ("3.8", None),
        ("5", "wrong-answer"),
        ("4.19", None),
        ("4.21", "wrong-answer"),
        ("0.25", "period-for-rate"),
        ("0.2386", "period-for-rate"),
        ("0.2378", "wrong-answer"),
        ("-4", "wrong-answer"),
    ],
)
def test_a_rate_is_compared_with_the_one_that_was_measured(answer: str, diagnosis: str | None) -> None:
    assert judged(RATE, answer, type_ends="/String").diagnosis == diagnosis


def test_without_messages_there_is_no_rate_to_compare_with() -> None:
    words = "Too few messages were recorded to measure the rate with which the answer is compared."
    with pytest.raises(MachineError, match=words):
        judged(RATE, "4", type_ends="/Float64")
    assert words not in judged(RATE, "4", type_ends="/String").observed


def test_a_long_answer_is_shortened_in_the_message() -> None:
    finding = judged(TEXT, f'"{"x" * 5000}"', accepts=("left",))
    assert len(finding.observed) < 200


LISTED = {"items": ("x", "y")}
WORD = {"accepts": ("left",)}
PLAIN = {"find": "type", "node": "/kitchen/cook"}


@pytest.mark.parametrize(
    ("words", "kind", "values", "true", "near"),
    [
        ("name is not answered yet.", TEXT, WORD, '""', "true"),
        ("name is not a string in quotation marks.", TEXT, WORD, "true", '""'),
        ('Write the answer in this form: `name = "answer"`.', TEXT, WORD, "1.5", '"right"'),
        ("name is a string in quotation marks.", TEXT, WORD, "1.5", '"right"'),
        ("name is the right answer to this question.", TEXT, WORD, '"right"', '"left"'),
        ("name is a list of strings in quotation marks.", LIST, LISTED, '"x"', '["x"]'),
        ("The list contains all correct items, and no other items.", LIST, LISTED, '["x"]', '["x", "y"]'),
        ("name is a number without quotation marks.", RATE, {"type_ends": "/String"}, '"4"', "5"),
        ("name is the rate that `ros2 topic hz` measures.", RATE, {"type_ends": "/String"}, "5", "4"),
        ("`ros2 topic hz` shows the number of messages per second.", RATE, {"type_ends": "/String"}, "5", "0.25"),
        (
            "name is the topic that the question asks for, spelled as `ros2` prints it.",
            GRAPH,
            TOPIC,
            '"cups"',
            '"/cups"',
        ),
        ("In ROS 2 a type has three parts: the package, the word msg,", GRAPH, PLAIN, '"std_msgs/String"', '"String"'),
        ("The full name of a type starts with its package", GRAPH, PLAIN, '"String"', '"std_msgs/String"'),
        ("The full name of a topic starts with a slash.", GRAPH, TOPIC, '"cups"', '"Cups"'),
        ("This topic exists, but it is not the one", GRAPH, TOPIC, '"/bills"', '"/nowhere"'),
    ],
)
def test_a_sentence_about_an_answer_is_true(
    words: str, kind: Kind[Any], values: dict[str, Any], true: str, near: str
) -> None:
    assert words in told(judged(kind, true, **values))
    assert words not in told(judged(kind, near, **values))


def about_file(answers: str | None, *questions: str) -> str:
    check = evidence().exercise.checks[0]
    checks = tuple(replace(check, params={"answer": name}) for name in questions)
    return told(found(ANSWERS, given(answers, exercise=replace(evidence().exercise, checks=checks))))


def test_a_sentence_about_the_file_with_the_answers_is_true() -> None:
    form = "answers.toml is a TOML file with a table [answers] and one line per question."
    assert form in about_file(None, "node")
    assert form not in about_file("node = 1", "node")
    assert "answers.toml has no answers yet." in about_file('node = ""', "node")
    assert "answers.toml has no answers yet." not in about_file("node = true", "node")
    assert "There is no line for topic." in about_file("node = 1\ntropic = 2", "node", "topic")
    assert "There is no line for topic." not in about_file("node = 1\ntropic = 2\ntopic = 3", "node", "topic")
    assert "prints the lines that you need" in about_file("node = 1\nnade = 2", "node", "topic")
    assert "prints the lines that you need" not in about_file("node = 1\ntopic = 2\nnade = 2", "node", "topic")
