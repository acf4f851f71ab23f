"""The causes of a NameError."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, reported, to_look_at


def name_error(name: str) -> str:
    return f"NameError: name '{name}' is not defined"


@pytest.mark.parametrize(
    ("line", "name", "diagnosis", "words"),
    [
        ("print(count)", "count", "missing-self", "count belongs to the object"),
        ("send()", "send", "missing-self", "send belongs to the object"),
        ("twist = Twist()", "Twist", "missing-import", "import Twist, which is in the module geometry_msgs.msg."),
        ("time.sleep(1)", "time", "missing-import", "import the module time."),
        ("print(steps)", "steps", "name-misspelt", "A similar name exists: step."),
        ("total = totl + 1", "totl", "name-misspelt", "A similar name exists: total."),
        ("outsde()", "outsde", "name-misspelt", "A similar name exists: outside."),
        ("print(Drivr)", "Drivr", "name-misspelt", "A similar name exists: Driver."),
        ("pritn(1)", "pritn", "name-misspelt", "A similar name exists: print."),
        ("Nodes()", "Nodes", "name-misspelt", "A similar name exists: Node."),
        ("print(ValueErro)", "ValueErro", "name-undefined", "Nothing defines this name"),
        ("print(forward)", "forward", "name-undefined", "this name before this line. A string needs quotation marks."),
        ("print(forward, forward)", "forward", "name-undefined", "Nothing defines this name before this line."),
        ("rclpy.spin(knot)", "knot", "name-undefined", "spin needs the node, an object of your class."),
    ],
)
def test_an_unknown_name_is_explained_by_what_there_is(line: str, name: str, diagnosis: str, words: str) -> None:
    source = DRIVER.format(line=line)
    found = reported(source, name_error(name))
    assert (found.diagnosis, found.line) == (diagnosis, to_look_at(source))
    assert words in found.cause


@pytest.mark.parametrize(
    ("imported", "name", "guess"),
    [
        ("import geometry.shapes", "geometri", "geometry"),
        ("import geometry as shapes", "shaps", "shapes"),
        ("from a import velocity", "velocty", "velocity"),
    ],
)
def test_what_is_imported_is_a_name(imported: str, name: str, guess: str) -> None:
    found = reported(f"{imported}\nprint({name})  # crashed", name_error(name))
    assert (found.diagnosis, f"A similar name exists: {guess}." in found.cause) == ("name-misspelt", True)


@pytest.mark.parametrize(
    ("name", "message", "diagnosis", "words"),
    [
        ("__send", "_Driver__send", "missing-self", "Inside a method, write self.__send."),
        ("__sned", "_Driver__sned", "name-misspelt", "A similar name exists: __send."),
        ("_Other__send", "_Other__send", "name-undefined", "Nothing defines this name before this line."),
    ],
)
def test_a_name_with_two_underscores_is_compared_as_it_is_written(
    name: str, message: str, diagnosis: str, words: str
) -> None:
    source = f"""\
class _Driver:
    def __init__(self):
        self.timer = self.create_timer(1.0, {name}())  # crashed

    def __send(self):
        pass
