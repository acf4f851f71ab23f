"""Imports from the student's own package that fail, each with files that are nearly the same."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported
from grader.tests.checks.made import SETUP_PY

PACKAGE = "my_robot_controller"
NO_MODULE = f"ModuleNotFoundError: No module named '{PACKAGE}.nodes'"
CIRCLE = f"from {PACKAGE}.{{}} import SPEED  # crashed\n"
PARTIAL = (
    f"ImportError: cannot import name 'SPEED' from partially initialized module '{PACKAGE}.{{}}' "
    "(most likely due to a circular import) (/ws/a.py)"
)


@pytest.mark.parametrize(
    ("files", "diagnosis"),
    [
        ({f"{PACKAGE}/nodes/counter.py": ""}, "missing-init"),
        ({f"{PACKAGE}/nodes/counter.py": "", f"{PACKAGE}/nodes/__init__.py": ""}, "module-missing"),
        ({f"{PACKAGE}/others/counter.py": ""}, "module-missing"),
    ],
)
def test_a_folder_without_init_is_not_installed(files: dict[str, str], diagnosis: str) -> None:
    found = reported(f"import {PACKAGE}.nodes.counter  # crashed\n", NO_MODULE, files)
    assert found.diagnosis == diagnosis
    told = f"The folder {PACKAGE}/nodes has no file __init__.py, so the build does not install it." in found.cause
    assert told == (diagnosis == "missing-init")


@pytest.mark.parametrize(
    ("packages", "init", "told"),
    [("[package_name]", False, True), ("[package_name]", True, True), ("find_packages()", False, False)],
)
def test_a_folder_that_is_not_in_the_list_of_packages_is_not_installed(
    packages: str, *, init: bool, told: bool
) -> None:
    files = {f"{PACKAGE}/nodes/counter.py": "", **({f"{PACKAGE}/nodes/__init__.py": ""} if init else {})}
    files["setup.py"] = SETUP_PY.replace('find_packages(exclude=["test"])', packages)
    found = reported(f"import {PACKAGE}.nodes.counter  # crashed\n", NO_MODULE, files)
    words = f"The build does not install the folder {PACKAGE}/nodes. The packages argument of setup() lists the folders"
    assert (found.diagnosis, words in found.cause) == ("module-not-installed" if told else "missing-init", told)


@pytest.mark.parametrize(
    ("module", "error", "words"),
    [
        ("other", PARTIAL, "draw_circle.py and other.py import each other, so SPEED does not exist yet when this line"),
        ("draw_circle", PARTIAL, "draw_circle.py imports itself. Remove this import: the names of a file can be used"),
        ("third", PARTIAL, "draw_circle.py and third.py import each other through other files, so SPEED does not"),
        ("elsewhere", PARTIAL, ""),
        ("other", "ImportError: cannot import name 'SPEED' from '{}'", ""),
    ],
)
def test_two_modules_that_import_each_other_are_named(module: str, error: str, words: str) -> None:
    back = {"other": "draw_circle", "third": "other"}
    files = {f"{PACKAGE}/{name}.py": f"from {PACKAGE} import {imported}\n" for name, imported in back.items()}
    found = reported(CIRCLE.format(module), error.format(module), files)
    told = "import each other" in found.cause or "imports itself" in found.cause
    assert (found.cause.startswith(words), told) == (True, bool(words))


def test_a_module_that_does_not_exist_in_a_folder_is_not_the_folder() -> None:
    error = f"ModuleNotFoundError: No module named '{PACKAGE}.nodes.conter'"
    files = {f"{PACKAGE}/nodes/counter.py": ""}
    assert reported(f"import {PACKAGE}.nodes.conter  # crashed\n", error, files).diagnosis != "missing-init"
