"""Give hints one by one. Hints for failed checks come first, and hints for passed checks are omitted."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.checks.kinds import KINDS
from grader.common.words import a_list
from grader.errors import UsageError
from grader.learner import progress, steps

if TYPE_CHECKING:
    from pathlib import Path

    from grader.exercise.model import Exercise, Hint
    from grader.learner.progress import StepProgress


def hint(step: str | None, folder: Path | None, part: str | None = None) -> str:
    """Return the next hint of a step or of a part of a step. The default is the current step.

    Hints for work that is done are omitted. After all other hints have been shown, the last one for a failed check is
    repeated, or the last one if no check failed. If there is no hint to show, the text says why. If `step` is a single
    letter, it is a part of the current step.

    Raises:
        UsageError: no step was named or started, or the step or its part does not exist.
        MachineError: the progress cannot be read or written.
    """
    if step is not None and part is None and re.fullmatch("[A-Za-z]", step):
        step, part = None, step
    root = progress.workspace_of(folder)
    exercise = _exercise(step, folder)
    if not exercise.hints:
        return f"{exercise.id} has no hints."
    wanted = [index for index, each in enumerate(exercise.hints) if part is None or each.part == _part(exercise, part)]
    known = progress.load(root).step(exercise.id)
    index = _next(exercise, wanted, known)
    if index is None and _has_passed(exercise, part, known):
        return f"{_whole(exercise, part)} has passed, so you do not need more hints."
    if index is None:
        whole = _whole(exercise, part)
        return f"{whole} has no hints for the checks that have not passed. `grader check` shows these checks."
    read = (*(each for each in known.read if each != index), index)
    progress.update(root, lambda before: before.with_step(exercise.id, replace(before.step(exercise.id), read=read)))
    place = f"{sum(each in read for each in wanted)} of {len(wanted)}"
    return f"Hint {place}{_about(exercise, index, known)}: {flowing(exercise.hints[index].text)}"


def read_hints(exercise: Exercise, known: StepProgress) -> list[str]:
    """Return the texts of the hints that the learner has read, in the order of reading.

    Hints for work that is done are omitted.
    """
    if known.passed and not known.failed:
        return []
    read = [exercise.hints[index] for index in known.read if index < len(exercise.hints)]
    return [flowing(each.text) for each in read if not _is_done(exercise, each, known)]


def has_next(exercise: Exercise, known: StepProgress) -> bool:
    """Return whether any unread hint is about work that is not done."""
    index = _next(exercise, list(range(len(exercise.hints))), known)
    return index is not None and index not in known.read


def flowing(text: str) -> str:
    """Join the lines of each paragraph, so that the terminal can wrap the text."""
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in text.split("\n\n"))


def _exercise(step: str | None, folder: Path | None) -> Exercise:
    if step is not None:
        return find_exercise(step, outline=True)
    at = steps.current(folder, outline=True)
    if at is None:
        message = "No step has been started. Name a step, as in `grader hint 03`, or start a step: `grader start 01`."
        raise UsageError(message)
    return at[0]


def _part(exercise: Exercise, part: str) -> str:
    """Return the letter of a part of an exercise. The learner can type the letter as d, D or d)."""
    letter = part.lower().rstrip(")")
    parts = sorted({each.part for each in exercise.hints if each.part})
    if letter not in parts:
        has = f"has the part{'s' * (len(parts) > 1)} {a_list(parts)}" if parts else "has no parts"
        message = (
            f"{part!r} is not a part of {exercise.id}, which {has}. "
            f"`grader hint {exercise.id[:2]}` gives the next hint."
        )
        raise UsageError(message)
    return letter


def _next(exercise: Exercise, wanted: list[int], known: StepProgress) -> int | None:
    """Return the index of the next hint, or None if all work for which there are hints is done."""
    open_ = [index for index in wanted if not _is_done(exercise, exercise.hints[index], known)]
    if known.passed and not known.failed:
        open_ = []
    failed = [index for check in known.failed for index in open_ if check in exercise.hints[index].checks]
    in_order = list(dict.fromkeys([*failed, *open_]))
    unread = [index for index in in_order if index not in known.read]
    if unread:
        return unread[0]
    # All hints were read. Repeat the last one for a failed check, or the last hint if no check failed.
    return max(failed or open_, default=None)


def _is_done(exercise: Exercise, hint: Hint, known: StepProgress) -> bool:
    """Return whether the hint's checks have passed. A check of another part counts as passed unless it failed."""
    of_part = {each.id for each in exercise.checks if hint.part and each.title.startswith(f"{hint.part})")}
    needed = set(hint.checks) & of_part or set(hint.checks)
    return bool(needed) and needed <= set(known.done) and not set(hint.checks) & set(known.failed)


def _has_passed(exercise: Exercise, part: str | None, known: StepProgress) -> bool:
    """Return whether the part, or the exercise if `part` is None, has passed, and no check of it failed since then.

    A check that was skipped or ended with `error` has not passed, but a passed exercise stays passed. Advice does not
    count.
    """
    if part is None:
        return known.passed and not known.failed
    begin = f"{_part(exercise, part)})"
    checks = [each for each in exercise.checks if each.title.startswith(begin)]
    if any(each.id in known.failed for each in checks):
        return False
    return known.passed or all(each.id in known.done or each.hidden or KINDS[each.kind].advice for each in checks)


def _about(exercise: Exercise, index: int, known: StepProgress) -> str:
    """Return a phrase with the name of the failed check that the hint is for, or an empty string."""
    titles = {check.id: check.title for check in exercise.checks if not check.hidden}
    about = [titles[check] for check in known.failed if check in exercise.hints[index].checks and check in titles]
    return f', for "{about[0]}"' if about else ""


def _whole(exercise: Exercise, part: str | None) -> str:
    return f"Part {_part(exercise, part)}) of {exercise.id}" if part else exercise.id
