"""A NameError for a name that has a value elsewhere: in a global statement, in another function, or as a parameter."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported

NO_NAME = "NameError: name '{}' is not defined"
GLOBAL = "def a():\n    global pose\n    pose = 1\n\ndef b():\n    print(pose)  # crashed\n"
PARAMETER = "def a(msg):\n    print(msg)\n\ndef b():\n    print(msg)  # crashed\n"


def test_a_global_variable_is_not_called_a_local_one() -> None:
    found = reported(GLOBAL, NO_NAME.format("pose"))
    text = "pose gets its value on line 3, in a. That line has not run yet."
    assert (found.diagnosis, found.cause) == ("name-too-early", text)
    assert reported(GLOBAL.replace("    global pose\n", ""), NO_NAME.format("pose")).diagnosis == "local-name"


def test_a_parameter_of_another_function_is_named() -> None:
    found = reported(PARAMETER, NO_NAME.format("msg"))
    text = "msg is a parameter of a (line 1), and exists only in that function."
    assert (found.diagnosis, found.cause) == ("local-name", text)
    here = reported("def a(step):\n    print(msg)  # crashed\n", NO_NAME.format("msg"))
    assert here.cause.startswith("Nothing defines this name before this line.")


@pytest.mark.parametrize(("line", "found"), [("pass", True), ("global ticks", False)])
def test_a_global_counter_is_not_called_a_local_variable_of_init(line: str, *, found: bool) -> None:
    source = "class A:\n    def __init__(self):\n        {}\n        ticks = 0\n\n    def b(self):\n"
    source += "        ticks += 1  # crashed\n"
    error = "UnboundLocalError: cannot access local variable 'ticks' where it is not associated with a value"
    assert ("local variable of __init__" in reported(source.format(line), error).cause) == found


def test_a_function_outside_a_class_is_not_told_to_use_self() -> None:
    error = "UnboundLocalError: cannot access local variable 'n' where it is not associated with a value"
    given = reported("def count():\n    n += 1  # crashed\n", error).cause
    assert given == "A variable that a function assigns to is local to that function. Give n a value before this line."


@pytest.mark.parametrize(("stored", "found"), [("dist = 1.0", False), ("other = 1.0", True)])
def test_a_name_of_the_file_is_not_called_one_of_math(stored: str, *, found: bool) -> None:
    source = f"def a():\n    {stored}\n\ndef b():\n    print(dist)  # crashed\n"
    given = reported(source, NO_NAME.format("dist")).cause
    assert (given == "The file does not import dist, which is in the module math.") == found
    assert ("dist is a local variable of a (line 2)." in given) != found


@pytest.mark.parametrize(("begin", "found"), [("def main():", True), ("class A:\n  def send():", False)])
def test_a_function_outside_a_class_has_no_self(begin: str, *, found: bool) -> None:
    given = reported(f"{begin}\n    self.count = 1  # crashed\n", NO_NAME.format("self")).cause
    assert given.startswith("self exists only inside a method.") == found


@pytest.mark.parametrize(("line", "found"), [("n = 1", True), ("m = 1", False)])
def test_a_line_that_has_not_run_is_named_for_a_local_variable(line: str, *, found: bool) -> None:
    error = "UnboundLocalError: cannot access local variable 'n' where it is not associated with a value"
    source = f"def a(b):\n    if b:\n        {line}\n    print(n)  # crashed\n    n = 2\n"
    given = reported(source, error).cause
    assert (given == "Line 3 gives n a value, but that line has not run in this call.") == found


@pytest.mark.parametrize(
    ("source", "name", "cause"),
    [
        (
            "try:\n    a()\nexcept OSError as e:\n    pass\nprint(e)  # crashed\n",
            "e",
            (
                "Python deletes e at the end of the except block that begins on line 3. Inside this block, store the "
                "value under another name."
            ),
        ),
        ("x = 1\ndel x\nprint(x)  # crashed\n", "x", "Line 2 deletes x, so x has no value here."),
        (
            "match a:\n    case [first, *others]:\n        pass\nprint(others)  # crashed\n",
            "others",
            "Line 2 gives others a value, but others has none here. Perhaps that line has not run.",
        ),
        ("print(rest)  # crashed\na, *rest = b\n", "rest", "rest gets its value on line 2, after this line."),
        ("print(f)  # crashed\nwith a as f:\n    pass\n", "f", "f gets its value on line 2, after this line."),
        (
            "if a and (n := 3):\n    pass\nprint(n)  # crashed\n",
            "n",
            "Line 1 gives n a value, but n has none here. Perhaps that line has not run.",
        ),
        (
            "for step in []:\n    pass\nprint(step)  # crashed\n",
            "step",
            "step gets a value only if the loop on line 1 has at least one item.",
        ),
        (
            "try:\n    import numpy as np\nexcept ImportError:\n    pass\nprint(np)  # crashed\n",
            "np",
            "Line 2 imports np, but this import has not run, or has failed.",
        ),
        ("print(np)  # crashed\nimport numpy as np\n", "np", "Line 2 imports np, after this line."),
        (
            "def a():\n    import numpy as np\nprint(np)  # crashed\n",
            "np",
            (
                "Line 2 imports np inside a, so the name does not exist in other functions. Import it at the top of "
                "the file."
            ),
        ),
        (
            "xs = [each for each in range(3)]\nprint(each)  # crashed\n",
            "each",
            "each exists only inside the brackets of the comprehension on line 1.",
        ),
        (
            "def a():\n    global n\n    n += 1  # crashed\n",
            "n",
            "The line global n gives n no value. Give n a first value at the top of the file, outside all functions.",
        ),
        (
            "n = n + 1  # crashed\n",
            "n",
            "This line needs a value of n to compute a new one. Give n a first value on an earlier line.",
        ),
        ("print(A)  # crashed\nclass A:\n    pass\n", "A", "A is defined on line 2, after this line."),
        (
            "class A:\n    N = 1\nprint(N)  # crashed\n",
            "N",
            "N belongs to the class A (line 2). Write A.N.",
        ),
        (
            "class A:\n    def go(self):\n        pass\ngo()  # crashed\n",
            "go",
            "go is a method of A (line 2). Call it on an object of A, with a dot.",
        ),
        ("class A:\n    print(N)  # crashed\n    N = 3\n", "N", "N gets its value on line 3, after this line."),
        (
            "f = lambda value: value\nprint(value)  # crashed\n",
            "value",
            "value is a parameter of a lambda (line 1), and exists only in that function.",
        ),
        (
            "def main():\n    spin(node)  # crashed\nif __name__ == '__main__':\n    node = 1  # look\n    main()\n",
            "node",
            (
                'Line 4 gives node a value, but it is below if __name__ == "__main__". ros2 run does not run such '
                "lines: it calls the function of the entry point. Move the line out of this block."
            ),
        ),
        (
            "class A:\n    def b(self):\n        print(node)  # crashed\n\ndef main():\n    node = A()\n",
            "node",
            (
                "node is a local variable of main (line 6). A local variable does not exist in other functions. Inside "
                "the methods of A, the object is self."
            ),
        ),
    ],
)
def test_every_statement_that_binds_a_name_counts(source: str, name: str, cause: str) -> None:
    found = reported(source, NO_NAME.format(name))
    assert found.cause == cause


@pytest.mark.parametrize(
    ("line", "name", "cause"),
    [
        ("max = max(1, 2)", "max", "no longer the built-in function. Choose another name for this value."),
        ("Pose = Pose()", "Pose", "so in this function Pose is no longer what line 1 imports."),
        ("helper = helper()", "helper", "so in this function helper is no longer the function."),
        ("print(sys); import sys", "sys", "A variable that a function assigns to"),
    ],
)
def test_a_local_variable_hides_what_has_the_same_name(line: str, name: str, cause: str) -> None:
    source = f"from a import Pose\n\ndef helper():\n    pass\n\ndef b():\n    {line}  # crashed\n"
    error = f"UnboundLocalError: cannot access local variable '{name}' where it is not associated with a value"
    assert cause in reported(source, error).cause


@pytest.mark.parametrize(
    ("lines", "name", "cause"),
    [
        ("try:\n        c()\n    except OSError as e:\n        pass\n    print(e)", "e", "Python deletes e at the end"),
        ("for k in []:\n        pass\n    print(k)", "k", "k gets a value only if the loop on line 2 has at least"),
    ],
)
def test_a_local_variable_without_a_value_is_explained_by_its_statement(lines: str, name: str, cause: str) -> None:
    error = f"UnboundLocalError: cannot access local variable '{name}' where it is not associated with a value"
    assert reported(f"def b():\n    {lines}  # crashed\n", error).cause.startswith(cause)


def test_a_module_that_is_imported_again_later_in_the_function_is_reported_there() -> None:
    error = "UnboundLocalError: cannot access local variable 'math' where it is not associated with a value"
    found = reported("import math\n\ndef b():\n    print(math)  # crashed\n    import math  # look\n", error)
    assert found.cause == "Line 5 imports math, after this line. Import it at the top of the file."


@pytest.mark.parametrize(("line", "told"), [("print(up)", True), ("print(f'{up}')", False), ("up.go()", False)])
def test_only_a_name_that_can_be_a_string_is_told_about_quotation_marks(line: str, *, told: bool) -> None:
    found = reported(f"{line}  # crashed\n", NO_NAME.format("up"))
    assert ("A string needs quotation marks." in found.cause) == told


@pytest.mark.parametrize(("line", "name", "guess"), [("Msg.x = 1", "Msg", "msg"), ("Pass", "Pass", "pass")])
def test_a_capital_letter_in_place_of_a_small_one_is_told(line: str, name: str, guess: str) -> None:
    found = reported(f"def a(msg):\n    {line}  # crashed\n", NO_NAME.format(name))
    assert (found.diagnosis, f"exists: {guess}." in found.cause) == ("name-misspelt", True)
