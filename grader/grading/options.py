"""Options: how a submission is graded."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.grading.clock import ClockChoice


@dataclass(frozen=True)
class Options:
    """The options for grading a submission. With `in_cell`, the student's code runs in a sandbox (grader.sandbox).

    `trials_at_once` is the maximum number of trials of an exercise that run at the same time. Set this number to 1 if
    other submissions are graded at the same time.
    """

    in_cell: bool
    clock: ClockChoice = "auto"
    seed: int | None = None
    explain: bool = False
    """Whether the grader proves the cause of a failed check by fixing it in a copy of the submission."""
    trials_at_once: int = field(default_factory=lambda: len(os.sched_getaffinity(0)))

    @property
    def runs_during_build(self) -> bool:
        """Whether nodes may run from a predicted install tree while the submission is built.

        Without a sandbox, the build could change the behaviour of nodes that run at the same time. If other submissions
        are graded at the same time, no processor is free for such nodes.
        """
        return self.in_cell and self.trials_at_once > 1
