"""Disks that are full or read-only: real ones where this user may mount them, else the like."""

import os
import pwd
import subprocess
from contextlib import contextmanager


def nobody():
    """The user to become where permissions are to count: root, whom none stops, is somebody."""
    return 0 if os.geteuid() else pwd.getpwnam("nobody").pw_uid


def mounted(folder, options):
    """Whether a disk in memory could be mounted on the folder."""
    if os.geteuid():
        return False
    mount = ["mount", "-t", "tmpfs", "-o", f"{options},mode=755", "tmpfs", str(folder)]
    return subprocess.run(mount, capture_output=True, check=False).returncode == 0


@contextmanager
def small_disk(folder, kilobytes):
    """A disk of this size where this user may mount one; yields the largest file elsewhere."""
    folder.mkdir(parents=True, exist_ok=True)
    if not mounted(folder, f"size={kilobytes}k"):
        yield 1024 * kilobytes // 40
        return
    try:
        yield 0
    finally:
        subprocess.run(["umount", str(folder)], check=True)


@contextmanager
def read_only(folder):
    """The folder as on a disk that cannot be written; yields the user to become, 0 for none."""
    if mounted_again(folder):
        try:
            yield 0
        finally:
            subprocess.run(["umount", str(folder)], check=True)
        return
    paths = [folder, *folder.rglob("*")]
    modes = {path: path.stat().st_mode for path in paths}
    for path in paths:
        path.chmod(0o555 if path.is_dir() else 0o444)
    try:
        yield nobody()
    finally:
        for path, mode in modes.items():
            path.chmod(mode)


def mounted_again(folder):
    """Whether the folder could be laid over itself, without the right to write."""
    if os.geteuid():
        return False
    words = ["mount", "--bind", str(folder), str(folder)]
    if subprocess.run(words, capture_output=True, check=False).returncode:
        return False
    words = ["mount", "-o", "remount,ro,bind", str(folder)]
    subprocess.run(words, check=True)
    return True
