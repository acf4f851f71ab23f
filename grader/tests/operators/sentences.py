"""The forms of sentences that can be checked against the two packages, the source and the recording."""

from __future__ import annotations

import math
import re
from collections import Counter
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.evidence import activity
from grader.tests.operators.facts import WORD

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.checks.outcome import Outcome
    from grader.tests.operators.facts import Facts


def _is_right_word(facts: Facts, match: re.Match[str], _: Outcome) -> bool:
    """Return whether the suggested name was removed by the mistake, or is the name of an existing file."""
    parts = re.findall(r"\w+", match["word"])
    there = any(path.endswith(f"{match['word'].replace('.', '/')}.py") for path in facts.wrong)
    return there or any(part in facts.words[0] for part in parts)


def _stands_in(facts: Facts, match: re.Match[str], _: Outcome) -> bool:
    return any(match["word"] in text for text in facts.wrong.values())


def _never_called(facts: Facts, match: re.Match[str], _: Outcome) -> bool:
    name = match["word"].rpartition(".")[2]
    return not re.search(rf"(?<!def )\b{name}\(", facts.source)


def _is_named_nowhere(facts: Facts, match: re.Match[str], _: Outcome) -> bool:
    return not re.search(rf"(?<!def )\b{match['word']}\b", facts.source)


def _on_line(facts: Facts, match: re.Match[str], outcome: Outcome) -> bool:
    line = facts.line(outcome, int(match["line"]))
    return re.search(rf"\b{match['word']}\b", line) is not None


def _not_imported(facts: Facts, match: re.Match[str], outcome: Outcome) -> bool:
    where = outcome.finding.where
    text = facts.wrong.get(where.file, "") if where is not None else ""
    return not re.search(rf"(?m)^\s*(?:from\s.*)?import\b.*\b{match['word']}\b|import \*", text)


def _was_indentation(facts: Facts, _: re.Match[str], __: Outcome) -> bool:
    return any(
        [line.strip() for line in change.old] == [line.strip() for line in change.new] for change in facts.changes
    )


def _missing(signs: str) -> Callable[[Facts, re.Match[str], Outcome], bool]:
    return lambda facts, _, __: any(facts.words[0][sign] for sign in signs)


def _is_extra(facts: Facts, _: re.Match[str], __: Outcome) -> bool:
    return any(facts.words[1][sign] or facts.words[0][sign] for sign in "()[]{}")


def _swapped(facts: Facts, _: re.Match[str], outcome: Outcome) -> bool:
    """Return whether the same words, in another order, are in a line or two successive lines of the correct package."""
    where = outcome.finding.where
    if where is None or where.line is None:
        return False
    old, new = (files.get(where.file, "").splitlines() for files in (facts.right, facts.wrong))
    for size in (1, 2):
        here = "\n".join(new[where.line - 1 : where.line - 1 + size])
        there = ["\n".join(old[at : at + size]) for at in range(len(old))]
        if any(each != here and _is_other_order(WORD.findall(each), WORD.findall(here)) for each in there):
            return True
    return False


def _is_other_order(right: list[str], wrong: list[str]) -> bool:
    """Return whether the same words are in another order. Another mistake may have changed one of the words."""
    removed, added = Counter(right) - Counter(wrong), Counter(wrong) - Counter(right)
    if removed.total() > 1 or added.total() > 1:
        return False
    return [word for word in right if word not in removed] != [word for word in wrong if word not in added] or (
        not removed and not added
    )


def _timers(facts: Facts, match: re.Match[str], _: Outcome) -> bool:
    return len(re.findall(r"create_timer\(", facts.source)) == int(match["count"])


def _attribute(facts: Facts, match: re.Match[str], _: Outcome) -> bool:
    known = re.search(rf"self\.{match['word']}\b|def {match['word']}\b", facts.source)
    return known is not None or match["word"].startswith(("create_", "get_", "destroy_"))


def _commands(facts: Facts) -> list[float]:
    recording = facts.evidence.recording
    until = activity.end_s(recording)
    return [command.t_s for command in recording.commands if activity.START_S < command.t_s < until]


