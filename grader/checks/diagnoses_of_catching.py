"""The ids of mistakes of two nodes that spawn and catch turtles, with their meanings. diagnoses.py has all ids."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis

OF_CATCHING: dict[str, dict[Diagnosis, str]] = {
    "Spawning and catching": {
        "target-count": "the number of spawned turtles is wrong",
        "target-name": "a spawned turtle has another name than it should",
        "target-place": "a turtle is spawned outside of the field, or all of them are at one place",
        "target-unannounced": "a turtle that is there is not announced",
        "target-format": "the names in an announcement are not separated by spaces only",
        "still-announced": "a turtle that was caught, or was never there, is announced",
        "not-killed": "a turtle that was caught is not removed",
        "loop-variable": "a function made in a loop uses the variable of the loop, which has its last value by then",
        "never-drives": "the turtle does not move at all",
        "stands-still": "the turtle stands still although a target is left",
        "too-slow": "the turtle drives to the end of the trial and does not reach all targets",
        "other-order": "a target is caught although another one is nearer",
        "from-afar": "a target is caught from too far away",
        "catch-again": "the same target is asked for again and again",
        "not-driven": "the turtle is moved, or a target is removed, in a way that is not allowed",
        "other-node-ended": "the trial ended because the other node ended",
    },
}
