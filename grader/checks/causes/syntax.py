"""Why Python cannot read a file: its own message, told by the mistake that is usually behind it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.causes.cause import Cause
from grader.checks.outcome import Finding, failed
from grader.common.words import shorten
from grader.submission.package_xml import line_of
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.submission.code import Unreadable

NOT_UTF8 = r"codec can't decode|unicode error|[Nn]on-UTF-8|encoding"
"""What Python says of a file whose bytes are not the text that they should be."""
EXPECTED = "A file that Python can read."

CAUSES = (
    (NOT_UTF8, "not-utf8", "Say UTF-8 when you save it."),
    (
        "inconsistent use of tabs",
        "tabs-and-spaces",
        "Some lines begin with tabs, others with blanks: they look alike and are not. Use blanks.",
    ),
    (
        "Missing parentheses in call to 'print'",
        "python-2-print",
        "That is Python 2. In Python 3 print is a function, with parentheses.",
    ),
    ("expected ':'", "colon-missing", "A line with def, class, if, for, while, try or else ends with a colon."),
    (r"was never closed", "bracket-open", "This bracket opens, and none closes it. Python notices only further down."),
    (r"unmatched|does not match opening", "bracket-extra", "There is a closing bracket too many, or of another kind."),
    (r"unterminated", "text-open", "A text ends with the quotation mark that it began with, on the same line."),
    (
        r"invalid character|invalid non-printable",
        "typographic-character",
        "This character comes from a word processor or a web page: type it anew. Texts stand in plain \" or '.",
    ),
    (
        r"unindent|unexpected indent|expected an indented block",
        "indentation",
        "The lines of one block begin at the same column, further in than the line with the colon.",
    ),
    (r"forgot a comma", "comma-missing", "Between two arguments, or two items of a list, stands a comma."),
    (r"instead of '='|cannot assign", "equals", "One = gives a value to a name; two == compare."),
)
"""(what Python says, diagnosis, cause), the first that fits."""
CONFLICT = r"^(<<<<<<<|=======|>>>>>>>)"
OTHERWISE = "Often the fault is at the end of the line before: a bracket, a colon, the indentation."


def why_unreadable(unreadable: Unreadable, data: bytes) -> Cause:
    """The cause of a SyntaxError."""
    conflict = line_of(data, CONFLICT)
    if conflict is not None:
        text = "Git left both versions in the file, between <<<<<<< and >>>>>>>: keep one, and take the marks out."
        return Cause("merge-conflict", text)
    for pattern, diagnosis, text in CAUSES:
        if re.search(pattern, unreadable.message):
            return Cause(diagnosis, text)
    return Cause("syntax-error", OTHERWISE)


def unreadable_seen(file: str, unreadable: Unreadable) -> str:
    """What was seen of a file that Python cannot read."""
    said = shorten(unreadable.message, 120)
    return f"Python cannot read {file}: {said}{'' if said.endswith(('.', '?', '!')) else '.'}"


def unreadable_finding(file: str, unreadable: Unreadable, data: bytes) -> Finding:
    """A failed finding about a file that Python cannot read."""
    cause = why_unreadable(unreadable, data)
    seen = unreadable_seen(file, unreadable)
    return failed(cause.diagnosis, seen, EXPECTED, cause.text, where=Where(file, unreadable.line))
