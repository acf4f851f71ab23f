"""The causes of a SyntaxError, from Python's message and the source."""

from __future__ import annotations

import pytest

from grader.checks.causes.syntax import MOST_GAPS, unreadable_finding
from grader.submission.code import Module, Unreadable, read_module
from grader.tests.checks.made import NODE_FILE, evidence, finding, submission

WORDS = {
    "(unicode error) 'unicodeescape' codec can't decode bytes in position 2-3": "syntax-error",
    "(unicode error) 'utf-8' codec can't decode byte 0xe4": "not-utf8",
    "inconsistent use of tabs and spaces in indentation": "tabs-and-spaces",
    "Missing parentheses in call to 'print'. Did you mean print(...)?": "python-2-print",
    "expected ':'": "colon-missing",
    "'(' was never closed": "bracket-open",
    "unmatched ')'": "bracket-extra",
    "closing parenthesis ']' does not match opening parenthesis '('": "bracket-extra",
    "unterminated string literal (detected at line 3)": "quote-open",
    "invalid character '\u201c' (U+201C)": "typographic-character",
    "invalid non-printable character U+00A0": "typographic-character",
    "unindent does not match any outer indentation level": "indentation",
    "unexpected indent": "indentation",
    "expected an indented block after function definition on line 3": "indentation",
    "invalid syntax. Perhaps you forgot a comma?": "comma-missing",
    "invalid syntax. Maybe you meant '==' or ':=' instead of '='?": "equals",
    "cannot assign to function call here.": "equals",
    "invalid syntax": "syntax-error",
}


@pytest.mark.parametrize(("words", "diagnosis"), WORDS.items())
def test_pythons_words_lead_to_the_mistake(words: str, diagnosis: str) -> None:
    found = unreadable_finding("a.py", Unreadable(words, 3), b"x = 1\n")
    assert (found.diagnosis, str(found.where)) == (diagnosis, "a.py:3")
    assert found.cause
    assert found.observed.startswith(f"Python cannot read a.py: {words[:20]}")
    assert found.observed[-1] in ".?!"
    assert not found.observed.endswith("..")


@pytest.mark.parametrize("mark", [b"<<<<<<< HEAD", b">>>>>>> main"])
def test_marks_of_a_conflict_are_reported_whatever_python_says(mark: bytes) -> None:
    found = unreadable_finding("a.py", Unreadable("expected ':'", 1), b"x = 1\n" + mark + b"\n")
    assert found.diagnosis == "merge-conflict"


@pytest.mark.parametrize(("line", "conflict"), [(4, True), (6, False)])
def test_a_heading_in_a_docstring_is_no_conflict(line: int, *, conflict: bool) -> None:
    data = b'"""The node\n\nDrawing\n=======\n"""\nx = (\n'
    assert (
        unreadable_finding("a.py", Unreadable("invalid syntax", line), data).diagnosis == "merge-conflict"
    ) == conflict


@pytest.mark.parametrize(("source", "reads"), [(b"def send(:\n", False), (b"def send():\n", True)])
def test_a_file_that_python_cannot_read_is_expected_to_be_valid(source: bytes, *, reads: bool) -> None:
    module = read_module(NODE_FILE, source + b"    pass\n\ndef main():\n    pass\n")
    assert (module.unreadable is None) == reads
    found = finding("entry-point", evidence(package=submission({NODE_FILE: source + b"    pass\nmain = send\n"})))
    assert (found.expected == "The file is valid Python.") == (not reads)


@pytest.mark.parametrize(
    ("message", "line", "found"),
    [
        ("invalid syntax", 2, True),
        ("invalid syntax", 1, False),
        ("positional argument follows keyword argument", 2, False),
    ],
)
def test_the_previous_line_is_mentioned_only_if_it_may_be_the_reason(message: str, line: int, *, found: bool) -> None:
    given = unreadable_finding("a.py", Unreadable(message, line), b"f(\nf(a=1, 2)\n")
    assert (given.cause == "The mistake is often on the previous line: a bracket, a colon or the indentation.") == found


@pytest.mark.parametrize(
    ("line", "between"),
    [
        ("f(String '~/status', 10)", "String and '~/status'"),
        ("f('~/status' 10)", "'~/status' and 10"),
        ("x = 1 2", None),
        ("f(a if b 10)", None),
        ("(1, 2) print 'now'", None),
    ],
)
def test_a_missing_comma_is_named_if_python_can_read_the_line_with_it(line: str, between: str | None) -> None:
    found = unreadable_finding("a.py", Unreadable("invalid syntax", 2), f"y = 0\n{line}\n".encode())
    assert found.diagnosis == ("syntax-error" if between is None else "comma-missing")
    assert ("A comma is missing between" in found.cause) == (between is not None)
    assert ("The mistake is on this line. Compare it with" in found.cause) == (between is None)
    assert between is None or between in found.cause


