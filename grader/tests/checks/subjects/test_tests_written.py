"""The checks of the source of a student's tests."""

from __future__ import annotations

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.kind import NoParams
from grader.checks.outcome import Status
from grader.checks.subjects.tests_written import ASSERTS, DECLARED, OUTSIDE, STEADY
from grader.evidence.evidence import Evidence
from grader.tests.checks.changed import setup_py, xml
from grader.tests.checks.made import found, submission
from grader.tests.checks.told import told

TESTS = "test/test_wall_guard.py"


def given(source: str) -> Evidence:
    return Evidence(find_exercise("12-tests"), submission({TESTS: source}))


@pytest.mark.parametrize(
    ("code", "diagnosis"),
    [
        ("import platform\nassert platform.system()\n", None),
        ("from unittest import mock\n", None),
        ("import inspect\n", "looks-at-source"),
        ("import ast as tree\n", "looks-at-source"),
        ("def test_it(guard):\n    assert guard.send.__code__\n", "looks-at-source"),
        ("from pathlib import Path\ntext = Path('x').read_text()\n", "looks-at-source"),
        ("import tomllib\nwith open('my_numbers_12.toml', 'rb') as file:\n    N = tomllib.load(file)\n", None),
        ("FILE = Path(__file__).parents[1] / 'my_numbers_12.toml'\nN = tomllib.loads(FILE.read_text())\n", None),
        ("N = open('my_numbers_12.toml').read()\nTEXT = open(FILE).read()\n", "looks-at-source"),
        ("NAMES = ['my_numbers_12.toml', 'wall_guard.py']\nTEXT = open(NAMES[1]).read()\n", "looks-at-source"),
        ("TEXT = open('my_numbers_11.toml').read()\n", "looks-at-source"),
        ("from subprocess import Popen\n", "starts-a-process"),
        ("import launch_testing.actions\n", "starts-a-process"),
    ],
)
def test_what_looks_at_the_source_is_found_by_what_it_uses(code: str, diagnosis: str | None) -> None:
    assert OUTSIDE.check(given(code), NoParams()).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("body", "diagnosis"),
    [
        ("    check(bench)\n\ndef check(bench):\n    assert bench\n", None),
        ("    with pytest.raises(ValueError):\n        bench()\n", None),
        ("    bench.guard.publish.assert_called_once()\n", None),
        ("    return bench.count() == 10\n", "compares-only"),
        ("    bench.count() == 10\n", "compares-only"),
        ("    assert (bench.count() == 10, 'ten')\n", "assert-tuple"),
        ("    print(bench.count())\n", "no-assert"),
        ("    assert True\n", "assert-vacuous"),
        ("    assert bench.count() == 10\n    assert True\n", None),
    ],
)
def test_a_test_needs_an_assert_that_can_fail(body: str, diagnosis: str | None) -> None:
    assert ASSERTS.check(given(f"def test_it(bench):\n{body}"), NoParams()).diagnosis == diagnosis


ASSERT = "def test_it(bench):\n    assert bench.count() == 10\n"


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The tests watch the node from outside.", ASSERT, f"import inspect\n{ASSERT}"),
        ("The tests create the node and watch what it publishes.", f"import inspect\n{ASSERT}", ASSERT),
        ("The tests use inspect, which can look at the code of the node.", "import inspect\n", "import math\n"),
        ("The tests use read_text, which can read a file.", "text = p.read_text()\n", "text = p.write_text('')\n"),
        ("The same node can be written in many ways. A test of the source", "import ast\n", "import subprocess\n"),
        ("The tests import subprocess, which can start other processes.", "import subprocess\n", "import ast\n"),
        ("Import the class, create the node in the test, and spin it.", "import subprocess\n", "import ast\n"),
    ],
)
def test_a_sentence_about_what_tests_look_at_is_true(words: str, true: str, near: str) -> None:
    assert words in told(OUTSIDE.check(given(true), NoParams()))
    assert words not in told(OUTSIDE.check(given(near), NoParams()))


