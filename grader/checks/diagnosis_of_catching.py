"""The ids of mistakes in nodes that spawn and catch turtles, as a type. diagnosis.py lists all ids."""

from __future__ import annotations

from typing import Literal

DiagnosisOfCatching = Literal[
    "target-count",
    "target-name",
    "target-place",
    "target-unannounced",
    "target-format",
    "still-announced",
    "silent-when-empty",
    "not-killed",
    "killed-uncaught",
    "loop-variable",
    "never-drives",
    "stands-still",
    "too-slow",
    "reach-too-small",
    "turns-away",
    "atan2-swapped",
    "angle-in-degrees",
    "farthest-chosen",
    "other-order",
    "from-afar",
    "drives-before-pose",
    "catch-again",
    "not-driven",
    "other-node-ended",
    "not-forgotten",
    "service-not-ready",
]