@pytest.mark.parametrize(
    "line", ["f(" + "a " * 180_000, "x = 'a' " * 40_000, "def " + " " * 350_000 + "x", "f(" + "1 " * 300]
)
def test_a_long_line_takes_no_time(line: str, monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[bytes] = []

    def counted(file: str, data: bytes) -> Module:
        read.append(data)
        return read_module(file, data)

    monkeypatch.setattr("grader.checks.causes.syntax.read_module", counted)
    found = unreadable_finding("a.py", Unreadable("invalid syntax", 1), line.encode())
    assert found.diagnosis == "syntax-error"
    assert len(read) <= MOST_GAPS + 5


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("    self,count += 1", "Write a dot: self.count."),
        ("    self , total.x -= step", "Write a dot: self.total."),
        ("from rclpy,node import Node", "write a dot, not a comma"),
        ("x = self,count + 1", None),
    ],
)
def test_a_comma_in_place_of_a_dot_is_named(line: str, words: str | None) -> None:
    found = unreadable_finding("a.py", Unreadable("invalid syntax", 1), f"{line}\n".encode())
    assert found.diagnosis == ("syntax-error" if words is None else "comma-for-dot")
    assert words is None or words in found.cause


@pytest.mark.parametrize(
    ("source", "line", "words"),
    [
        ("else if x:", "elif x:", "Python spells else if as one word: elif."),
        ("count++", "count += 1", "Python has no ++ and no --."),
        ("count --;", "count -= 1", "Python has no ++ and no --."),
        ("import Twist from a.msg", "from a.msg import Twist Pose", "from comes first: from MODULE import NAME."),
        ("// a comment", "/ a", "In Python, a comment begins with #."),
        ("msg = new Twist()", "msg = knew Twist()", "Python has no keyword new."),
        ("if x {", "if x }", "In Python, a block begins with a colon, not with a brace."),
        ("defsend(self):\n    pass", "default(1, :\n    pass", "A space is missing after def."),
        ("classNode(object):\n    pass", "classify(1, :\n    pass", "A space is missing after class."),
    ],
)
def test_a_line_that_python_cannot_read_is_explained(source: str, line: str, words: str) -> None:
    assert words in unreadable_finding("a.py", Unreadable("invalid syntax", 1), f"{source}\n".encode()).cause
    assert words not in unreadable_finding("a.py", Unreadable("invalid syntax", 1), f"{line}\n".encode()).cause


@pytest.mark.parametrize(
    ("file", "line", "found"),
    [
        ("setup.py", "first = a.b:main,", True),
        ("setup.py", '"first = a.b:main",', False),
        ("my_robot_controller/draw_circle.py", "x = msg.x:float", False),
    ],
)
def test_an_entry_point_without_quotation_marks_is_one_of_setup_py(file: str, line: str, *, found: bool) -> None:
    given = unreadable_finding(file, Unreadable("invalid syntax", 1), f"{line}\n".encode()).cause
    assert (given == "An entry point is a string, so it needs quotation marks.") == found


SAID = {
    "(unicode error) 'unicodeescape' codec can't decode bytes": "begins an escape sequence. Write \\\\ for",
    "(unicode error) 'utf-8' codec can't decode byte 0xe4": "Save the file as UTF-8.",
    "inconsistent use of tabs and spaces in indentation": "Tabs and spaces look alike but are different.",
    "Missing parentheses in call to 'print'. Did you mean print(...)?": "In Python 3, print is a function",
    "expected ':'": "with or else, must end with a colon.",
    "unmatched ')'": "There is one closing bracket too many, or it is the wrong kind of bracket.",
    "unterminated triple-quoted string literal": "A string that begins with three quotation marks must end with three.",
    "unterminated string literal": "A string must end on the same line",
    "unexpected indent": "All lines of a block must start at the same column",
    "invalid syntax. Perhaps you forgot a comma?": "Put a comma between two arguments",
    "cannot assign to function call here.": "= assigns a value to a name. == compares two values.",
    "'(' was never closed": "This bracket is never closed.",
    "invalid non-printable character U+00A0": "Such a character often comes from a word processor or a web page.",
}


@pytest.mark.parametrize(("message", "words"), SAID.items())
def test_each_message_of_python_has_its_own_sentence(message: str, words: str) -> None:
    found = {other: unreadable_finding("a.py", Unreadable(other, 1), b"x = 1\n").cause for other in SAID}
    assert [other for other, said in found.items() if words in said] == [message]


