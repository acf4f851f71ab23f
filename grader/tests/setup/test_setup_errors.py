from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path
from typing import NoReturn

import pytest

from grader.setup import machine, setup_errors

HERE = Path("/nowhere/course/.venv")


@pytest.mark.parametrize(
    ("said", "reported"),
    [
        ("Error: [Errno 28] No space left on device", "The disk is full for /nowhere/course/.venv: free some space"),
        ("  cause: failed to copy: No space left on device (os error 28)", "The disk is full for "),
        ("Error: [Errno 30] Read-only file system: '/x'", "/.venv cannot be written to (Read-only file system): copy"),
        ("Error: [Errno 13] Permission denied: '/x'", "/.venv cannot be written to (Permission denied): copy"),
        ("OSError: [Errno 24] Too many open files", "`ulimit -n 4096`"),
        (
            "certificate verify failed: certificate is not yet valid (_ssl.c:992)",
            "If this time is wrong, set the clock",
        ),
        ("certificate verify failed: certificate has expired (_ssl.c:992)", "If this time is wrong, set the clock"),
        ("certificate not valid yet: verification time 978307200 (UNIX)", "If this time is wrong, set the clock"),
        ("certificate expired: verification time 2682374400 (UNIX)", "If this time is wrong, set the clock"),
        (
            "[SSL: CERTIFICATE_VERIFY_FAILED] certificate verify failed: self-signed certificate in certificate chain",
            "does not trust the certificate of the package index (self-signed certificate)",
        ),
        (
            "certificate verify failed: unable to get local issuer certificate (_ssl.c:992)",
            "set PIP_CERT and SSL_CERT_FILE to its path",
        ),
        ("Error: [Errno 38] Function not implemented: 'lib' -> '/x/.venv/lib64'", "does not support symbolic links"),
        ("Error: [Errno 30] Read-only file system: 'lib' -> '/x/.venv/lib64'", "does not support symbolic links"),
        ("BlockingIOError: [Errno 11] Resource temporarily unavailable", "cannot start more processes for you"),
    ],
)
def test_what_an_installer_printed_is_one_sentence(said: str, reported: str) -> None:
    sentence = setup_errors.of_output(f"Collecting uv\n{said}\n", HERE)
    assert sentence is not None
    assert reported in sentence
    assert sentence.endswith(".")
    assert "\n" not in sentence


def test_a_certificate_that_only_uv_does_not_trust_is_left_to_pip() -> None:
    assert setup_errors.of_output("error: invalid peer certificate: UnknownIssuer", HERE) is None


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a folder to another user")
@pytest.mark.parametrize(("owner", "reported"), [(0, "Type sudo chown -R 12345:"), (12345, "copy the course's folder")])
def test_files_of_root_after_sudo_make_are_reported_with_the_command_that_helps(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, owner: int, reported: str
) -> None:
    (tmp_path / ".venv").mkdir()
    os.chown(tmp_path, 12345, -1)
    os.chown(tmp_path / ".venv", owner, -1)
    monkeypatch.setattr(setup_errors, "ROOT", tmp_path)
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    said = "Error: [Errno 13] Permission denied: '/x'"
    assert reported in str(setup_errors.of_output(said, tmp_path / ".venv/bin"))


def test_a_path_below_a_folder_of_another_user_is_looked_for_without_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuses(_: Path) -> NoReturn:
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(Path, "exists", refuses)
    assert setup_errors.nearest(tmp_path / "closed/demo") == tmp_path


def test_a_disk_without_room_is_the_cause_whatever_was_printed(monkeypatch: pytest.MonkeyPatch) -> None:
    said = "Error: Command '[...]' returned non-zero exit status 1."
    assert setup_errors.of_output(said, HERE) is None
    monkeypatch.setattr(setup_errors, "_FULL_MB", 10**9)
    assert "The disk is full for /nowhere/course/.venv" in (setup_errors.of_output(said, HERE) or "")


def test_words_of_a_missing_network_are_found() -> None:
    assert setup_errors.offline("[Errno -3] Temporary failure in name resolution')") == (
        "Temporary failure in name resolution"
    )
    assert setup_errors.offline("dns error: failed to lookup address information") == "failed to lookup address"
    assert setup_errors.offline("Failed to establish a new connection: [Errno 111] Connection refused')") == (
        "Connection refused"
    )
    assert setup_errors.offline("ERROR: THESE PACKAGES DO NOT MATCH THE HASHES") is None


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS, errno.EACCES, errno.EMFILE, errno.ENOMEM, errno.EAGAIN])
def test_a_failed_system_call_of_the_set_up_is_reported_in_one_sentence(number: int) -> None:
    code = "import sys; from grader.setup import setup_errors\ndef main(): raise OSError({}, 'x', '/course')\n"
    done = subprocess.run(
        [sys.executable, "-c", code.format(number) + "sys.exit(setup_errors.guarded(main))"],
        cwd=Path(setup_errors.__file__).parents[2],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (3, "", 1), done.stderr
    assert "Traceback" not in done.stderr


def test_a_full_disk_behind_standard_output_is_reported_in_one_sentence() -> None:
    code = "import sys; from grader.setup import setup_errors; sys.exit(setup_errors.guarded(lambda: print('x') or 0))"
    root = Path(setup_errors.__file__).parents[2]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-c", code], cwd=root, stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert (done.returncode, done.stderr.count("\n")) == (3, 1), done.stderr
    assert done.stderr.startswith("The disk is full: free some space there")


def test_ctrl_c_says_how_to_go_on(capsys: pytest.CaptureFixture[str]) -> None:
    def main() -> NoReturn:
        raise KeyboardInterrupt

    assert setup_errors.guarded(main) == 130
    assert "The same command continues from here" in capsys.readouterr().err


def test_ctrl_c_while_python_exits_prints_nothing() -> None:
    code = (
        "import atexit, os, signal; from grader.setup import setup_errors\n"
        "atexit.register(os.kill, os.getpid(), signal.SIGINT)\n"
        "setup_errors.run_and_exit(lambda: 7)"
    )
    root = Path(setup_errors.__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (7, "", "")


def test_a_machine_that_starts_no_process_says_nothing_about_its_pythons(monkeypatch: pytest.MonkeyPatch) -> None:
    def check_output(*_: object, **__: object) -> NoReturn:
        raise BlockingIOError(errno.EAGAIN, "x")

    monkeypatch.setattr(subprocess, "check_output", check_output)
    with pytest.raises(BlockingIOError):
        machine.probe(sys.executable)