"""
    found = reported(source, name_error(message))
    assert (found.diagnosis, words in found.cause) == (diagnosis, True), found.cause


@pytest.mark.parametrize("assigned", ["SPEED = 1.0", "SPEED: float = 1.0"])
def test_a_method_reads_a_name_of_the_class_with_self(assigned: str) -> None:
    source = f"class Driver:\n    {assigned}\n\n    def send(self):\n        print(SPEED)  # crashed\n"
    found = reported(source, name_error("SPEED"))
    assert (found.diagnosis, "write self.SPEED." in found.cause) == ("missing-self", True)


def test_a_line_that_has_not_run_is_named_for_a_name_without_a_value() -> None:
    source = "if False:\n    forward = 1.0\nprint(forward)  # crashed\n"
    found = reported(source, name_error("forward"))
    text = "Line 2 gives forward a value, but forward has none here. Perhaps that line has not run."
    assert (found.diagnosis, found.cause) == ("name-undefined", text)
    assert "a value, but" not in reported("print(forward)  # crashed\n", name_error("forward")).cause
    assert "has none here" not in reported("print(forward)  # crashed\n", name_error("forward")).cause


def test_a_method_without_self_does_not_know_it() -> None:
    source = "class Driver:\n    def send():\n        self.count += 1  # crashed\n"
    assert reported(source, name_error("self")).diagnosis == "self-parameter"


def test_outside_of_the_class_nothing_belongs_to_self() -> None:
    source = "class Driver:\n    def drive(self):\n        self.count = 1\n\nprint(drive)  # crashed\n"
    assert reported(source, name_error("drive")).diagnosis != "missing-self"


def test_a_name_error_in_other_words_is_no_more_than_that() -> None:
    text = "NameError: cannot access free variable 'step' where it is not associated with a value"
    assert reported(DRIVER.format(line="print(step)"), text).diagnosis == "crash"


@pytest.mark.parametrize(
    ("source", "diagnosis"),
    [
        (DRIVER.format(line="count += 1"), "missing-self"),
        (DRIVER.format(line="other += 1"), "local-name"),
        ("def count_up():\n    count += 1  # crashed\n", "local-name"),
    ],
)
def test_a_name_that_is_assigned_below_is_the_functions_own_or_selfs(source: str, diagnosis: str) -> None:
    name = "other" if "other" in source else "count"
    error = f"UnboundLocalError: cannot access local variable '{name}' where it is not associated with a value"
    found = reported(source, error)
    assert (found.diagnosis, found.line) == (diagnosis, to_look_at(source))
    assert ("count belongs to the object" in found.cause) == (diagnosis == "missing-self")


@pytest.mark.parametrize(("first", "found"), [("ticks = 0  # look", True), ("self.count = 0", False)])
def test_a_counter_that_is_a_local_variable_of_init_is_reported_there(first: str, *, found: bool) -> None:
    source = DRIVER.replace("self.count = 0", first).format(line="ticks += 1")
    error = "UnboundLocalError: cannot access local variable 'ticks' where it is not associated with a value"
    given = reported(source, error)
    assert given.diagnosis == ("missing-self" if found else "local-name")
    assert ("local variable of __init__" in given.cause) == found
    assert given.line == to_look_at(source)


def test_a_variable_that_the_function_sets_later_is_not_taken_for_one_of_init() -> None:
    source = DRIVER.replace("self.count = 0", "ticks = 0").format(line="print(ticks)")
    source = source.replace("# crashed\n", "# crashed\n        ticks = 1\n", 1)
    error = "UnboundLocalError: cannot access local variable 'ticks' where it is not associated with a value"
    assert reported(source, error).diagnosis == "name-too-early"


def test_an_unbound_name_in_other_words_is_local_all_the_same() -> None:
    assert reported(DRIVER.format(line="count += 1"), "UnboundLocalError: no value").diagnosis == "local-name"


@pytest.mark.parametrize(
    ("source", "name", "diagnosis", "words"),
    [
        ("import math\nx = pi  # crashed\n", "pi", "module-prefix", "Write math.pi."),
        ("x = pi  # crashed\n", "pi", "missing-import", "import pi, which is in the module math."),
        ("import rclpy\nspin(node)  # crashed\n", "spin", "module-prefix", "Write rclpy.spin."),
        ("spin(node)  # crashed\n", "spin", "name-undefined", "Nothing defines this name"),
        ("x = true  # crashed\n", "true", "name-misspelt", "In Python, the spelling is True."),
        ("spin(node)  # crashed\nnode = 1\n", "node", "name-too-early", "on line 2, after this line"),
        (
            "def a():\n    node = 1\ndef b():\n    spin(node)  # crashed\n",
            "node",
            "local-name",
            "a local variable of a",
        ),
        ("msg = twist()  # crashed\nfrom a import Twist\n", "twist", "name-misspelt", "A similar name exists: Twist."),
        (DRIVER.format(line="create_timer(1, 2)"), "create_timer", "missing-self", "write self.create_timer"),
        ("import math as m\nx = math.pi  # crashed\n", "math", "name-undefined", "imports math under the name m."),
        ("from a.b import Twist as T\nx = Twist()  # crashed\n", "Twist", "name-undefined", "under the name T."),
        ("x = math.pi  # crashed\nimport math\n", "math", "name-too-early", "Line 2 imports math, after this line."),
        (
            "def a():\n    import math  # look\ndef b():\n    x = math.pi  # crashed\n",
            "math",
            "local-name",
            "inside a, so the name does not exist in other functions.",
        ),
    ],
)
def test_a_name_that_stands_elsewhere_is_reported_where(source: str, name: str, diagnosis: str, words: str) -> None:
    found = reported(source, name_error(name))
    assert (found.diagnosis, found.line) == (diagnosis, to_look_at(source))
    assert words in found.cause


@pytest.mark.parametrize(
    ("source", "name", "diagnosis", "words"),
    [
        ("def main():\n    spin(node)  # crashed\n    node = 1\n", "node", "name-too-early", "on line 3, after this"),
        (
            "import time\ndef main():\n    print(time.time())  # crashed\n    time = 3  # look\n",
            "time",
            "local-name",
            "no longer the module",
        ),
        (
            "n = 0\ndef count():\n    print(n)  # crashed\n    n = 1\n",
            "n",
            "local-name",
            "To change the variable of the module, the function needs the line global n.",
        ),
        (
            "n = 0\nclass Driver:\n    def count(self):\n        print(n)  # crashed\n        n = 1\n",
            "n",
            "local-name",
            "local to that function. Store a value in self if later calls need the value.",
        ),
    ],
)
def test_a_local_name_is_reported_by_the_line_that_sets_it(source: str, name: str, diagnosis: str, words: str) -> None:
    error = f"UnboundLocalError: cannot access local variable '{name}' where it is not associated with a value"
    found = reported(source, error)
    assert (found.diagnosis, found.line) == (diagnosis, to_look_at(source))
    assert words in found.cause


AT_CLASS_LEVEL = """\
class Driver(Node):
    {line}
    def send(self):
        pass

    def stop():
        {inside}
"""


@pytest.mark.parametrize(
    ("line", "inside", "told"),
    [
        ("self.timer = self.create_timer(0.5)  # crashed", "pass", True),
        ("@self.create_timer(0.5)  # crashed", "pass", True),
        ("", "self.timer.cancel()  # crashed", False),
    ],
)
def test_self_exists_only_inside_a_method(line: str, inside: str, *, told: bool) -> None:
    found = reported(AT_CLASS_LEVEL.format(line=line, inside=inside), "NameError: name 'self' is not defined")
    assert found.diagnosis == "self-parameter"
    assert ("self exists only inside a method. Move this line into a method, such as" in found.cause) == told
