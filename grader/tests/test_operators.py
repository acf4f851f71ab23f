"""The benchmark of causes can generate each of its mistakes, and the same seed generates the same mistake."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING

import pytest

from grader.tests.operators.made import OPERATORS, bases, make

if TYPE_CHECKING:
    from grader.tests.operators.operator import Operator, Package


@pytest.fixture(scope="module")
def right(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[str, Package]]:
    return bases(tmp_path_factory.mktemp("right"))


@pytest.mark.parametrize("operator", OPERATORS, ids=lambda operator: operator.name)
def test_the_mistake_can_be_made_in_some_right_package(operator: Operator, right: list[tuple[str, Package]]) -> None:
    changes = [(package, operator.make(package, random.Random(1))) for _, package in right]
    made = [(package, change) for package, change in changes if change is not None]
    assert made
    assert all(change.files != package.files for package, change in made)


def test_no_two_mistakes_have_the_same_name() -> None:
    names = [operator.name for operator in OPERATORS]
    assert sorted(set(names)) == sorted(names)


def test_the_same_seed_makes_the_same_packages(right: list[tuple[str, Package]]) -> None:
    first, second = ([make(right, number, 7, OPERATORS).files for number in range(20)] for _ in range(2))
    assert first == second
    assert first != [make(right, number, 8, OPERATORS).files for number in range(20)]
