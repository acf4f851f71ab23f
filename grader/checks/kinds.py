"""All kinds of checks by name: the values that `kind` may have in exercise.toml."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.checks.subjects import (
    advice,
    answers,
    arc,
    bag_answers,
    building,
    eight,
    entry_point,
    fit,
    goal,
    log,
    log_pose,
    no_calls,
    own,
    package_xml,
    parameters,
    path,
    pause,
    program,
    rate,
    recorded_bag,
    running,
    services,
    square,
    stop,
    topic,
    values,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.checks.kind import Kind

KINDS: Mapping[str, Kind[Any]] = {
    kind.name: kind
    for kind in (
        building.PLAIN_FILES,
        package_xml.VALID,
        package_xml.DEPENDENCIES,
        package_xml.NAME,
        building.BUILDS,
        building.INSTALLS,
        entry_point.ENTRY_POINT,
        running.STARTS,
        running.NAME,
        topic.PUBLISHES,
        topic.ONLY_TYPE,
        topic.SUBSCRIBES,
        rate.RATE,
        values.VALUES,
        log.LOG_LINES,
        log.LOG_RATE,
        log.LOG_COUNTER,
        log_pose.LOG_POSITION,
        log_pose.LOG_DISTANCE,
        path.CIRCLE,
        path.NO_WALL,
        own.NUMBERS,
        own.CIRCLE,
        own.RATE,
        eight.EIGHT,
        square.SQUARE,
        goal.GOAL,
        answers.ANSWERS,
        answers.TEXT,
        answers.LIST,
        answers.GRAPH,
        answers.RATE,
        no_calls.NO_CALLS,
        arc.ARC,
        services.CALLS,
        services.ANSWERS,
        pause.PAUSE,
        parameters.DECLARES,
        parameters.SETS,
        recorded_bag.READABLE,
        recorded_bag.TOPIC,
        recorded_bag.CIRCLE,
        fit.FITS,
        fit.REFUSES,
        program.PRINTS,
        program.ENDS,
        bag_answers.ANSWER,
        stop.STOP,
        advice.USES_TIMER,
    )
}
