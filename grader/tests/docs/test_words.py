"""The page of all commands agrees with the help texts, and the glossary contains the terms of the lessons."""

from __future__ import annotations

import re

from grader.exercise.model import catalogue
from grader.tests.docs import commands_page
from grader.tests.docs.pages import ROOT, text_of

BOLD = re.compile(r"\*\*([^*]+)\*\*")
PART_ONE = [name for name in catalogue() if name < "08"]
NO_TERMS = re.compile(r"\d|=|^in (each|a) |^(one|comma|seconds|talk|waits|method)$|'s tools$|^every")
"""Words that are bold for another reason: numbers of a task, or important words that are not terms."""


def terms() -> dict[str, str]:
    """Map each word to the step that explains the word."""
    rows = re.findall(r"^\| (.+?) \| .+ \| (\d\d) \|$", text_of("docs/glossary.md"), re.MULTILINE)
    return dict(rows)


def stem(word: str) -> str:
    """Return a word without its plural or verb ending."""
    return re.sub(r"(e?s|e?d|e)$", "", " ".join(word.lower().split()))


def test_the_page_of_commands_is_made_from_their_help() -> None:
    """If this test fails, run `python -m grader.tests.docs.commands_page`."""
    assert commands_page.PAGE.read_text("utf-8") == commands_page.page()


def test_the_glossary_is_in_the_order_of_the_alphabet() -> None:
    assert list(terms()) == sorted(terms(), key=str.lower)


def test_each_word_is_explained_where_the_glossary_says() -> None:
    lessons = {name[:2]: file.with_name("lesson.md").read_text("utf-8").lower() for name, file in catalogue().items()}
    assert [word for word, step in terms().items() if stem(word) not in " ".join(lessons[step].split())] == []


def test_each_word_that_a_lesson_stresses_is_in_the_glossary() -> None:
    known = {stem(word) for word in terms()}
    lessons = [catalogue()[name].with_name("lesson.md").read_text("utf-8") for name in PART_ONE]
    stressed = {" ".join(word.split()) for text in lessons for word in BOLD.findall(text)}
    assert [word for word in sorted(stressed) if not NO_TERMS.search(word.lower()) and stem(word) not in known] == []


def test_each_lesson_links_to_both_pages() -> None:
    for file in (catalogue()[name] for name in PART_ONE):
        text = file.with_name("lesson.md").read_text("utf-8")
        assert "](../../docs/commands.md)" in text, file
        assert "](../../docs/glossary.md)" in text, file
    assert (ROOT / "docs/glossary.md").is_file()
