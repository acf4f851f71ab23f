"""Measure how long it takes to create and show the page of a report, and the page of a class of 200 students.

    python -m grader.benchmarks.html [--times N] [--submission FOLDER]

F (see grader.benchmarks.check) and the cost of the page are measured alternately in one run. The cost of the page is
the time that `grader check --html` needs in addition to `grader check`, including imports.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from grader.benchmarks.bare import bare_costs
from grader.benchmarks.measure import cost
from grader.common.interpreter import interpreter

if TYPE_CHECKING:
    from playwright.sync_api import Page

_ROOT = Path(__file__).resolve().parents[2]
_GRADER = str(Path(sys.executable).with_name("grader"))
_CLASS = 200

# This script works like `grader regrade`, then creates the page, and prints the time for creating it (s) and its size.
_PAGE = """
import sys, time
from pathlib import Path
from rich.console import Console
from grader.evidence import recording_format
from grader.checks.exercises import load_exercise
from grader.checks.judge import judge
from grader.report.report import report_of
from grader.report import json, terminal
kept = recording_format.load(Path(sys.argv[1]), load_exercise)
report = report_of(kept.evidence, judge(kept.evidence), kept.ros, {})
json.to_json(report)
terminal.render(report, Console(file=open("/dev/null", "w")))
begun = time.perf_counter()
from grader.report.html import save_html
save_html(kept.evidence, report, Path(sys.argv[2]))
print(time.perf_counter() - begun, Path(sys.argv[2]).stat().st_size)
"""


def main() -> None:
    """Measure everything and print the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--times", type=int, default=5, help="number of measurements, whose median is printed")
    parser.add_argument("--submission", type=Path, default=_ROOT / "solutions/03-circle-publisher")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        _making(arguments.submission, Path(folder), arguments.times)
        _showing(Path(folder), arguments.times)


def _making(submission: Path, folder: Path, times: int) -> None:
    recording = folder / "recording"
    cost([_GRADER, "check", str(submission), "--recording", str(recording), "--json", str(folder / "report.json")])
    bare, pages, size_kb = [], [], 0.0
    for number in range(times):
        home = folder / f"bare{number}"
        home.mkdir()
        bare.append(sum(each.wall_s for each in bare_costs(submission, home).values()))
        seconds, size_kb = page_cost(recording, folder / "page.html")
        pages.append(seconds)
    f_s, page_s = statistics.median(bare), statistics.median(pages)
    print(f"F = {f_s:.2f} s wall (medians of {times})")
    print(f"creating a page     {page_s:6.3f} s = {page_s / f_s:.2f} F   ({size_kb:.0f} KB)")


def page_cost(recording: Path, page: Path) -> tuple[float, float]:
    """Write the page of a recording. Return the time for writing the page (s) and the size of the page (KB)."""
    start = interpreter("-c", _PAGE, str(recording), str(page))
    done = subprocess.run(start.argv, check=True, capture_output=True, text=True)
    seconds, size = done.stdout.split()
    return float(seconds), int(size) / 1024


def _showing(folder: Path, times: int) -> None:
    from grader.report.html_class import save_class_page
    from grader.report.json import from_json, to_json
    from grader.tests.browser import find_browser, launched

    report = from_json((folder / "report.json").read_text())
    reports = folder / "class"
    reports.mkdir()
    for number in range(_CLASS):
        named = replace(report, submission=f"submitted/student{number}/{report.exercise}")
        (reports / f"student{number}.json").write_text(to_json(named))
        (reports / f"student{number}.html").touch()
    making = interpreter("-m", "grader.cli", "class-page", str(reports)).argv
    print(f"creating a class page {cost(making).wall_s:6.2f} s for {_CLASS}, including the start of Python")
    browser = find_browser()
    if browser is None:
        print("Chromium is missing, so the time to show the pages in a browser was not measured")
        return
    save_class_page(reports, folder / "class.html")
    with launched(browser) as chromium:
        for name in ("page.html", "class.html"):
            tab = chromium.new_page()
            samples = [_opening(tab, (folder / name).as_uri()) for _ in range(times + 1)][1:]
            scripts, shown = (1000 * statistics.median(each) for each in zip(*samples, strict=True))
            print(f"showing {name:12} {shown:6.0f} ms until loaded, {scripts:.0f} ms of it in scripts")
            tab.close()


def _opening(tab: Page, address: str) -> tuple[float, float]:
    """Open a page. Return the time for which the page's scripts ran, and the time until the page was loaded (s)."""
    session = tab.context.new_cdp_session(tab)
    session.send("Performance.enable")
    tab.goto(address)
    metrics = {each["name"]: each["value"] for each in session.send("Performance.getMetrics")["metrics"]}
    timing = json.loads(tab.evaluate("JSON.stringify(performance.getEntriesByType('navigation')[0])"))
    tab.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    session.detach()
    return float(metrics["ScriptDuration"]), float(timing["loadEventEnd"]) / 1000.0


if __name__ == "__main__":
    main()
