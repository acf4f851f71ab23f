from __future__ import annotations

import subprocess
import sys

import pytest

from grader.common.lazy import np

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
