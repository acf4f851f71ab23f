"""Explain why Python cannot read a file, with the usual mistake behind each SyntaxError message."""

from __future__ import annotations

import re
from itertools import islice
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.indentation import why_indented
from grader.checks.causes.syntax_rules import OTHER_LANGUAGES, RULES
from grader.checks.edit import applied, at
from grader.checks.outcome import Finding, failed
from grader.common.words import shorten
from grader.submission.code import read_module
from grader.submission.package_xml import line_of
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis
    from grader.checks.edit import Edit
    from grader.submission.code import Unreadable

NOT_UTF8 = r"codec can't decode|unicode error|[Nn]on-UTF-8|encoding"
"""Matches Python's messages about the encoding of a file, and about a wrong escape sequence in a string."""
UTF_16 = (b"\xff\xfe", b"\xfe\xff")
"""The byte order marks at the beginning of a UTF-16 file. Python's message about such a file mentions null bytes."""
EXPECTED = "The file is valid Python."

CAUSES: tuple[tuple[str, Diagnosis, str], ...] = (
    (
        r"unicodeescape|unicode_escape",
        "syntax-error",
        "In a string, a backslash begins an escape sequence. Write \\\\ for a backslash, or r before the string.",
    ),
    (
        r"unknown encoding|encoding problem",
        "not-utf8",
        "The comment with the word coding names an unknown encoding. Remove the comment, and save the file as UTF-8.",
    ),
    (NOT_UTF8, "not-utf8", "Save the file as UTF-8."),
    (
        "inconsistent use of tabs",
        "tabs-and-spaces",
        "The indentation mixes tabs and spaces. Tabs and spaces look alike but are different. Use spaces.",
    ),
    (
        "Missing parentheses in call to 'print'",
        "python-2-print",
        "This is Python 2. In Python 3, print is a function and needs parentheses.",
    ),
    (
        "expected ':'",
        "colon-missing",
        "A line that begins a block, for example with def, if, for, with or else, must end with a colon.",
    ),
    (
        r"was never closed",
        "bracket-open",
        "This bracket is never closed. Python often reports a missing bracket on a later line.",
    ),
    (
        r"unmatched|does not match opening",
        "bracket-extra",
        "There is one closing bracket too many, or it is the wrong kind of bracket.",
    ),
    (
        r"unterminated triple-quoted",
        "quote-open",
        "A string that begins with three quotation marks must end with three.",
    ),
    (
        r"unterminated",
        "quote-open",
        "A string must end on the same line, with the same quotation mark that it starts with.",
    ),
    (
        r"invalid character|invalid non-printable",
        "typographic-character",
        "Such a character often comes from a word processor or a web page. Type it again. Strings need plain \" or '.",
    ),
    (
        r"unindent|unexpected indent|expected an indented block",
        "indentation",
        "All lines of a block must start at the same column, further right than the line with the colon.",
    ),
    (
        r"positional argument follows keyword",
        "syntax-error",
        "In a call, the arguments with a name and = come after all arguments without a name.",
    ),
    (r"forgot a comma", "comma-missing", "Put a comma between two arguments and between two items of a list."),
    (r"instead of '='|cannot assign|meant \"==\"", "equals", "= assigns a value to a name. == compares two values."),
    *RULES,
)
"""Tuples (pattern of Python's message, diagnosis, cause). The first pattern that matches is used."""
NOT_CLOSED = re.compile(r"does not match opening parenthesis '(?P<bracket>.)' on line (?P<line>\d+)")
NO_BODY = re.compile(r"expected an indented block after .* on line (?P<line>\d+)")
OUTSIDE = re.compile(r"\s*(?:def|class|async def|@|if __name__)\b|\s*@")
"""Matches a line with a definition, a decorator or `if __name__`. Such a line is not the body that Python expects."""
ENTRY_POINT = re.compile(r"\s*\w+\s*=\s*[\w.]+:\w+\s*,?\s*")
GAP = re.compile(r"""(?P<left>[\w.]+|"[^"]*"|'[^']*')(?=\s+(?P<right>[\w.]+|"[^"]*"|'[^']*'))""")
"""Matches a value that is followed by spaces and another value. The match ends before the spaces."""
NO_SPACE = re.compile(r"\s*(?P<keyword>def|class)(?P<rest>\w+\s*[(:].*)")
"""Matches a line in which the keyword `def` or `class` is not followed by a space."""
AND = "In Python, the operator && is written as the word and."
OR = "In Python, the operator || is written as the word or."
BLOCK = re.compile(r"\s*(?:def|class|if|elif|else|for|while|try|except|finally|with|async)\b.*(?P<sign>[;,.])\s*")
"""Matches a line that begins a block, but ends with another character in place of the colon."""
SIGNS = {";": "a semicolon", ",": "a comma", ".": "a dot"}
COMMA_FOR_DOT = (
    (r"\s*(?:from|import)\s+\w+(?:,\w+)+\s+import\b.*", "In a module name, write a dot, not a comma."),
    (
        r"\s*(?P<left>[\w.]+)\s*,\s*(?P<right>\w+)[\w.]*\s*(?:[-+*/%@&|^]|//|\*\*|<<|>>)=.*",
        "A comma separates {left} from {right}. Write a dot: {left}.{right}.",
    ),
)
"""Tuples (pattern of an unreadable line, cause) for a comma in place of a dot."""
MOST_LINE, MOST_GAPS = 1000, 20
"""The maximum length of a line that is examined (characters), and the maximum number of places in it where a comma is
tried. With a longer line, such as an array without commas, this would take longer than the reader may."""
CONFLICT = r"^(<<<<<<<|>>>>>>>)"
MIDDLE = "======="
"""The line that Git writes between two conflicting versions. In a docstring, the same line can underline a heading."""
OTHERWISE = "The mistake is often on the previous line: a bracket, a colon or the indentation."
"""The cause if Python's message is only "invalid syntax", and the mistake may be on a line above this line."""
ON_THIS_LINE = "The mistake is on this line. Compare it with a similar line that works, character by character."
"""The cause if Python's message is only "invalid syntax", and Python can read the lines above and this one replaced."""


