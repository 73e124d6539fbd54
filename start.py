"""Sets Seethrough up, once, and starts it.

    python3 start.py demo            a short session, its data and its report
    python3 start.py test [...]      every test; more words go to pytest
    python3 start.py COMMAND [...]   any command of seethrough

Needs Python 3.11 and nothing else: makes .venv beside this file, installs the project and what it
needs in the versions of constraints.txt, and on a Linux without OpenGL installs Mesa where it
may. A later call finds the stamp of a finished installation and goes straight to the program.

Standard library only, in a syntax that Python 3.6 can read up to the version check.
"""

import contextlib
import hashlib
import importlib
import importlib.util
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import time

if sys.version_info < (3, 11):  # noqa: UP036  an older Python is what this line is for
    newer = next(filter(shutil.which, [f"python3.{n}" for n in (14, 13, 12, 11)]), None)
    advice = f"run `{newer} start.py`" if newer else "install it, then run this again"
    sys.exit(f"start.py: this is Python {sys.version.split()[0]}, expected 3.11 or newer: {advice}")

ROOT = os.path.dirname(os.path.abspath(__file__))
WINDOWS = sys.platform == "win32"
VENV = os.path.join(ROOT, ".venv")
SCRIPTS = os.path.join(VENV, "Scripts" if WINDOWS else "bin")
PYTHON = os.path.join(SCRIPTS, "python.exe" if WINDOWS else "python")
STAMP = os.path.join(VENV, "installed.txt")
UNFINISHED = os.path.join(VENV, "unfinished.txt")
LOG = os.path.join(VENV, "install.log")
CONSTRAINTS = os.path.join(ROOT, "constraints.txt")

# What each package manager runs first, and how it installs.
MANAGERS = {
    "apt-get": (["update"], ["install", "-y", "--no-install-recommends"]),
    "dnf": ([], ["install", "-y"]),
    "pacman": (["-Sy"], ["-S", "--noconfirm", "--needed"]),
}
OPENGL = {
    "apt-get": "libegl1 libgl1 libgl1-mesa-dri libx11-6 libxext6 libxrender1 libxrandr2 libxi6 "
    "libxinerama1 libxxf86vm1",
    "dnf": "mesa-dri-drivers mesa-libEGL mesa-libGL libX11 libXext libXrender libXrandr libXi "
    "libXinerama libXxf86vm",
    "pacman": "mesa libglvnd libx11 libxext libxrender libxrandr libxi libxinerama libxxf86vm",
}
VENV_MODULE = {"apt-get": "python{}.{}-venv".format(*sys.version_info)}  # others ship it

# Prints what is missing. A process of its own runs it: a driver once loaded stays loaded.
OPENGL_PROBE = """
import ctypes, os
for name in ("EGL.so.1", "GL.so.1", "X11.so.6", "Xext.so.6", "Xrender.so.1", "Xrandr.so.2"):
    try: ctypes.CDLL("lib" + name)
    except OSError: raise SystemExit("lib" + name)
egl = ctypes.CDLL("libEGL.so.1")
egl.eglGetDisplay.restype = ctypes.c_void_p
egl.eglGetDisplay.argtypes = [ctypes.c_void_p]
egl.eglInitialize.argtypes = [ctypes.c_void_p] * 3
if not egl.eglInitialize(egl.eglGetDisplay(None), None, None):
    os.environ["EGL_PLATFORM"] = "surfaceless"
    if not egl.eglInitialize(egl.eglGetDisplay(None), None, None):
        raise SystemExit("a driver for EGL")
"""
NO_NETWORK = (
    "Failed to establish a new connection|Temporary failure|Could not resolve|getaddrinfo failed|"
    "Network is unreachable|ConnectTimeoutError|ProxyError"
)


class Stop(Exception):
    """What stands in the way, in one line."""


def say(text: str) -> None:
    """One line of progress, which covers what was left of a rewritten one."""
    print(f"start.py: {text}".ljust(78 if sys.stdout.isatty() else 0), flush=True)


