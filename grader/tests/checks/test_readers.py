"""Reading source code without running it: setup.py, constants, calls, tracebacks."""

from __future__ import annotations

import ast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.causes.crash import read_traceback
from grader.submission.code import module_file, read_code, read_module
from grader.submission.constants import Names, evaluate, number, single_names
from grader.submission.package_xml import read_manifest
from grader.submission.setup_py import read_setup_py
from grader.tests.checks.made import NODE_FILE, SETUP_PY
from grader.tests.checks.shapes import TRACEBACK

FILES = {NODE_FILE: b"", "setup.py": b""}


def value(text: str) -> object:
    tree = ast.parse(text)
    last = tree.body[-1]
    assert isinstance(last, ast.Expr)
    return evaluate(last.value, single_names(tree))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1 / 2", 0.5),
        ("-0.5 * 2", -1.0),
        ("a = 0.5\na", 0.5),
        ("a = 'x'\na + '/' + 'y'", "x/y"),
        ("p = 'x'\nf'share/{p}'", "share/x"),
        ("import os\np = 'x'\nos.path.join('share', p)", "share/x"),
        ("self.period = 2\nself.period", 2),
        ("math.pi", pytest.approx(3.14159, abs=1e-5)),
        ("a = 1\na = 2\na", None),
        ("a = a\na", None),
        ("1 / 0", None),
        ("2 ** 99999999", None),
        ("'x' * 99999999", None),
        ("f()", None),
        ("b'x'", None),
    ],
)
def test_constants_are_evaluated_and_nothing_else(text: str, expected: object) -> None:
    assert value(text) == expected


def test_a_number_too_large_for_a_float_is_none() -> None:
    assert number(ast.parse("1" + "0" * 400, mode="eval").body, Names()) is None


def test_setup_py_as_the_lesson_has_it() -> None:
    setup = read_setup_py(SETUP_PY.encode())
    assert (setup.name, setup.name_line, setup.finds_packages) == ("my_robot_controller", 3, True)
    point = setup.entry_point("draw_circle")
    assert point is not None
    assert (point.target, point.line) == ("my_robot_controller.draw_circle:main", 14)
    assert setup.data_files == (
        ("share/ament_index/resource_index/packages", ("resource/my_robot_controller",)),
        ("share/my_robot_controller", ("package.xml",)),
    )


def test_an_argument_that_is_not_constant_is_unknown() -> None:
    setup = read_setup_py(b"import x\nfrom setuptools import setup\nsetup(name=x.y(), entry_points=x.z, **x.more)\n")
    assert (setup.name, setup.entry_points) == (None, None)


@pytest.mark.parametrize("text", ["a = b:c", " a=b.c:d ", "a = b:c.d", "a = b:c [extra]"])
def test_entry_points_as_setuptools_reads_them(text: str) -> None:
    setup = read_setup_py(f"setup(entry_points={{'console_scripts': [{text!r}]}})".encode())
    point = setup.entry_point("a")
    assert point is not None
    assert point.target is not None


@pytest.mark.parametrize("text", ["a = b", "a: b", "a = b:", "= b:c", "a b"])
def test_texts_that_are_no_entry_points(text: str) -> None:
    setup = read_setup_py(f"setup(entry_points={{'console_scripts': [{text!r}]}})".encode())
    assert [point.target for point in setup.entry_points or ()] == [None]


@given(st.binary(max_size=300))
def test_no_bytes_make_a_reader_raise(data: bytes) -> None:
    read_setup_py(data)
    read_manifest(data)
    read_code({"a/b.py": data}, "a/b.py").calls("spin")


@given(st.text(alphabet='File "line0123, in:Traceback\n ()mosrecnla', max_size=400))
def test_no_text_makes_the_traceback_reader_raise(text: str) -> None:
    read_traceback("Traceback (most recent call last):\n" + text, FILES)


def test_a_crash_is_the_students_own_last_line() -> None:
    crash = read_traceback("[INFO] [1.2] [draw_circle]: hello\n" + TRACEBACK, FILES)
    assert crash is not None
    assert (crash.error, crash.message, str(crash.where)) == (
        "ZeroDivisionError",
        "division by zero",
        f"{NODE_FILE}:14",
    )


def test_of_chained_exceptions_the_first_is_the_cause() -> None:
    second = TRACEBACK.replace("ZeroDivisionError: division by zero", "rclpy._rclpy_pybind11.RCLError: shutdown twice")
    text = f"{TRACEBACK}\nDuring handling of the above exception, another exception occurred:\n\n{second}"
    crash = read_traceback(text, FILES)
    assert crash is not None
    assert crash.error == "ZeroDivisionError"


