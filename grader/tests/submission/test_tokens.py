"""The tokens of a file are read up to the place at which Python's tokenizer fails."""

from __future__ import annotations

import ast
import tokenize

import pytest

from grader.submission.tokens import tokens
from grader.tests.case import ROOT


@pytest.mark.parametrize(
    "rest",
    [b"", b"'''", b"x = (", b"  y = 1\n z = 2\n", b"\xe4 = 1\n", b"\0", b"\xff\xfe", b"'\n"],
)
def test_the_first_tokens_are_read_whatever_follows(rest: bytes) -> None:
    names = [token.string for token in tokens(b"x = 1\n" + rest) if token.type == tokenize.NAME]
    assert names[:1] == ["x"]


@pytest.mark.parametrize("data", [b"", b"# coding: no-such-coding\n", b"\xef\xbb\xbf# coding: latin-1\n"])
def test_a_file_that_cannot_be_decoded_has_no_tokens(data: bytes) -> None:
    assert [token for token in tokens(data) if token.type == tokenize.NAME] == []


def test_nothing_else_uses_the_tokenizer() -> None:
    uses = {
        str(path.relative_to(ROOT))
        for path in (ROOT / "grader").rglob("*.py")
        if "tests" not in path.parts
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Attribute) and node.attr in ("tokenize", "generate_tokens")
    }
    assert uses == {"grader/submission/tokens.py"}