def environment_id() -> str:
    """What a virtual environment does not survive a change of."""
    machine = os.environ.get("PROCESSOR_ARCHITECTURE", "") if WINDOWS else os.uname().machine
    return " ".join((sys.implementation.cache_tag, sys.platform, machine, ROOT))


def packages_id() -> str:
    """Changes with what is to be installed."""
    with open(os.path.join(ROOT, "pyproject.toml"), "rb") as one, open(CONSTRAINTS, "rb") as two:
        return hashlib.sha256(one.read() + two.read()).hexdigest()


def read_stamp() -> list[str]:
    """Environment, packages and extras of the finished installation; [] if there is none."""
    try:
        with open(STAMP, encoding="utf-8") as file:
            lines = file.read().splitlines()
    except FileNotFoundError:
        return []
    return lines if len(lines) == 3 else []


def is_installed(extras: str) -> bool:
    """Whether .venv is whole, up to date and has the extras."""
    stamp = read_stamp()
    return (
        stamp[:2] == [environment_id(), packages_id()]
        and extras in ("", stamp[2])
        and os.path.exists(PYTHON)
        and not os.path.exists(UNFINISHED)
    )


def run_logged(command, what, detail=str, keep_open=()) -> tuple[int, str]:
    """Exit status and output of `command`, which is kept in .venv/install.log as well.

    `detail` makes the last line of the output into what the user sees meanwhile: one line that is
    rewritten on a terminal, elsewhere a line every ten seconds. The command keeps the file
    descriptors `keep_open`.
    """
    say(what)
    start = shown = time.monotonic()
    terminal = sys.stdout.isatty()
    with open(LOG, "a+", encoding="utf-8", errors="replace") as log:
        print(f"\n$ {' '.join(command)}", file=log, flush=True)
        begin = log.tell()
        with subprocess.Popen(
            command,
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=subprocess.STDOUT,
            env=dict(os.environ, DEBIAN_FRONTEND="noninteractive", PYTHONUNBUFFERED="1"),
            pass_fds=keep_open,
        ) as process:
            while process.poll() is None:
                time.sleep(0.2)
                now = time.monotonic()
                if now - shown < (1 if terminal else 10):
                    continue
                shown = now
                log.seek(begin)
                last = (log.read().splitlines() or [""])[-1]
                text = f"  {now - start:.0f} s: {detail(last.strip())[:66]}"
                print(text.ljust(78) + "\r" if terminal else text + "\n", end="", flush=True)
        log.seek(begin)
        return process.returncode, log.read()


def why(output: str) -> str:
    """The reason for a failure, from what the failed command printed."""
    if any(sign in output for sign in NO_NETWORK.split("|")):
        return "there is no network: connect this machine, then run this again"
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    errors = [line for line in lines if line.startswith(("ERROR:", "E:", "Error:"))]
    return f"{(errors or lines or ['it said nothing'])[-1]} (all of it: {os.path.relpath(LOG)})"


def ask(*command: str) -> subprocess.CompletedProcess:
    """What a quick command answers."""
    return subprocess.run(command, capture_output=True, text=True, check=False)


def as_root() -> list[str] | None:
    """What to put before a command so that it runs as root, or None where that may not be."""
    if os.geteuid() == 0:
        return []
    may = shutil.which("sudo") and ask("sudo", "-n", "true").returncode == 0
    return ["sudo", "-n"] if may else None


def install_system(what: str, packages: dict[str, str]) -> None:
    """Install `packages[manager]`; Stop, saying what to type, where this user may not."""
    manager = next(filter(shutil.which, packages), "")
    if not manager:
        raise Stop(f"missing: {what}; install it with this system's package manager")
    update, install = MANAGERS[manager]
    install, prefix = install + packages[manager].split(), as_root()
    if prefix is None:
        raise Stop(f"missing: {what}; an administrator types: sudo {manager} {' '.join(install)}")
    output = ""
    for words in filter(None, (update, install)):
        said = f"{what}: {manager} {' '.join(words)}"
        status, printed = run_logged([*prefix, manager, *words], said)
        output += printed
    if status:
        raise Stop(f"missing: {what}, and {manager} failed: {why(output)}")


