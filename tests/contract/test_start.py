"""start.py in a small project of its own: no downloads, so that its faults can be provoked."""

from __future__ import annotations

import ast
import importlib.util
import platform
import subprocess
import sys
import time
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[2]

# A build backend inside the project: pip needs nothing from a registry. Its `seethrough` prints
# what it was given. A file named `broken` makes the build fail, one named `slow` makes it last.
BACKEND = """
import os, time, zipfile

def build_editable(folder, config_settings=None, metadata_directory=None):
    if os.path.exists("slow"):
        open("building", "w").close()
        while os.path.exists("slow"):
            time.sleep(0.1)
    if os.path.exists("broken"):
        raise SystemExit("ERROR: the build is broken on purpose")
    name = "seethrough-0.1.0-py3-none-any.whl"
    info = "seethrough-0.1.0.dist-info/"
    with zipfile.ZipFile(os.path.join(folder, name), "w") as wheel:
        wheel.writestr("small.py", "import sys\\ndef main(): print('ran', *sys.argv[1:])\\n")
        wheel.writestr(info + "METADATA", "Metadata-Version: 2.1\\nName: seethrough\\n"
            "Version: 0.1.0\\nProvides-Extra: test\\nProvides-Extra: bench\\n")
        wheel.writestr(info + "WHEEL",
            "Wheel-Version: 1.0\\nGenerator: x\\nRoot-Is-Purelib: true\\nTag: py3-none-any\\n")
        wheel.writestr(info + "entry_points.txt", "[console_scripts]\\nseethrough = small:main\\n")
        wheel.writestr(info + "RECORD", "")
    return name
"""
PROJECT = """
[build-system]
requires = []
build-backend = "backend"
backend-path = ["."]
"""
# Stands in for pytest: leaves a process behind, in a session of its own as a window's server is.
PYTEST = """
import subprocess, sys
quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
left = subprocess.Popen(["sleep", "60"], start_new_session=True, **quiet)
open("left.pid", "w").write(str(left.pid))
print("1 passed in 0.01s")
sys.exit(len(sys.argv) > 5)
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small project in a folder with a space in its name, set up by a first call."""
    folder = tmp_path_factory.mktemp("a small project")
    (folder / "tests").mkdir()
    (folder / "start.py").write_text((ROOT / "start.py").read_text("utf-8"), "utf-8")
    (folder / "pyproject.toml").write_text(PROJECT, "utf-8")
    (folder / "backend.py").write_text(BACKEND, "utf-8")
    (folder / "pytest.py").write_text(PYTEST, "utf-8")
    (folder / "constraints.txt").write_text("nothing==1.0\n", "utf-8")
    (folder / "tests" / "system-packages.txt").write_text("sh dash dash dash # a\n\n", "utf-8")
    first = start(folder, "demo", "--quick")
    assert first.returncode == 0, first.stdout + first.stderr
    assert first.stdout.splitlines()[-1] == "ran demo --quick"
    assert "start.py: installing the packages" in first.stdout
    return folder


