"""The ids of mistakes in nodes that spawn and catch turtles, with their meanings. diagnoses.py lists all ids."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis

OF_CATCHING: dict[str, dict[Diagnosis, str]] = {
    "Spawning and catching": {
        "target-count": "the number of spawned turtles is wrong",
        "target-name": "a spawned turtle has the wrong name, or a turtle is caught under a wrong name",
        "target-place": "a turtle is spawned too near the edge, or the places of the turtles are not random",
        "target-unannounced": "an existing turtle is not announced",
        "target-format": "an announcement does not consist of names that are separated by single spaces",
        "still-announced": "a turtle that does not exist yet, no longer exists or never existed is announced",
        "silent-when-empty": "no message is published when no turtle is left",
        "not-killed": "a turtle that was caught is not removed, or is removed too late",
        "killed-uncaught": "a turtle is removed although nobody caught it",
        "loop-variable": "a function created in a loop uses the loop variable, whose value has changed before the call",
        "never-drives": "the turtle does not move at all",
        "stands-still": "the turtle stands still although a target is left",
        "too-slow": "the turtle drives until the end of the trial but does not reach all targets",
        "reach-too-small": "the turtle is near enough to a target, but the node does not try to catch it",
        "turns-away": "the turtle turns away from the nearest target",
        "atan2-swapped": "atan2 gets the difference in x as its first argument",
        "angle-in-degrees": "an angle is converted to degrees, although the turtle's heading is in radians",
        "farthest-chosen": "the node drives to the farthest target",
        "other-order": "a target is caught although another one is nearer",
        "from-afar": "a target is caught from too far away",
        "drives-before-pose": "turtle1 is driven before its first pose has arrived",
        "catch-again": "the node tries to catch one target repeatedly, or no try for a removed target was recorded",
        "not-driven": "the turtle is moved, or a target is removed, by a call that is not allowed",
        "other-node-ended": "the trial ended because the other node ended",
        "not-forgotten": "the node does not forget a target that is no longer announced",
        "service-not-ready": "the node calls a service that does not exist yet, so the request is lost",
    },
}