def test_what_another_line_causes_is_explained_there() -> None:
    data = b"def send():\nx = 1\n"
    empty = "expected an indented block after function definition on line 1"
    found = unreadable_finding("a.py", Unreadable(empty, 2), b"def send():\ndef other():\n")
    assert (str(found.where), "Line 1 has no body: no indented" in found.cause) == ("a.py:1", True)
    assert "has no body" not in unreadable_finding("a.py", Unreadable(empty, 2), data).cause
    other = "closing parenthesis ']' does not match opening parenthesis '(' on line 1"
    found = unreadable_finding("a.py", Unreadable(other, 2), b"f(1,\n]\n")
    assert (str(found.where), "The bracket ( from line 1 is still open" in found.cause) == ("a.py:1", True)
    same = "closing parenthesis ']' does not match opening parenthesis '('"
    assert "is still open" not in unreadable_finding("a.py", Unreadable(same, 2), b"f(1,\n]\n").cause
    conflict = b"<<<<<<< HEAD\nx = 1\n"
    words = "Git left two versions in the file"
    assert words in unreadable_finding("a.py", Unreadable("invalid syntax", 1), conflict).cause
    assert words not in unreadable_finding("a.py", Unreadable("invalid syntax", 1), b"# <<<<<<< HEAD\nx 1\n").cause


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("if x && y:", "is written as the word and."),
        ("if x and y y:", None),
        ('if x y == "&&":', None),
        ("while x || y || z:", "is written as the word or."),
        ("if x is not None;", "This line ends with a semicolon."),
        ("def send(self),", "This line ends with a comma."),
        ("except (A, B).", "This line ends with a dot."),
        ("for x y in z;", None),
        ("send(x y);", None),
    ],
)
def test_a_sign_is_blamed_if_python_can_read_the_line_without_it(line: str, words: str | None) -> None:
    source = f"try:\n    pass\n{line}\n    pass\n" if line.startswith("except") else f"{line}\n    pass\n"
    unreadable = read_module("a.py", source.encode()).unreadable
    assert unreadable is not None
    found = unreadable_finding("a.py", unreadable, source.encode())
    assert any(each in found.cause for each in ("as the word and", "as the word or", "ends with a ")) == (
        words is not None
    )
    assert words is None or (words in found.cause and found.fix)


@pytest.mark.parametrize(("first", "line"), [(b"# coding: raven\n", None), (b"x = 'a\n", 1)])
def test_a_message_about_the_whole_file_has_no_line(first: bytes, line: int | None) -> None:
    unreadable = read_module("a.py", first + b"y = 1\n").unreadable
    assert unreadable is not None
    assert unreadable.line == line  # Python reports line 0 for an unknown encoding


@pytest.mark.parametrize(("data", "found"), [(b"# coding: raven\n", True), (b"x = '\xe9'\n", False)])
def test_a_comment_with_an_unknown_encoding_is_named(data: bytes, *, found: bool) -> None:
    unreadable = read_module("a.py", data).unreadable
    assert unreadable is not None
    given = unreadable_finding("a.py", unreadable, data)
    assert given.diagnosis == "not-utf8"
    assert given.cause.startswith("The comment with the word coding names an unknown encoding.") == found


BELOW = "x = 1\n{}\ny = 2\n"


@pytest.mark.parametrize(
    ("line", "cause"),
    [
        ("def go self:\n    pass", "After def and the name, write parentheses."),
        ("x = 3x", "A name cannot begin with a digit, and no letter can follow a number directly."),
        ("def go(a=1, b):\n    pass", "The parameters with a default value come after all parameters without a"),
        ("x = 05", "Write a number without a zero before it: 5, not 05."),
        ("x = {1: 2, 3}", "Each entry of a dictionary has a key, a colon and a value."),
        ('x = f"{}"', "In an f-string, write { before a value and } after it."),
        ("try:\n    pass\nx = 1", "After a try block, write except or finally, with the same indentation as try."),
        ("try:\n    pass\nexcept A, e:\n    pass", "To give the exception a name, write as: except ValueError as e."),
        ("x = 1 if y", "This form needs an else: VALUE if CONDITION else OTHER_VALUE."),
        ("self.a := 5", "Only a plain name can be before :=. To assign a value on a line of its own, write =."),
        ("f(a=1, 2)", "In a call, the arguments with a name and = come after all arguments without a name."),
        ("elseif x == 1:\n    pass", "Python spells else if as one word: elif."),
        ("f(Twist, /turtle1/cmd_vel, 10)", "A topic name is a string, so it needs quotation marks."),
        ("/* comment */", "In Python, a comment begins with #."),
        ("try:\n    pass\ncatch A:\n    pass", "Python has no keyword catch. It has except."),
        ("function go(self):\n    pass", "In Python, a function begins with the keyword def."),
        ("Class A:\n    pass", "Python has its keywords in small letters, such as class, def, if and import."),
        ("int n = 5", "In Python, no word such as var or int comes before the name of a variable."),
        ("class A extends B:\n    pass", "In Python, the base class is in parentheses: class NAME(BASE)."),
        ("if x == 1 then:\n    pass", "Python has no then and no do. A colon ends this line."),
        ("if x => 1:\n    pass", "Python compares with ==, !=, <, <=, > and >=."),
        ("self->x = 1", "In Python, a dot comes before an attribute, not ->."),
        ("self.class = 1", "A keyword of Python, such as class or import, cannot be the name of a variable."),
        ("x = self..y", "The mistake is on this line. Compare it with a similar line that works, character by"),
        ("elif x == 1:\n    pass", "The mistake is often on the previous line: a bracket, a colon or the indentation."),
    ],
)
def test_a_frequent_mistake_is_explained_by_its_rule(line: str, cause: str) -> None:
    source = BELOW.format(line).encode()
    unreadable = read_module("a.py", source).unreadable
    assert unreadable is not None
    assert unreadable_finding("a.py", unreadable, source).cause.startswith(cause)
