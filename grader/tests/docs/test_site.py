"""The documentation builds as a site, and the build fails on a broken link."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from grader.tests.docs.pages import BESIDE_THE_CODE, PAGES, ROOT
from grader.tests.waiting import LONG_S

SPHINX = Path(sys.executable).with_name("sphinx-build")


def arguments() -> list[str]:
    """Return the options of sphinx-build in the Makefile, without the folders."""
    recipe = re.search(r"sphinx-build (.*) -c docs -d ", (ROOT / "Makefile").read_text("utf-8"))
    assert recipe is not None
    return recipe[1].split()


def build(source: Path, to: Path) -> subprocess.CompletedProcess[str]:
    folders = ["-c", str(source / "docs"), "-d", str(to / "doctrees"), str(source), str(to / "site")]
    return subprocess.run([SPHINX, *arguments(), *folders], capture_output=True, text=True, check=False, timeout=LONG_S)


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy of the files from which the site is built. A test may change this copy."""
    copy = tmp_path_factory.mktemp("site") / "source"
    left_out = shutil.ignore_patterns("__pycache__", "bases", "cases", "golden", "hostile", "mistakes", "unusual")
    for name in ("docs", "course", "grader"):
        shutil.copytree(ROOT / name, copy / name, ignore=left_out)
    for path in ROOT.iterdir():
        if path.is_file():
            shutil.copy(path, copy / path.name)
    return copy


@pytest.fixture(scope="module")
def built(source: Path) -> Path:
    """Build the site without errors and warnings, and return its folder."""
    to = source.parent / "built"
    done = build(source, to)
    assert (done.returncode, done.stderr) == (0, "")
    return to


def test_the_site_is_built_with_every_page(built: Path) -> None:
    lessons = [str(path.relative_to(ROOT)) for path in (ROOT / "course").glob("*/lesson.md")]
    for page in (*PAGES, *BESIDE_THE_CODE, *lessons):
        assert (built / "site" / page).with_suffix(".html").is_file(), page
    assert "README.html" in (built / "site/index.html").read_text("utf-8")


def test_a_link_that_leads_nowhere_fails(source: Path, built: Path) -> None:
    with (source / "docs/design.md").open("a", encoding="utf-8") as page:
        page.write("\nSee [the moon](moon.md) and [this](authors.md#no-such-heading).\n")
    done = build(source, built)  # Sphinx reads only the page that has changed
    assert done.returncode != 0
    assert "moon.md" in done.stderr
    assert "no-such-heading" in done.stderr
