from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from grader.tests.lacking import give_up


@pytest.fixture(scope="session")
def shim(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The library that makes system calls fail."""
    compiler = shutil.which("cc") or shutil.which("c++") or give_up("cc", "g++")
    library = tmp_path_factory.mktemp("faults") / "shim.so"
    source = Path(__file__).with_name("shim.c")
    subprocess.run([compiler, "-x", "c", "-shared", "-fPIC", "-O1", "-o", library, source, "-ldl"], check=True)
    return library