def opengl_missing() -> str:
    """The first library of OpenGL and X11 that does not load, "" if all do and a driver starts."""
    return ask(sys.executable, "-c", OPENGL_PROBE).stderr.strip()


def need_system(usable: bool) -> None:
    """What only the system has (Linux): OpenGL, a window's library, what makes an environment."""
    missing = opengl_missing() if sys.platform == "linux" else ""
    needs = {"OpenGL": OPENGL} if missing else {}
    if not usable and not importlib.util.find_spec("ensurepip"):
        needs["Python's venv module"] = VENV_MODULE
    if not needs:
        return
    wanted = {name: " ".join(of.get(name, "") for of in needs.values()) for name in MANAGERS}
    try:
        install_system(" and ".join(needs), wanted)
    except Stop:
        if [*needs] != ["OpenGL"] or missing.startswith("lib"):
            raise  # else only Mesa's driver: a vendor's own may do
    if missing and opengl_missing():
        say(f"{opengl_missing()} is missing: drawing may fail")


def need_test_programs() -> None:
    """The programs of tests/system-packages.txt; says which are missing where it may not."""
    if sys.platform != "linux":
        return
    wanted = dict.fromkeys(MANAGERS, "")
    with open(os.path.join(ROOT, "tests", "system-packages.txt"), encoding="utf-8") as file:
        for line in file:
            words = line.partition("#")[0].split()
            if words and not any(map(shutil.which, words[0].split("|"))):
                for name, package in zip(MANAGERS, words[1:], strict=True):
                    wanted[name] += f" {package}"
    if wanted["apt-get"]:
        try:
            install_system("what the tests open windows and pages with", wanted)
        except Stop as stop:
            say(f"{stop} (tests that need it will fail)")


def check_platform() -> None:
    """Stop on a machine for which a package we need is not made."""
    platform = importlib.import_module("platform")  # here, as a later call can do without
    if sys.maxsize < 2**32:
        raise Stop("this Python is a 32-bit one, expected a 64-bit Python")
    if sys.platform == "darwin" and platform.machine() != "arm64":
        raise Stop("Intel Macs (and Pythons made for them) are not supported: use Apple silicon")
    if sys.platform == "darwin" and int(platform.mac_ver()[0].split(".")[0]) < 14:
        raise Stop(f"this is macOS {platform.mac_ver()[0]}, expected 14 or newer")
    if sys.platform == "linux" and platform.libc_ver()[0] != "glibc":
        raise Stop("this Linux has no glibc, expected one that has: numba needs it")


def is_usable() -> bool:
    """Whether the .venv found here can be installed into: nothing of it is half done."""
    elsewhere = read_stamp()[:1] not in ([], [environment_id()])
    if os.path.exists(UNFINISHED) or elsewhere or not os.path.exists(PYTHON):
        return False
    answer = ask(PYTHON, "-c", "import pip, sys; print(sys.implementation.cache_tag)")
    return answer.stdout.strip() == sys.implementation.cache_tag


def begin(usable: bool) -> None:
    """Mark .venv as unfinished; one that is not usable is emptied and made anew, with pip."""
    if not usable:
        if os.path.lexists(PYTHON):
            say("the environment in .venv is unfinished or another Python's: making it again")
        shutil.rmtree(VENV)
        os.mkdir(VENV)
    with open(UNFINISHED, "w", encoding="utf-8") as file:
        file.write("start.py removes this file when the installation is complete\n")
    if not usable:
        python = getattr(sys, "_base_executable", None) or sys.executable
        status, output = run_logged([python, "-m", "venv", VENV], "making the environment .venv")
        if status:
            raise Stop(f"cannot make .venv: {why(output)}")


