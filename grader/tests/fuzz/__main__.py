"""Run a target with atheris: `python -m grader.tests.fuzz TARGET --minutes N`. Needs `pip install atheris`.

A finding ends the run. The input that caused the finding is stored in build/fuzz/TARGET/; `--again FILE` runs this
input again. `--table` prints what all runs in this clone have done.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

from grader.tests.fuzz import inline
from grader.tests.fuzz.runs import Tally, kept_as, table

SECONDS, MEBIBYTES = 20, 3072
"""The limits on CPU time and memory for one input."""
FOLDER = Path("build/fuzz")
HANGS_S = 1800
"""The limit on wall time for one input (s). On a busy machine, wall time says little about an input."""


def main() -> None:
    """Run a target."""
    parser = argparse.ArgumentParser(prog="python -m grader.tests.fuzz")
    parser.add_argument("target", nargs="?", help="what to fuzz")
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--again", type=Path, metavar="FILE", help="run this input alone")
    parser.add_argument("--table", action="store_true", help="print the sums of all runs, and run nothing")
    requested = parser.parse_args()
    try:
        import atheris  # type: ignore[import-not-found, import-untyped, unused-ignore]
    except ImportError:
        parser.error("atheris is not installed: pip install atheris")
    with atheris.instrument_imports(include=["grader", "catkin_pkg", "tomllib", "zipfile", "tarfile", "rosbags"]):
        from grader.submission import reader

        # The target runs in this process, because atheris cannot trace a child process. atheris sets the limits.
        # Replace the function before the import of the modules that import it by name.
        reader.read = inline.read
        from grader.tests.fuzz.targets import TARGETS
        from grader.tests.no_ros import hide_ros
    if requested.table:
        print(table(FOLDER, TARGETS))
        return
    if requested.target not in TARGETS:
        parser.error(f"the targets are {', '.join(TARGETS)}")
    target = TARGETS[requested.target]
    hide_ros(Path(tempfile.mkdtemp()))
    kept = FOLDER / kept_as(requested.target)
    (kept / "corpus").mkdir(parents=True, exist_ok=True)
    for number, seed in enumerate(target.seeds()):
        (kept / "corpus" / f"seed-{number}").write_bytes(seed)
    if requested.again:
        target.run(requested.again.read_bytes())
        return

    tally = Tally(kept)

    def in_time(data: bytes) -> None:
        tally.count()
        begun_s = time.process_time()
        target.run(data)
        took_s = time.process_time() - begun_s
        assert took_s <= SECONDS, f"this input took {took_s:.0f} s of CPU time"

    target.run(b"")  # the imports of a target are not part of the first input
    options = {
        "max_total_time": round(60 * requested.minutes),
        "timeout": HANGS_S,
        "rss_limit_mb": MEBIBYTES,
        "max_len": 65536,
        "artifact_prefix": f"{kept}/",
        "print_final_stats": 1,
    }
    atheris.Setup(
        [sys.argv[0], *(f"-{name}={value}" for name, value in options.items()), str(kept / "corpus")], in_time
    )
    atheris.Fuzz()


if __name__ == "__main__":
    main()
