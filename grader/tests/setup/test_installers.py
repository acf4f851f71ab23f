"""Settings of pip, uv and Python that were made for other projects."""

from __future__ import annotations

from pathlib import Path

import pytest

from grader.setup import install, installers

LATER = {"_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}


@pytest.mark.parametrize(
    "name",
    [
        *("PIP_TARGET", "PIP_PREFIX", "PIP_ROOT", "PIP_USER", "PIP_REQUIRE_VIRTUALENV", "PIP_NO_BINARY", "PIP_PYTHON"),
        *("PIP_CONSTRAINT", "PIP_DRY_RUN", "PIP_ONLY_BINARY", "UV_SYSTEM_PYTHON", "UV_PYTHON", "UV_EXCLUDE_NEWER"),
        *("UV_PROJECT_ENVIRONMENT", "UV_NO_BUILD_ISOLATION", "UV_LINK_MODE", "UV_CONSTRAINT", "UV_RESOLUTION"),
        *("PYTHONPATH", "PYTHONHOME", "PYTHONOPTIMIZE", "PYTHONVERBOSE", "VIRTUAL_ENV", "CONDA_PREFIX"),
    ],
)
def test_installers_do_not_see_settings_for_other_projects(name: str) -> None:
    assert installers.environment({name: "1"}) == LATER


@pytest.mark.parametrize(
    "name",
    [
        *("HTTPS_PROXY", "SSL_CERT_FILE", "PATH", "HOME", "PIP_INDEX_URL", "PIP_CERT", "PIP_DEFAULT_TIMEOUT"),
        *("PIP_CACHE_DIR", "PIP_CONFIG_FILE", "UV_DEFAULT_INDEX", "UV_INDEX_OURS_PASSWORD", "UV_CACHE_DIR"),
        *("UV_HTTP_TIMEOUT", "UV_OFFLINE", "UV_NATIVE_TLS"),
    ],
)
def test_installers_see_where_packages_come_from(name: str) -> None:
    assert installers.environment({name: "1"}) == {name: "1", **LATER}


def test_only_mirrors_and_certificates_are_kept_of_the_configuration_of_pip(tmp_path: Path) -> None:
    for name, text in (
        (".pip", "[global]\ncert = /a b.pem\nindex-url = https://old/simple\ntarget = /tmp/t\n[wheel]\nproxy = p\n"),
        (".config/pip", "[install]\nindex-url = https://new/simple\nuser = true\nno-binary = :all:\n"),
        ("malformed/pip", "target = /tmp/t\n"),
    ):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "pip.conf").write_text(text)
    env = {"HOME": str(tmp_path), "XDG_CONFIG_DIRS": f"{tmp_path}/malformed"}
    kept = installers.of_configuration(env)
    assert kept.pop("PIP_CERT") == "/a b.pem"
    assert kept.pop("PIP_INDEX_URL") == "https://new/simple"
    assert not {"PIP_USER", "PIP_TARGET", "PIP_NO_BINARY", "PIP_PROXY"} & set(kept)


def test_the_configuration_files_are_those_that_pip_reads_in_its_order(tmp_path: Path) -> None:
    shared = [Path("/a/pip/pip.conf"), Path("/b/pip/pip.conf"), Path("/etc/pip.conf")]
    own = [Path("/home/me/.pip/pip.conf"), Path("/home/me/.config/pip/pip.conf")]
    chosen = tmp_path / "pip.conf"
    env = {"HOME": "/home/me", "XDG_CONFIG_DIRS": "/a:/b"}
    assert installers.configuration_files(env) == [*shared, *own]
    env["PIP_CONFIG_FILE"] = str(chosen)
    assert installers.configuration_files(env) == [*shared, *own, chosen]
    chosen.touch()
    assert installers.configuration_files(env) == [*shared, chosen]
    env["PIP_CONFIG_FILE"] = "/dev/null"
    assert installers.configuration_files(env) == []


def test_pip_reads_no_configuration_file_of_another_project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    configured = tmp_path / "pip.conf"
    configured.write_text(f"[install]\ntarget = {tmp_path}/target\n[global]\nfind-links = {tmp_path}\n")
    monkeypatch.setenv("PIP_CONFIG_FILE", str(configured))
    monkeypatch.delenv("PIP_FIND_LINKS", raising=False)
    seen = []

    def run(command: list[str], env: dict[str, str]) -> install.Ran:
        seen.append((env["PIP_CONFIG_FILE"], env["PIP_FIND_LINKS"], "PIP_TARGET" in env, command[-2]))
        return install.Ran(0, [], "")

    monkeypatch.setattr(install, "_run", run)
    monkeypatch.setattr(install, "_write", lambda *_: tmp_path / "requirements.txt")
    monkeypatch.setattr(install, "_uv", lambda *_: 0.0)
    monkeypatch.setattr(install, "start_fast", lambda _: None)
    install.install(["setup"], sourced=False)
    assert seen == [("/dev/null", str(tmp_path), False, "-r")]
