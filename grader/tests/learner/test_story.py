"""A learner goes through the course on a real terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.exercise.model import catalogue
from grader.tests.learner.story import Learner, walk

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def learner(tmp_path: Path) -> Learner:
    return Learner(tmp_path)


def test_the_first_steps(learner: Learner) -> None:
    walk(learner, list(catalogue())[:2])


@pytest.mark.exhaustive
def test_the_whole_course(learner: Learner) -> None:
    walk(learner, list(catalogue()))
