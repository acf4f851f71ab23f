"""The plan of a trial, which depends on the seed, the option `--clock` and the checks."""

from __future__ import annotations

from grader.grading.plan import plan_of
from grader.tests.checks.made import TOPIC, evidence
from grader.turtlesim.turtle import Start


def test_without_a_seed_the_turtle_starts_as_in_turtlesim() -> None:
    start = plan_of(evidence(None), "simulated", choice="auto", seed=None).start
    assert (start.x, start.y, start.theta) == tuple(Start())


def test_a_seed_gives_the_same_other_start_each_time() -> None:
    plans = [plan_of(evidence(None), "simulated", choice="auto", seed=seed) for seed in (None, 5, 5, 6)]
    assert plans[1] == plans[2]
    assert len({(plan.start.x, plan.start.y) for plan in plans}) == 3


def test_the_topics_of_the_checks_are_always_recorded() -> None:
    assert TOPIC in plan_of(evidence(None), "wall", choice="auto", seed=None).judged


def test_a_doubt_ends_the_trial_only_if_wall_time_may_follow() -> None:
    plans = [plan_of(evidence(None), "simulated", choice=choice, seed=None) for choice in ("auto", "simulated")]
    assert [plan.stop_at_doubt for plan in plans] == [True, False]
