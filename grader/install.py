"""The set-up's second half: fill .venv from the lock file. Runs in .venv, before anything is installed there.

`python -m grader.install STAMP`: STAMP is what bootstrap.py found out, as JSON; with the seconds that each stage took
it is written into .venv at the very end, so that an interrupted set-up is seen as unfinished.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import time
from pathlib import Path

from grader import lock
from grader.bootstrap import MACHINE_BROKEN, ROOT, STAMP, Stamp, say, write_stamp
from grader.errors import MachineError

BIN = Path(sys.prefix, "bin")
_OPTIONS = ("--no-deps", "--require-hashes", "--no-build-isolation")
_PROGRESS = ("Downloading ", "Downloaded ", "Building ", "Built ", "Prepared ", "Installed ", "Bytecode compiled ")
_NO_NETWORK = (
    "The packages could not be installed; what the installer said stands above. Is this machine online? A proxy is "
    "read from HTTPS_PROXY, a mirror from pip's own configuration. The same command goes on from here: what was "
    "downloaded is kept."
)


def main(stamp: Stamp) -> int:
    """Install the stamp's parts and the project itself, then write the stamp; returns the exit code."""
    try:
        seconds = {**stamp.seconds, **install(stamp.parts, sourced=stamp.ros != "wheels")}
    except MachineError as error:
        print(f"\n{error}", file=sys.stderr)
        return MACHINE_BROKEN
    write_stamp(stamp._replace(seconds=seconds))
    say("Set up: " + ", ".join(f"{name} {value:.0f} s" for name, value in seconds.items()))
    return 0


def install(parts: list[str], *, sourced: bool) -> dict[str, float]:
    """Install from the lock file; returns the seconds of download and of installation.

    Raises:
        MachineError: no installer could do it.
    """
    text = lock.LOCK_FILE.read_text(encoding="utf-8")
    if sourced:
        parts = [part for part in parts if part != "ros"]
    without = lock.SOURCED_BRINGS if sourced else frozenset()

    begin = time.monotonic()
    say("Installing the installer (uv)")
    first = _write("setup", lock.select(text, ["setup"]))
    if _pip(first, quiet=True) != 0:
        raise MachineError(_NO_NETWORK)

    say("Installing " + ("what the grader needs" if sourced else "ROS 2 Jazzy and what the grader needs"))
    rest = _write("rest", lock.select(text, parts, without))
    downloading = _uv("-r", str(rest), *_OPTIONS, "--compile-bytecode")
    if downloading is None:
        # pip knows settings that uv does not read: mirrors, certificates and proxies in pip.conf.
        say("That did not work with uv; once more with pip, which is slower")
        if _pip(rest) != 0:
            raise MachineError(_NO_NETWORK)
    project = ("--no-deps", "--no-build-isolation", "--editable", str(ROOT))
    if _uv(*project) is None and subprocess.call([sys.executable, "-m", "pip", "install", *project]) != 0:
        message = f"The course's own package could not be installed from {ROOT}; what the installer said stands above."
        raise MachineError(message)
    total = time.monotonic() - begin
    return {"download": downloading or 0.0, "install": total - (downloading or 0.0)}


def _pip(requirements: Path, *, quiet: bool = False) -> int:
    command = [sys.executable, "-m", "pip", "install", "--disable-pip-version-check", "--no-input", "--retries", "2"]
    command += ["--progress-bar", "off", *(["--quiet"] if quiet else []), *_OPTIONS, "-r", str(requirements)]
    return subprocess.call(command, cwd=ROOT)


def _uv(*arguments: str) -> float | None:
    """`uv pip install`: its progress is shown, the rest only if it fails. Returns the seconds of download, or None."""
    command = [str(BIN / "uv"), "pip", "install", "--python", sys.executable, *arguments]
    other: list[str] = []
    downloading = 0.0
    # Piped, it prints a line when a download begins and ends: slow lines see progress, logs stay readable.
    with subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True, errors="replace") as process:
        for line in process.stderr or ():
            if line.strip().startswith(_PROGRESS):
                print(f"  {line.strip()}", flush=True)
            else:
                other.append(line)
            if line.startswith("Prepared "):
                downloading = seconds_of(line)
    if process.returncode != 0:
        print("".join(line for line in other if not line.startswith(" + ")), file=sys.stderr, end="")
        return None
    return downloading


def seconds_of(line: str) -> float:
    """The duration at the end of a line of uv's: `Prepared 9 packages in 1m 05s`, `... in 302ms` (in seconds)."""
    units = {"ms": 1e-3, "s": 1.0, "m": 60.0, "h": 3600.0}
    found: list[tuple[str, str]] = re.findall(r"(\d+(?:\.\d+)?)(ms|s|m|h)\b", line.rpartition(" in ")[2])
    return sum(float(number) * units[unit] for number, unit in found)


def _write(name: str, requirements: str) -> Path:
    path = STAMP.with_name(f"course-{name}.txt")
    path.write_text(requirements, encoding="utf-8")
    return path


if __name__ == "__main__":
    try:
        sys.exit(main(Stamp(**json.loads(sys.argv[1]))))
    except KeyboardInterrupt:
        sys.exit(130)