def start(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """`python3 start.py WORDS`, called from another folder, once it has ended."""
    return subprocess.run(
        [sys.executable, str(folder / "start.py"), *words],
        cwd=folder.parent,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture
def module(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> ModuleType:
    """start.py as a module whose .venv lies in an empty folder."""
    spec = importlib.util.spec_from_file_location("start", ROOT / "start.py")
    assert spec
    assert spec.loader
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    for name in ("VENV", "STAMP", "UNFINISHED", "LOG", "PYTHON"):
        place = Path(getattr(loaded, name)).relative_to(ROOT)
        monkeypatch.setattr(loaded, name, str(tmp_path / place))
    return loaded


@pytest.mark.parametrize("manager", ["apt-get", "dnf", "pacman"])
def test_without_leave_to_install_it_says_what_to_type(
    module: ModuleType, monkeypatch: pytest.MonkeyPatch, manager: str
) -> None:
    """One line with the whole command; an environment that was whole stays so."""
    monkeypatch.setattr(module, "opengl_missing", lambda: "libEGL.so.1")
    monkeypatch.setattr(module, "is_usable", lambda: True)
    monkeypatch.setattr(module, "as_root", lambda: None)
    monkeypatch.setattr(module.shutil, "which", lambda name: name == manager)
    packages = module.OPENGL[manager]
    assert "mesa" in packages
    with pytest.raises(module.Stop, match=r"^missing: OpenGL; an administrator") as stop:
        module.set_up("")
    assert f"types: sudo {manager} " in str(stop.value)
    assert str(stop.value).endswith(f" {packages}")
    assert not Path(module.UNFINISHED).exists()


def test_a_vendors_driver_may_do_without_mesa(
    module: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Where only the driver seems missing and nothing may be installed, it goes on and says so."""
    monkeypatch.setattr(module, "opengl_missing", lambda: "a driver for EGL")
    monkeypatch.setattr(module, "as_root", lambda: None)
    module.need_system(usable=True)
    assert capsys.readouterr().out.startswith("start.py: a driver for EGL is missing: drawing may")


def test_without_a_package_manager_it_says_what_is_missing(
    module: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No command to type, but what to look for."""
    monkeypatch.setattr(module.shutil, "which", lambda name: None)
    with pytest.raises(module.Stop, match=r"^missing: OpenGL; install it with this system's"):
        module.install_system("OpenGL", module.OPENGL)


@pytest.mark.parametrize(
    ("system", "machine", "release", "libc", "said"),
    [
        ("darwin", "x86_64", "15.1", "", "Intel Macs .* are not supported"),
        ("darwin", "arm64", "13.6", "", "this is macOS 13.6, expected 14 or newer"),
        ("linux", "x86_64", "", "", "this Linux has no glibc, expected one that has"),
    ],
)
def test_machines_that_cannot_be_served_are_told_so(
    module: ModuleType,
    monkeypatch: pytest.MonkeyPatch,
    system: str,
    machine: str,
    release: str,
    libc: str,
    said: str,
) -> None:
    """A machine for which a package is not made gets one line instead of pip's pages."""
    monkeypatch.setattr(module.sys, "platform", system)
    monkeypatch.setattr(platform, "machine", lambda: machine)
    monkeypatch.setattr(platform, "mac_ver", lambda: (release, ("", "", ""), machine))
    monkeypatch.setattr(platform, "libc_ver", lambda: (libc, ""))
    with pytest.raises(module.Stop, match=said):
        module.check_platform()


def test_missing_network_is_named(module: ModuleType) -> None:
    """pip's pages about retries become one line; another error keeps its own words."""
    pages = "WARNING: Retrying ... [Errno -3] Temporary failure in name resolution\nERROR: No match"
    assert module.why(pages) == "there is no network: connect this machine, then run this again"
    assert module.why("Collecting x\nERROR: No space left\nhint").startswith("ERROR: No space left")


def test_it_needs_the_standard_library_only() -> None:
    """A machine with nothing but Python can run it, and an old Python can read it."""
    tree = ast.parse((ROOT / "start.py").read_text("utf-8"), feature_version=(3, 6))
    names = {a.name for node in ast.walk(tree) if isinstance(node, ast.Import) for a in node.names}
    assert names
    assert not {name.partition(".")[0] for name in names} - set(sys.stdlib_module_names)
    assert not [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]


def test_an_older_python_is_told_so() -> None:
    """One line, no traceback, nothing made."""
    pretend = (
        "import sys; sys.version_info = (3, 9, 6); sys.version = '3.9.6 (old)'; "
        f"exec(compile(open({str(ROOT / 'start.py')!r}).read(), 'start.py', 'exec'))"
    )
    run = subprocess.run([sys.executable, "-c", pretend], capture_output=True, text=True)
    assert run.returncode == 1
    (line,) = run.stderr.splitlines()
    assert line.startswith("start.py: this is Python 3.9.6, expected 3.11 or newer: ")


def test_no_words_print_the_usage(installed: Path) -> None:
    """Exit status 2, and what may be typed."""
    run = start(installed)
    assert run.returncode == 2
    assert run.stdout.startswith("usage: python3 start.py demo | test | COMMAND")


def test_a_second_call_goes_straight_to_the_program(installed: Path) -> None:
    """It prints the program's output only, and touches nothing in .venv."""
    log = installed / ".venv" / "install.log"
    before = log.stat().st_mtime_ns
    run = start(installed, "report", "a b", "--out", "x")
    assert run.stdout == "ran report a b --out x\n"
    assert run.stderr == ""
    assert log.stat().st_mtime_ns == before


@pytest.mark.parametrize("changed", ["constraints.txt", "pyproject.toml"])
def test_changed_requirements_are_installed(installed: Path, changed: str) -> None:
    """A change of what is needed is installed into the same environment, once."""
    with (installed / changed).open("a", encoding="utf-8") as file:
        file.write("# changed\n" if changed.endswith("toml") else "another==2.0\n")
    first, second = start(installed, "check"), start(installed, "check")
    assert "installing the packages" in first.stdout
    assert "making the environment" not in first.stdout
    assert second.stdout == "ran check\n"


def test_a_failed_installation_says_why_and_is_made_good(installed: Path) -> None:
    """One line on standard error and status 1; what was whole before works on."""
    (installed / "broken").touch()
    try:
        failed = start(installed, "test")
        assert failed.returncode == 1
        (line,) = failed.stderr.splitlines()
        assert line.startswith("start.py: cannot install the packages: ")
        assert "install.log" in line
        assert start(installed, "demo").stdout == "ran demo\n"
    finally:
        (installed / "broken").unlink()


def test_the_tests_close_with_pytests_line_and_leave_no_process(installed: Path) -> None:
    """The last line is pytest's, its status is start.py's, and what tests left behind is ended."""
    passed, failed = start(installed, "test"), start(installed, "test", "tests/unit")
    assert (passed.returncode, failed.returncode) == (0, 1)
    assert passed.stdout.splitlines()[-1] == "1 passed in 0.01s"
    left = int((installed / "left.pid").read_text("ascii"))
    assert not Path(f"/proc/{left}").exists()


def test_an_interrupted_installation_is_repaired(installed: Path) -> None:
    """Killed in the middle, it is not taken for whole: the next call begins anew.

    The next call first waits for the installer, which outlived the one that was killed.
    """
    (installed / "slow").touch()
    (installed / "constraints.txt").write_text("third==3.0\n", "utf-8")
    command = [sys.executable, str(installed / "start.py"), "demo"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as first:
        while not (installed / "building").exists():
            assert first.poll() is None
            time.sleep(0.05)
        first.kill()
    said = installed / "said.txt"
    with said.open("w") as output, subprocess.Popen(command, stdout=output) as second:
        try:
            while not said.read_text("utf-8"):
                assert second.poll() is None
                time.sleep(0.05)
            time.sleep(1)  # long enough to say more, were it not waiting
            waiting = "start.py: another call is setting up: waiting for it\n"
            assert said.read_text("utf-8") == waiting
        finally:
            (installed / "slow").unlink()
    lines = said.read_text("utf-8").splitlines()
    assert "unfinished or another Python's: making it again" in lines[1]
    assert lines[-1] == "ran demo"
    assert start(installed, "demo").stdout == "ran demo\n"


def test_every_test_program_has_a_package_for_each_manager() -> None:
    """tests/system-packages.txt: program, then its package for apt-get, dnf and pacman."""
    lines = (ROOT / "tests" / "system-packages.txt").read_text("utf-8").splitlines()
    rows = [line.partition("#")[0].split() for line in lines]
    assert [len(row) for row in rows if row] == [4] * sum(map(bool, rows))