def why_unreadable(file: str, unreadable: Unreadable, data: bytes) -> Cause:
    """Return the cause of a SyntaxError, with the line that must change if Python reports a different line."""
    line = _line(unreadable, data)
    conflict = line_of(data, CONFLICT) or (unreadable.line if line.rstrip() == MIDDLE else None)
    open_string = "unterminated string" in unreadable.message and unreadable.line != conflict
    if conflict is not None and not open_string:
        text = (
            "Git left two versions in the file, between <<<<<<< and >>>>>>>. Keep one version and delete the markers."
        )
        return Cause("merge-conflict", text, Where(file, conflict))
    place = Where(file, unreadable.line)
    if file.rpartition("/")[2] == "setup.py" and ENTRY_POINT.fullmatch(line):
        return Cause("syntax-error", "An entry point is a string, so it needs quotation marks.", place)
    known = (
        _other_syntax(line, unreadable.message)
        or _other_sign(file, unreadable, data)
        or why_indented(file, unreadable, data)
    )
    if known is not None:
        return known
    empty = NO_BODY.search(unreadable.message)
    if empty is not None and (OUTSIDE.match(line) or (unreadable.line or 0) > int(empty["line"]) + 1):
        text = (
            f"Line {empty['line']} has no body: no indented statement follows it. "
            "A comment is not a statement. Write at least the statement pass."
        )
        return Cause("indentation", text, Where(file, int(empty["line"])))
    other = NOT_CLOSED.search(unreadable.message)
    if other is not None:
        text = f"The bracket {other['bracket']} from line {other['line']} is still open on line {unreadable.line}."
        return Cause("bracket-open", text, Where(file, int(other["line"])))
    if data.startswith(UTF_16):
        return Cause("not-utf8", "Save the file as UTF-8.", Where(file))
    for pattern, diagnosis, text in CAUSES:
        if re.search(pattern, unreadable.message):
            return Cause(diagnosis, text).fixed_by(_fix(diagnosis, file, unreadable, data))
    otherwise = _otherwise(file, unreadable, data) if unreadable.message == "invalid syntax" else ""
    return _no_comma(file, unreadable, data) or Cause("syntax-error", otherwise)


def _otherwise(file: str, unreadable: Unreadable, data: bytes) -> str:
    """Return a sentence about the line of the mistake: this line, or perhaps the line before it."""
    line = _line(unreadable, data)
    space = line[: len(line) - len(line.lstrip())]
    new = f"{space}if True:" if line.rstrip().endswith(":") else f"{space}pass"
    edits = at(Where(file, unreadable.line), line, new) if line.strip() else ()
    changed = applied({file: data}, edits) if edits else None
    alone = not re.match(r"\s*(?:elif|else|except|finally|case)\b", line)
    if alone and changed is not None and _reads_further(file, changed[file], unreadable):
        return ON_THIS_LINE
    return OTHERWISE if (unreadable.line or 0) > 1 else ""


