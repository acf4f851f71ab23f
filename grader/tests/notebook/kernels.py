"""Start the course's kernel as Jupyter does, for tests that execute cells."""

from __future__ import annotations

import tempfile
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import nbformat
from jupyter_client.kernelspec import KernelSpec
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient

from grader.notebook.kernel import kernelspec
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


class CourseKernel(AsyncKernelManager):
    """Starts the course's kernel, whether or not it is installed for the current user."""

    @property
    def kernel_spec(self) -> KernelSpec:
        spec: dict[str, Any] = kernelspec()
        return KernelSpec(argv=spec["argv"], display_name=spec["display_name"], language=spec["language"])


@dataclass
class Notebook:
    """An open notebook."""

    client: NotebookClient
    outputs: list[Any] = field(default_factory=list)

    def run(self, source: str) -> str:
        """Run a cell. Return all text below the cell, including errors."""
        cell = nbformat.v4.new_code_cell(source)  # type: ignore[no-untyped-call]
        self.client.nb.cells.append(cell)
        self.client.execute_cell(cell, len(self.client.nb.cells) - 1)
        self.outputs = cell.outputs
        texts = [
            output.get("text") or output.get("data", {}).get("text/plain") or output.get("evalue") or ""
            for output in cell.outputs
        ]
        return "".join(texts)

    @property
    def pid(self) -> int:
        """Return the process id of the kernel."""
        pid: int = self.client.km.provisioner.process.pid  # type: ignore[union-attr]
        return pid


@contextmanager
def open_notebook(folder: Path) -> Iterator[Notebook]:
    """Yield a notebook in `folder` with the course's kernel.

    The kernel listens on sockets in a folder: until it has started, another process could take a port that was free.
    """
    with tempfile.TemporaryDirectory() as sockets:
        client = NotebookClient(
            nbformat.v4.new_notebook(),  # type: ignore[no-untyped-call]
            km=CourseKernel(transport="ipc", ip=f"{sockets}/kernel"),
            timeout=int(HANG_S),
            startup_timeout=int(HANG_S),
            allow_errors=True,
            resources={"metadata": {"path": str(folder)}},
        )
        with client.setup_kernel(cleanup_kc=True):
            yield Notebook(client)