def install_packages(extras: str, keep_open: tuple[int, ...]) -> None:
    """The project, editable, and what it needs, in the versions of constraints.txt."""
    with open(CONSTRAINTS, encoding="utf-8") as file:
        total = sum("==" in line for line in file)
    folder = sysconfig.get_path("purelib", "venv", {"base": VENV})

    def detail(line: str) -> str:
        if not line.startswith("Installing collected"):
            return line
        unpacked = sum(name.endswith(".dist-info") for name in os.listdir(folder))
        return f"{unpacked} of at most {total} packages unpacked"

    options = "install --disable-pip-version-check --progress-bar off --no-compile -c".split()
    command = [PYTHON, "-m", "pip", *options, CONSTRAINTS, "-e", f".[{extras}]" if extras else "."]
    what = "installing the packages: 900 MB, a minute or so"
    status, output = run_logged(command, what, detail, keep_open)
    if status:
        os.remove(UNFINISHED)  # pip undoes what it could not finish
        raise Stop(f"cannot install the packages: {why(output)}")
    # pip would do this on one core; a file that is not for this Python may fail to compile.
    run_logged([PYTHON, "-m", "compileall", "-q", "-j", "0", folder], "compiling them")
    # Else the first session would wait for it. Without OpenGL it fails, and what draws will say so.
    run_logged([PYTHON, "-m", "seethrough.experiment.session.warm"], "compiling what draws: 30 s")


@contextlib.contextmanager
def only_one():
    """Let one call at a time set up; yields what holds the lock (nothing on Windows).

    The installer inherits it, so that a call waits for the installer of one that was killed.
    """
    if WINDOWS:
        yield ()
        return
    fcntl = importlib.import_module("fcntl")
    lock = os.open(ROOT, os.O_RDONLY)
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            say("another call is setting up: waiting for it")
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield (lock,)
    finally:
        os.close(lock)


def set_up(extras: str) -> None:
    """Install all that is missing; an interrupted call is made good by the next one."""
    with only_one() as lock:
        if is_installed(extras):
            return
        check_platform()
        stamp = read_stamp()
        extras = extras or (stamp[2] if stamp else "")
        usable = is_usable()
        os.makedirs(VENV, exist_ok=True)
        need_system(usable)
        begin(usable)
        install_packages(extras, lock)
        with open(STAMP, "w", encoding="utf-8") as file:
            file.write("\n".join((environment_id(), packages_id(), extras)) + "\n")
        os.remove(UNFINISHED)


def wait_for(process: subprocess.Popen) -> int:
    """Its exit status. An interrupt reaches it too, and it ends in its own way."""
    while True:
        with contextlib.suppress(KeyboardInterrupt):
            return process.wait()


def run_program(words: list[str]) -> int:
    """Become `seethrough WORDS`; on Windows, which cannot, wait for it."""
    if WINDOWS:
        return wait_for(subprocess.Popen([os.path.join(SCRIPTS, "seethrough.exe"), *words]))
    os.execv(PYTHON, [PYTHON, os.path.join(SCRIPTS, "seethrough"), *words])


def children() -> list[int]:
    """Process ids of our children (Linux)."""
    with open(f"/proc/self/task/{os.getpid()}/children", encoding="ascii") as file:
        return [int(pid) for pid in file.read().split()]


def run_tests(words: list[str]) -> int:
    """pytest on two cores; its closing line is the last one printed, and no process is left."""
    command = [PYTHON, "-m", "pytest", "-n", "2", "--dist", "loadscope", *words]
    linux = sys.platform == "linux"
    if linux:
        set_child_subreaper = 36  # what our descendants leave behind becomes our child
        importlib.import_module("ctypes").CDLL(None).prctl(set_child_subreaper, 1, 0, 0, 0)
    pytest = subprocess.Popen(command, cwd=ROOT)
    signal.signal(signal.SIGTERM, lambda *_: pytest.terminate())
    status = wait_for(pytest)
    while linux and children():
        pid = children()[0]
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)
    return status


def main(words: list[str]) -> int:
    """Exit status: the program's, 1 if setting up failed, 130 if interrupted."""
    if not words:
        print("usage: python3 start.py demo | test | COMMAND ... (--help lists the commands)")
        return 2
    testing = words[0] == "test"
    extras = "test,bench" if testing else ""
    try:
        if not is_installed(extras):
            set_up(extras)
        if testing:
            need_test_programs()
            return run_tests(words[1:])
        return run_program(words)
    except (Stop, OSError) as problem:
        print(f"start.py: {problem}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("start.py: interrupted; the next call makes it good", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
