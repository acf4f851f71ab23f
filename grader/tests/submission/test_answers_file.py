from __future__ import annotations

import pytest

from grader.submission.answers_toml import MAX_BYTES, Answer, read_answers


@pytest.mark.parametrize(
    ("written", "read"),
    [
        ('"text"', "text"),
        ('"  blanks around  "', "blanks around"),
        ("62.5", 62.5),
        ("62", 62.0),
        ('["a", " b "]', ("a", "b")),
        ('""', None),
        ('"  "', None),
        ("0", None),
        ("nan", None),
        ("inf", None),
        ("true", None),
        ("[]", None),
        ("[1, 2]", None),
        ("{ a = 1 }", None),
        ("2026-11-21", None),
    ],
)
def test_an_answer_is_a_text_a_number_or_a_list_of_texts(written: str, read: Answer | None) -> None:
    found = read_answers(f"[answers]\nname = {written}\n".encode())
    assert found.problem is None
    assert found.given.get("name") == read
    missing = written in ('""', '"  "', "0", "[]")
    assert found.unusable == (frozenset() if missing or read is not None else {"name"})


def test_lines_are_where_the_answers_stand() -> None:
    found = read_answers(b'# top\n[answers]\n\nfirst = "a"\nsecond="b"\n')
    assert found.lines == {"first": 4, "second": 5}


def test_an_editor_of_windows_may_have_written_it() -> None:
    assert read_answers('[answers]\r\nname = "é"\r\n'.encode("utf-8-sig")).given == {"name": "é"}


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (b"", "it has no table [answers]"),
        (b"name = 1\n", "it has no table [answers]"),
        (b"answers = 1\n", "it has no table [answers]"),
        (b"[answers]\nname = \xff\n", "it is not UTF-8"),
        (b"[answers]\nname = word\n", "Invalid value (at line 2, column 8)"),
        (b"[answers]\nname = 1\nname = 2\n", "Cannot overwrite a value (at line 3, column 9)"),
        (b"[answers]\na = 1\nb = [1,\n  2\nc = [3]\n", "the list on line 3 has no ] at its end"),
        (b'[answers]\na = [1]\nb = ["c"\n', "the list on line 3 has no ] at its end"),
        (b"#" * (MAX_BYTES + 1), "it is larger than 100 kB"),
    ],
)
def test_what_cannot_be_read_is_reported_and_never_raised(data: bytes, problem: str) -> None:
    found = read_answers(data)
    assert (found.problem, found.given) == (problem, {})


def test_brackets_without_an_end_are_no_list() -> None:
    assert read_answers(b"[answers]\nx = " + b"[" * 50_000).problem is not None