def _rate(facts: Facts, match: re.Match[str], _: Outcome) -> bool:
    if not match[0].startswith("Commands"):
        return True
    times = _commands(facts)
    mean = (times[-1] - times[0]) / (len(times) - 1) if len(times) > 1 else math.inf
    return abs(mean - float(match["number"])) <= max(0.006, 0.03 * mean)


def _all_commands(facts: Facts, match: re.Match[str], _: Outcome) -> bool:
    until = activity.end_s(facts.evidence.recording)
    return sum(command.t_s < until for command in facts.evidence.recording.commands) == int(match["count"])


def _turned(facts: Facts) -> float:
    turns = pairwise(facts.evidence.recording.frames.theta)
    return float(sum(math.remainder(later - earlier, math.tau) for earlier, later in turns))


def _direction(facts: Facts, match: re.Match[str], _: Outcome) -> bool:
    return (_turned(facts) < 0.0) == (match["word"] == "clockwise")


def _went(facts: Facts) -> float:
    frames = facts.evidence.recording.frames
    return float(max(math.dist((x, y), (frames.x[0], frames.y[0])) for x, y in zip(frames.x, frames.y, strict=True)))


def _ended(facts: Facts, _: re.Match[str], __: Outcome) -> bool:
    return facts.evidence.recording.end.by == "itself"


NAME = r"(?P<word>[A-Za-z_][\w.]*\w|\w)"
SENTENCES: dict[str, Callable[[Facts, re.Match[str], Outcome], bool]] = {
    rf"(?:There is|the name is) (?:a name |a module |a folder )?{NAME}\. (?:Compare|Upper)": _is_right_word,
    rf"Did you mean {NAME}\?": _is_right_word,
    rf"but there is {NAME}\.": _stands_in,
    r'The file declares "(?P<word>[^"]+)"': _stands_in,
    rf"\b{NAME} is never called": _never_called,
    rf"Nothing calls {NAME}": _is_named_nowhere,
    rf"Line (?P<line>\d+) assigns {NAME}": _on_line,
    rf"self\.{NAME} is assigned on line (?P<line>\d+)": _on_line,
    rf"\b{NAME} gets its value on line (?P<line>\d+)": _on_line,
    rf"\b{NAME} is a local variable of \w+ \(line (?P<line>\d+)\)": _on_line,
    rf"The file does not import (?:the module )?{NAME}": _not_imported,
    r"outside the class|indented too far|is indented, so": _was_indentation,
    r"[Aa] colon is missing": _missing(":"),
    r"[Aa] comma is missing": _missing(","),
    r"never closed": _missing(")]}"),
    r"[Aa] quotation mark is missing": _missing("\"'"),
    r"the parentheses (?:after its name )?are missing": _missing("("),
    r"one closing bracket too many": _is_extra,
    r"in this order|are swapped": _swapped,
    r"There are (?P<count>\d+) timers": _timers,
    rf"write self\.{NAME}": _attribute,
    r"Commands arrived every (?P<number>[\d.]+) s": _rate,
    r"All (?P<count>\d+) commands were": _all_commands,
    r"drove the circle (?P<word>(?:counter-)?clockwise)": _direction,
    r"The turtle (?:did not move|turned on the spot)": lambda facts, _, __: _went(facts) < 0.06,
    r"The turtle turns too little or not at all": lambda facts, _, __: abs(_turned(facts)) < 0.11,
    r"exited on its own|crashed": _ended,
    r"Nothing was built|The node was not run": lambda facts, _, __: facts.evidence.run.recording is None,
}
"""Maps each pattern of a sentence to a function that tests its truth. The patterns have named groups such as `word`."""


def false_sentences(facts: Facts, outcome: Outcome) -> list[str]:
    """Return the sentences of an outcome that contradict a fact."""
    finding = outcome.finding
    text = f"{finding.observed} {finding.cause}"
    found = [
        match[0]
        for pattern, holds in SENTENCES.items()
        for match in re.finditer(pattern, text)
        if not holds(facts, match, outcome)
    ]
    where = finding.where
    if where is not None and (
        where.file not in {*facts.wrong, *facts.right}
        or (where.line or 1) > facts.wrong.get(where.file, "").count("\n") + 1
    ):
        found.append(f"no such place: {where}")
    return found
