from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from grader.common.lazy import np

if TYPE_CHECKING:
    from pathlib import Path

START = "import sys, grader.cli, grader.grading.grade, grader.evidence.recording_format, grader.report.terminal\n"


@pytest.mark.parametrize(
    ("then", "loaded"), [("", False), ("from grader.common.lazy import np; np.hypot(3.0, 4.0)\n", True)]
)
def test_numpy_is_imported_when_it_is_first_used(then: str, loaded: bool) -> None:
    code = f"{START}{then}print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == str(loaded)


def test_check_imports_no_slow_package_that_few_submissions_need() -> None:
    code = f"{START}print(*{{'PIL', 'catkin_pkg', 'jinja2', 'matplotlib', 'rosbags'}} & sys.modules.keys())"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def test_what_numpy_does_not_have_is_reported_as_numpy_tells_it() -> None:
    with pytest.raises(AttributeError, match="module 'numpy' has no attribute 'hypott'"):
        np.hypott  # type: ignore[attr-defined] # noqa: B018


PARSING = """\
import sys
from grader.common.lazy import catkin_package, load_catkin_pkg

load_catkin_pkg()
text = '''<package format="3"><name>x</name><version>0.1.0</version><description>x</description>
<maintainer email="a@b.example">x</maintainer><license>x</license><depend {attribute}>rclpy</depend></package>'''
try:
    package = catkin_package.parse_package_string(text)
    package.evaluate_conditions({{"ROS_VERSION": "2"}})
    print([depend.evaluated_condition for depend in package.exec_depends], "pyparsing" in sys.modules)
except Exception as error:
    print(type(error).__name__)
"""


@pytest.mark.parametrize(
    ("attribute", "printed"),
    [
        ("", "[True] False"),
        ('condition="$ROS_VERSION == 2"', "[True] True"),
        ('condition="$ROS_VERSION == 1"', "[False] True"),
        ('condition="1 =="', "ValueError"),
    ],
)
def test_the_parser_of_conditions_is_imported_only_for_a_condition(attribute: str, printed: str) -> None:
    code = PARSING.format(attribute=attribute)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == printed


@pytest.mark.parametrize(("hidden", "told"), [(True, "Remove this folder from PYTHONPATH"), (False, "Run `make demo`")])
def test_a_module_that_cannot_be_imported_is_the_fault_of_the_machine(
    tmp_path: Path, *, hidden: bool, told: str
) -> None:
    (tmp_path / "numpy.py").write_text("raise ImportError('this numpy is\\nbroken')\n")
    (tmp_path / "other" / "numpydoc").mkdir(parents=True)
    code = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); from grader.common.lazy import np; np.hypot"
    env = {"PYTHONPATH": str(tmp_path if hidden else tmp_path / "other")}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=env, check=False)
    told_last = done.stderr.splitlines()[-1]
    assert "MachineError: numpy" in told_last
    assert "cannot be imported: this numpy is broken. " in told_last
    assert told in told_last