NAP = "import time\ntime.sleep(1)\n"
CHANCE = "import random\nrandom.randint(1, 2)\n"
LOOP = "import time\nend = time.time() + 5\nwhile time.time() < end:\n    spin_once()\n"


def about_steadiness(source: str) -> str:
    return told(found(STEADY, given(source), names=("sleep",), random=("randint",)))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The tests use sleep.", NAP, CHANCE),
        ("On a slow computer, the sleep may be too short. Spin until the message arrives, or set", NAP, CHANCE),
        ("The tests use randint.", CHANCE, NAP),
        ("A failure that occurs only sometimes is hard to reproduce. Choose the values yourself, or", CHANCE, NAP),
        (
            "The tests contain a loop that runs for a fixed time.",
            f"def test_it():\n    {LOOP.replace(chr(10), chr(10) + '    ')}",
            NAP,
        ),
    ],
)
def test_a_sentence_about_steady_tests_is_true(words: str, true: str, near: str) -> None:
    assert words in about_steadiness(true)
    assert words not in about_steadiness(near)


@pytest.mark.parametrize(
    ("source", "passes"),
    [
        ("import random\nrandom.seed(7)\nx = random.randint(1, 2)\n", True),
        ("import random\nrandom.seed()\nx = random.randint(1, 2)\n", False),
        ("import random\nimport numpy as np\nrandom.seed(7)\nx = np.random.randint(1, 2)\n", False),
        ("import random\nimport numpy as np\nnp.random.seed(7)\nx = np.random.randint(1, 2)\n", True),
        ("from random import randint, seed\nseed(7)\nx = randint(1, 2)\n", True),
        ("import random, time\nrandom.seed(time.time())\nx = random.randint(1, 2)\n", False),
        ("import random\ndice = random.Random(7)\nx = dice.randint(1, 2)\n", True),
        ("import random\ndice = random.Random(x=None)\nx = dice.randint(1, 2)\n", False),
        ("import random\ndice = random.Random(7)\nx = dice.randint(1, 2) + random.randint(1, 2)\n", False),
        ("from random import Random, randint\ndice = Random(7)\nx = dice.randint(1, 2) + randint(1, 2)\n", False),
        ("import numpy as np\ndef test_it(seed):\n    x = np.random.RandomState(seed).randint(1, 2)\n", True),
        ("import numpy as np\nnp.random.RandomState(7)\nx = np.random.randint(1, 2)\n", False),
        ("from numpy import random as r\nr.default_rng(7)\nx = r.randint(1, 2)\n", False),
        ("from numpy.random import default_rng\nx = default_rng(seed=7).randint(1, 2)\n", True),
    ],
)
def test_random_numbers_with_a_fixed_seed_are_the_same_in_every_run(source: str, *, passes: bool) -> None:
    finding = found(STEADY, given(source), names=("sleep",), random=("randint",))
    assert (finding.status is Status.PASSED) is passes


@pytest.mark.parametrize(("source", "passes"), [(ASSERT, True), (NAP, False)])
def test_the_requirement_of_steady_tests_is_an_observation_only_if_it_holds(source: str, *, passes: bool) -> None:
    finding = found(STEADY, given(source), names=("sleep",), random=("randint",))
    words = "The tests behave the same in every run, even on a slow computer."
    assert (finding.observed == words, finding.expected == words) == (passes, not passes)


@pytest.mark.parametrize(("source", "passes"), [(ASSERT, True), ("def test_it(bench):\n    bench.count()\n", False)])
def test_the_requirement_of_asserts_is_an_observation_only_if_it_holds(source: str, *, passes: bool) -> None:
    finding = ASSERTS.check(given(source), NoParams())
    words = "Every test has an assert that can fail."
    assert (finding.observed == words, finding.expected == words) == (passes, not passes)
    assert (finding.observed == "There is no assert in test_it.") != passes


PYTEST = "    extras_require={'test': ['pytest']},\n"
OLD = "    tests_require=['pytest'],\n"
DEPEND = "  <test_depend>python3-pytest</test_depend>\n"


