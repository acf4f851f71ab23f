"""Updates for pages that receive them immediately, for slow pages and for hidden pages."""

from __future__ import annotations

import asyncio
import json
from contextlib import suppress

from grader.view.hub import KEPT, Hub


class Page:
    """The messages that a page has received. While `gate` is closed, the page receives nothing."""

    def __init__(self) -> None:
        self.reported: list[dict[str, object]] = []
        self.gate = asyncio.Event()
        self.gate.set()

    async def send(self, text: str) -> None:
        await self.gate.wait()
        self.reported.append(json.loads(text))


async def settle() -> None:
    for _ in range(200):
        await asyncio.sleep(0)


class System:
    """A hub whose full state is a number that each update increases."""

    def __init__(self) -> None:
        self.number = 0
        self.wholes = 0
        self.hub = Hub(self.whole)

    def whole(self) -> dict[str, object]:
        self.wholes += 1
        return {"number": self.number}

    def tell(self) -> None:
        self.number += 1
        self.hub.tell("frame", {"number": self.number})


def test_a_page_gets_the_whole_then_all_news_in_order() -> None:
    async def run() -> Page:
        system, page = System(), Page()
        system.tell()
        following = asyncio.create_task(system.hub.follow(page.send))
        await settle()
        for _ in range(100):
            system.tell()
            await settle()
        following.cancel()
        return page

    page = asyncio.run(run())
    assert page.reported == [
        {"kind": "all", "number": 1},
        *({"kind": "frame", "number": number} for number in range(2, 102)),
    ]


def test_a_page_that_did_not_listen_gets_the_whole_once_and_no_queue() -> None:
    async def run() -> Page:
        system, page = System(), Page()
        following = asyncio.create_task(system.hub.follow(page.send))
        await settle()
        page.gate.clear()
        for _ in range(1000):
            system.tell()
            await settle()
        page.gate.set()
        await settle()
        system.tell()
        await settle()
        following.cancel()
        return page

    reported = asyncio.run(run()).reported
    # The message that was being sent, the full state, and the messages after it.
    assert [each["kind"] for each in reported] == ["all", "frame", "all", "frame"]
    assert [each["number"] for each in reported] == [0, 1, 1000, 1001]


def test_a_page_that_is_a_little_late_misses_nothing() -> None:
    async def run() -> Page:
        system, page = System(), Page()
        following = asyncio.create_task(system.hub.follow(page.send))
        await settle()
        page.gate.clear()
        for _ in range(KEPT):
            system.tell()
            await settle()
        page.gate.set()
        await settle()
        following.cancel()
        return page

    assert [each["number"] for each in asyncio.run(run()).reported] == list(range(KEPT + 1))


def test_the_whole_is_written_once_for_all_pages() -> None:
    async def run() -> tuple[System, list[Page]]:
        system, pages = System(), [Page() for _ in range(10)]
        system.tell()
        following = [asyncio.create_task(system.hub.follow(page.send)) for page in pages]
        await settle()
        for each in following:
            each.cancel()
        return system, pages

    system, pages = asyncio.run(run())
    assert [page.reported for page in pages] == [[{"kind": "all", "number": 1}]] * 10
    assert system.wholes == 1


def test_a_closed_page_is_no_longer_followed() -> None:
    async def run() -> int:
        system = System()
        following = asyncio.create_task(system.hub.follow(Page().send))
        await settle()
        assert system.hub.pages == 1
        following.cancel()
        with suppress(asyncio.CancelledError):
            await following
        return system.hub.pages

    assert asyncio.run(run()) == 0