def test_of_separate_exceptions_the_last_ended_the_node() -> None:
    crash = read_traceback(TRACEBACK.replace("ZeroDivisionError", "ValueError") + "\nlater\n" + TRACEBACK, FILES)
    assert crash is not None
    assert crash.error == "ZeroDivisionError"


def test_ctrl_c_is_no_crash() -> None:
    assert read_traceback(TRACEBACK.replace("ZeroDivisionError: division by zero", "KeyboardInterrupt"), FILES) is None


def test_a_syntax_error_is_placed_though_it_has_no_frame_of_its_own() -> None:
    place = f'  File "/ws/{NODE_FILE}", line 9\n    def f(\n         ^\n'
    text = f"Traceback (most recent call last):\n{place}SyntaxError: never closed\n"
    crash = read_traceback(text, FILES)
    assert crash is not None
    assert str(crash.where) == f"{NODE_FILE}:9"


def test_an_int_in_a_float_field_is_explained() -> None:
    text = TRACEBACK.replace(
        "ZeroDivisionError: division by zero", "AssertionError: The 'x' field must be of type 'float'"
    )
    crash = read_traceback(text, FILES)
    assert crash is not None
    assert crash.meaning == "This field is a float. Write the number with a decimal point."


def test_calls_are_found_in_the_node_and_what_it_imports_and_nowhere_else() -> None:
    files = {
        "a/__init__.py": b"",
        "a/helper.py": b"self.create_timer(1, f)\n",
        "a/second.py": b"from a import third\nself.create_timer(4, f)\n",
        "a/third.py": b"import a.node\nself.create_timer(5, f)\n",
        "a/other_node.py": b"self.create_timer(9, f)\n",
        "a/node.py": b"from .helper import help\nfrom . import second\n\nnode.create_timer(2, f)\n"
        b"super().create_timer(callback=g, timer_period_sec=3)\n",
        "setup.py": b"create_timer(9)\n",
        "test/test_x.py": b"create_timer(9)\n",
    }
    code = read_code(files, "a/node.py")
    assert [str(call.where) for call in code.calls("create_timer")] == [
        "a/node.py:4", "a/node.py:5", "a/helper.py:1", "a/second.py:2", "a/third.py:2",
    ]  # fmt: skip
    periods = [number(call.argument(0, "timer_period_sec"), Names()) for call in code.calls("create_timer")]
    assert periods == [2.0, 3.0, 1.0, 4.0, 5.0]


def test_a_starred_argument_hides_its_place() -> None:
    (call,) = read_code({"a.py": b"create_timer(*both)\n"}, None).calls("create_timer")
    assert call.argument(0, "timer_period_sec") is None


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("msg.linear.x = 2.0", 1),
        ("self.msg.linear.x = 2.0", 1),
        ("msg = Twist(\n    linear=Vector3(x=2.0))", 2),
        ("msg.linear.x += 1.0", 1),
        ("msg.angular.x = 2.0", None),
        ("linear = Vector3(y=1.0)", None),
    ],
)
def test_the_line_that_sets_a_field_is_found(text: str, line: int | None) -> None:
    found = read_code({"a.py": text.encode()}, "a.py").assigned("linear", "x")
    assert (None if found is None else found.line) == line


def test_a_file_with_a_byte_order_mark_and_windows_line_ends_is_read() -> None:
    assert read_module("a.py", b"\xef\xbb\xbfx = 1\r\ny = 2\r\n").tree is not None


def test_a_module_is_found_in_src_too() -> None:
    files = {
        "src/pkg/node.py": b"from pkg import near\nfrom .deep import x\n",
        "src/pkg/near.py": b"",
        "src/pkg/deep/__init__.py": b"",
    }
    assert module_file("pkg.node", files) == "src/pkg/node.py"
    read = read_code(files, "src/pkg/node.py").modules
    assert {module.file for module in read} == set(files)


def test_the_packages_around_a_module_are_read_with_it() -> None:
    files = {
        "a/__init__.py": b"from .b import c\n",
        "a/b/__init__.py": b"",
        "a/b/c.py": b"",
        "a/d.py": b"",
        "__init__.py": b"",
    }
    assert [module.file for module in read_code(files, "a/b/c.py").modules] == [
        "a/b/c.py",
        "a/b/__init__.py",
        "a/__init__.py",
    ]