def about_declaration(extra: str, depend: str) -> str:
    """Return what is reported about a package with these lines in setup.py and in package.xml."""
    files = {
        **setup_py("    packages=", f"{extra}    packages="),
        **xml("  <export>\n", f"{depend}  <export>\n"),
    }
    return told(DECLARED.check(Evidence(find_exercise("12-tests"), submission(files)), NoParams()))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("colcon test runs the tests with pytest.", (PYTEST, DEPEND), ("", DEPEND)),
        (
            'setup.py lists "pytest" under "test" in extras_require, and package.xml declares',
            ("", ""),
            (PYTEST, DEPEND),
        ),
        ('setup.py does not list "pytest" in extras_require.', ("", DEPEND), (PYTEST, DEPEND)),
        ("Without this entry, colcon test runs unittest, which does not find", ("", DEPEND), (OLD, DEPEND)),
        ("setuptools 72 and later ignore tests_require, so colcon test runs", (OLD, DEPEND), ("", DEPEND)),
        ("package.xml does not declare python3-pytest.", (PYTEST, ""), (PYTEST, DEPEND)),
        ("On another computer, rosdep installs only the packages that", (PYTEST, ""), ("", "")),
    ],
)
def test_a_sentence_about_the_declaration_is_true(words: str, true: tuple[str, str], near: tuple[str, str]) -> None:
    assert words in about_declaration(*true)
    assert words not in about_declaration(*near)


@pytest.mark.parametrize(
    ("extra", "accepted"),
    [
        ("extras_require={'test': 'pytest'},", True),
        ("extras_require={'test': 'flake8\\npytest>=7'},", True),
        ("extras_require={'tests': ['pytest']},", True),
        ("extras_require={'testing': ('pytest[extra]',)},", True),
        ("extras_require=dict(test={'pytest; python_version > \"3\"'}),", True),
        ("extras_require=read_extras(),", True),
        ("**read_arguments(),", True),
        ("extras_require={'Test': ['pytest']},", False),
        ("extras_require={'dev': ['pytest']},", False),
        ("extras_require={'test': ['PyTest']},", False),
        ("extras_require={'test': ['pytest-cov', 'python3-pytest']},", False),
        ("extras_require={'test': 'flake8, pytest'},", False),
    ],
)
def test_pytest_is_declared_where_colcon_reads_it(extra: str, *, accepted: bool) -> None:
    """colcon_core 0.21 and setuptools 79 read each of these arguments as stated, if they are constant."""
    words = 'setup.py does not list "pytest" in extras_require.'
    assert (words not in about_declaration(f"    {extra}\n", DEPEND)) == accepted


@pytest.mark.parametrize(
    ("file", "text", "accepted"),
    [
        ("setup.cfg", "[options.extras_require]\ntest = pytest\n", True),
        ("setup.cfg", "[options.extras_require]\ntesting =\n  flake8\n  pytest >= 7\n", True),
        ("setup.cfg", "[options.extras_require]\ndoc =\n  pytest\n", False),
        ("setup.cfg", "[options]\ntests_require = pytest\n", False),
        ("pyproject.toml", "[project.optional-dependencies]\ntest = ['pytest']\n", True),
        ("pyproject.toml", "[project.optional-dependencies]\ndoc = ['pytest']\n", False),
        ("pyproject.toml", "[project\n", False),
    ],
)
@pytest.mark.parametrize("extra", ["", "    extras_require={'doc': ['sphinx']},\n"])
def test_other_files_count_if_setup_py_has_no_extras(extra: str, file: str, text: str, *, accepted: bool) -> None:
    files = {**setup_py("    packages=", f"{extra}    packages="), **xml("  <export>\n", f"{DEPEND}  <export>\n")}
    finding = DECLARED.check(Evidence(find_exercise("12-tests"), submission({**files, file: text})), NoParams())
    assert (finding.status is Status.PASSED) == (accepted and not extra)
