"""No link of the documentation is broken, links lead to every page, and README is short."""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath

import pytest

from grader.exercise.model import catalogue
from grader.tests.docs.pages import BESIDE_THE_CODE, PAGES, ROOT, anchors_of, prose_of, text_of

LINK = re.compile(r"\]\(([^)\s]+)\)")
MOST_LINES = 130


def links_of(page: str) -> list[str]:
    return LINK.findall(prose_of(page))


@pytest.mark.parametrize("page", [*PAGES, *BESIDE_THE_CODE])
def test_links_lead_somewhere(page: str) -> None:
    for link in links_of(page):
        if link.startswith("https://"):
            continue
        name, _, anchor = link.partition("#")
        target = (ROOT / page).parent / name if name else ROOT / page
        assert target.exists(), link
        assert target.resolve().is_relative_to(ROOT), link
        if anchor:
            assert anchor in anchors_of(target), link


def test_anchors_are_found() -> None:
    assert any("#" in link for page in PAGES for link in links_of(page))
    assert "a-new-diagnosis" in anchors_of(ROOT / "docs/authors.md")
    assert "exercisetoml" in anchors_of(ROOT / "docs/authors.md")


def test_every_page_can_be_reached_from_the_readme() -> None:
    reached = {"README.md"}
    waiting = ["README.md"]
    while waiting:
        page = waiting.pop()
        for link in links_of(page):
            target = (PurePosixPath(page).parent / link.partition("#")[0]).as_posix()
            name = Path(ROOT / target).resolve().relative_to(ROOT).as_posix() if "://" not in link else ""
            if name in PAGES and name not in reached:
                reached.add(name)
                waiting.append(name)
    assert reached == set(PAGES)


def test_the_readme_is_short_and_has_one_picture() -> None:
    text = text_of("README.md")
    assert len(text.splitlines()) <= MOST_LINES
    assert len(re.findall(r"!\[", text)) == 1


def test_the_learners_page_leads_to_every_lesson_in_order() -> None:
    named = re.findall(
        r"^\d+\. \[([^\]]+)\]\(\.\./course/([^/]+)/lesson\.md\)$", text_of("docs/learner.md"), re.MULTILINE
    )
    assert [name for _, name in named] == list(catalogue())
    for title, name in named:
        heading = (ROOT / "course" / name / "lesson.md").read_text("utf-8").splitlines()[0]
        assert heading.lower().endswith(f": {title.lower()}")


def test_the_decisions_that_the_code_names_are_there() -> None:
    decisions = set(re.findall(r"^(\d+)\. \*\*", text_of("docs/design.md"), re.MULTILINE))
    sources = [path.read_text("utf-8") for path in (ROOT / "grader").rglob("*.py") if "tests/mistakes" not in str(path)]
    named = {number for text in sources for number in re.findall(r"docs/design\.md, decision (\d+)", text)}
    assert named
    assert named <= decisions
    assert [text for text in sources if re.search(r"\(design[,:]|of design\.md", text)] == []