def _other_sign(file: str, unreadable: Unreadable, data: bytes) -> Cause | None:
    """Return the cause if a small change, such as a colon instead of a semicolon, makes the line valid, else None."""
    line, place = _line(unreadable, data), Where(file, unreadable.line)
    block, glued = BLOCK.fullmatch(line), NO_SPACE.fullmatch(line)
    right: dict[Cause, str] = {}
    if glued is not None:
        spaced = f"{line[: glued.end('keyword')]} {glued['rest']}"
        right[Cause("syntax-error", f"A space is missing after {glued['keyword']}.", place)] = spaced
    if block is not None:
        at_end = f"This line ends with {SIGNS[block['sign']]}. A line that begins a block must end with a colon."
        right[Cause("colon-missing", at_end, place)] = f"{line[: block.start('sign')]}:"
    right[Cause("syntax-error", AND, place)] = re.sub(r"\s*&&\s*", " and ", line)
    right[Cause("syntax-error", OR, place)] = re.sub(r"\s*\|\|\s*", " or ", line)
    for cause, new in right.items():
        edits = at(place, line, new) if new != line else ()
        changed = applied({file: data}, edits) if edits else None
        if changed is not None and _reads_further(file, changed[file], unreadable):
            return cause.fixed_by(edits)
    return None


def _no_comma(file: str, unreadable: Unreadable, data: bytes) -> Cause | None:
    """Return the cause if Python can read the line after one comma is inserted between two values, else None."""
    line, place = _line(unreadable, data), Where(file, unreadable.line)
    inside = (gap for gap in GAP.finditer(line) if _opens(line[: gap.end()]))
    for gap in islice(inside, MOST_GAPS):
        before = line[: gap.end()]
        edits = at(place, line, f"{before},{line[gap.end() :]}")
        changed = applied({file: data}, edits)
        if changed is not None and _reads_further(file, changed[file], unreadable):
            text = f"A comma is missing between {shorten(gap['left'])} and {shorten(gap['right'])}."
            return Cause("comma-missing", text, place).fixed_by(edits)
    return None


def _opens(text: str) -> bool:
    """Return whether more brackets are opened than closed in the text."""
    return sum(map(text.count, "([{")) > sum(map(text.count, ")]}"))


def _reads_further(file: str, data: bytes, unreadable: Unreadable) -> bool:
    """Return whether the file has no syntax error, or its first syntax error is on a later line."""
    again = read_module(file, data).unreadable
    return again is None or (again.line or 0) > (unreadable.line or 0)


def _other_syntax(line: str, message: str) -> Cause | None:
    """Return the cause if the line has a comma in place of a dot, or the syntax of another language, else None."""
    for pattern, text in COMMA_FOR_DOT:
        comma = re.fullmatch(pattern, line)
        if comma is not None:
            return Cause(
                "comma-for-dot", text.format(**{key: shorten(word) for key, word in comma.groupdict().items()})
            )
    foreign = next((text for pattern, text in OTHER_LANGUAGES if re.fullmatch(pattern, line)), None)
    usual = re.search(r"invalid syntax|expected ':'|expected 'except'", message)
    return Cause("syntax-error", foreign) if foreign is not None and usual else None


def _fix(diagnosis: Diagnosis, file: str, unreadable: Unreadable, data: bytes) -> tuple[Edit, ...]:
    """Return the edit that adds a colon or a closing parenthesis at the end of the line, if one may be missing."""
    missing = {"colon-missing": ":", "bracket-open": ")"}.get(diagnosis)
    line = _line(unreadable, data).rstrip()
    if missing is None or not line.strip():
        return ()
    return at(Where(file, unreadable.line), line, line + missing)


def _line(unreadable: Unreadable, data: bytes) -> str:
    """Return the line that Python's error message refers to, or "" if there is no such line or it is too long."""
    lines = data.decode("utf-8", "replace").splitlines()
    line = lines[unreadable.line - 1] if unreadable.line and unreadable.line <= len(lines) else ""
    return line if len(line) <= MOST_LINE else ""


def unreadable_observed(file: str, unreadable: Unreadable) -> str:
    """Return a sentence about a file that Python cannot read."""
    message = shorten(unreadable.message, 120)
    return f"Python cannot read {file}: {message}{'' if message.endswith(('.', '?', '!')) else '.'}"


def unreadable_finding(file: str, unreadable: Unreadable, data: bytes) -> Finding:
    """Return a failed finding about a file that Python cannot read."""
    cause = why_unreadable(file, unreadable, data)
    observed = unreadable_observed(file, unreadable)
    return failed(observed, EXPECTED, cause.at(Where(file, unreadable.line)))
