"""Objects of the wrong kind, each with a line or a message that is nearly the same."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import LOOK, line_with, reported

NODE = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.kill = self.create_client({kind}, "/kill")
        self.turn = ActionClient(self, RotateAbsolute, "/turtle1/rotate_absolute")

    def send(self, name):
        {first}
        {line}  # crashed
"""


def cause(line: str, error: str, first: str = "pass", kind: str = "Kill") -> str:
    return reported(NODE.format(line=line, first=first, kind=kind), error).cause


CALL = "self.kill.call_async(request)"
GOAL = "self.turn.send_goal_async(goal)"
FORMAT = "TypeError: unsupported format string passed to {}.__format__"


@pytest.mark.parametrize(
    ("line", "first", "error", "words", "told"),
    [
        (
            CALL,
            "pass",
            "TypeError",
            "self.kill has the type Kill, so call_async needs an object of Kill.Request.",
            True,
        ),
        (CALL, "pass", "TypeError: bad", "self.kill has the type Kill", False),
        ("self.spawn.call_async(request)", "pass", "TypeError", "has the type", False),
        (
            "self.clients[0].call_async(request)",
            "self.clients[0] = self.create_client(Kill, name)",
            "TypeError",
            "has the type",
            False,
        ),
        (CALL, "request = Kill.Request", "TypeError", "Kill.Request is a class. Add parentheses after", True),
        (CALL, "request = Kill.Request()", "TypeError", "Kill.Request is a class.", False),
        (GOAL, "goal = RotateAbsolute.Goal", "TypeError", "RotateAbsolute.Goal is a class. Add parentheses", True),
        (GOAL, "pass", "TypeError", "self.turn has the type RotateAbsolute, so send_goal_async needs an object", True),
        ("print(f'{x:.2f}')", "pass", FORMAT.format("NoneType"), "A value in this line is None, which cannot", True),
        (
            "print(f'{x:.2f}')",
            "pass",
            FORMAT.format("RotateAbsolute_Feedback"),
            "A value in this line is a feedback message. A format such as .2f or >10 needs a number or a string.",
            True,
        ),
        ("print(f'{x:.2f}')", "pass", FORMAT.format("Pose"), "A value in this line is an object of type Pose", True),
        ("print(f'{x:.2f}')", "pass", "TypeError: bad operand", "A value in this line is", False),
        ("self.places[pose]", "pass", "TypeError: unhashable type: 'Pose'", "A Pose cannot be the key of", True),
        ("self.places[pose]", "pass", "TypeError: unhashable type: 'list'", "cannot be the key of", False),
        ("min(self.places)", "pass", "TypeError: 'Pose' object is not iterable", "This value is one Pose, but", True),
        ("min(self.places)", "pass", "TypeError: 'int' object is not iterable", "This value is one Pose", False),
        (
            "AnyReader(Path(folder))",
            "pass",
            "TypeError: 'PosixPath' object is not iterable",
            "AnyReader takes a list of paths. Write square brackets, even for one path.",
            True,
        ),
        ("sum(Path(folder))", "pass", "TypeError: 'PosixPath' object is not iterable", "AnyReader takes", False),
        (
            "AnyReader([folder])",
            "pass",
            "AttributeError: 'str' object has no attribute 'exists'",
            "AnyReader takes a list of Path objects, not of strings.",
            True,
        ),
        ("find([folder])", "pass", "AttributeError: 'str' object has no attribute 'exists'", "AnyReader takes", False),
        (
            "reader.messages()",
            "with AnyReader([path]) as reader: pass",
            "rosbags.highlevel.anyreader.AnyReaderError: AnyReader is not open.",
            "The bag is open only inside the with block of AnyReader. Indent the lines that read",
            True,
        ),
        (
            "reader.messages()",
            "reader = AnyReader([path])",
            "rosbags.highlevel.anyreader.AnyReaderError: AnyReader is not open.",
            "The bag is not open here. A with statement opens it: with AnyReader([path]) as reader.",
            True,
        ),
        (
            "reader.messages()",
            "reader = AnyReader([path])",
            "rosbags.highlevel.anyreader.AnyReaderError: AnyReader is not open.",
            "Indent the lines that read",
            False,
        ),
        (
            "reader.messages()",
            "pass",
            "rosbags.highlevel.anyreader.AnyReaderError: No such bag.",
            "The bag is open only inside",
            False,
        ),
        (
            'self.create_subscription(Pose, "/{name}/pose", self.send, 10)',
            "pass",
            "RCLError: failed to resolve name: unknown substitution: {name}, at /a.c:1",
            "The name contains {name} itself. An f-string or the method format replaces the braces.",
            True,
        ),
        ("self.create_subscription()", "pass", "RCLError: failed to resolve name", "itself. An f-string", False),
        (
            "msg.x = [1.0, 2.0]",
            "pass",
            "AssertionError: The 'x' field must be of type 'float'",
            "The field x is a float, but the value is a list. Assign one number.",
            True,
        ),
        (
            "msg.x = {}",
            "pass",
            "AssertionError: The 'x' field must be of type 'float'",
            "but the value is a dictionary. Assign one number.",
            True,
        ),
        (
            "msg.x = speed",
            "pass",
            "AssertionError: The 'x' field must be of type 'float'",
            "but the value is a list",
            False,
        ),
    ],
)
def test_an_object_of_the_wrong_kind_is_told(line: str, first: str, error: str, words: str, *, told: bool) -> None:
    assert (words in cause(line, error, first)) == told


CALLED = """\
class Driver(Node):
    def ask(self):
        future.add_done_callback(self.answered{given}){look}

    def answered(self, future):
        print(future.result())  # crashed
        return{returned}
"""


@pytest.mark.parametrize(
    ("given", "returned", "told"), [("(name)", "", True), ("", "", False), ("(name)", " lambda future: None", False)]
)
def test_a_callback_that_was_called_at_once_is_told(given: str, returned: str, *, told: bool) -> None:
    source = CALLED.format(given=given, returned=returned, look="  # look" if told else "")
    found = reported(source, "AttributeError: 'str' object has no attribute 'result'", caller=3)
    words = "add_done_callback needs the method itself. With () after its name, the method is called immediately."
    assert (words in found.cause, found.line == line_with(LOOK, source)) == (told, told)
