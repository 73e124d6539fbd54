"""Whether a folder lies on a network drive, as far as the system says."""

from __future__ import annotations

from pathlib import Path

MOUNTS = Path("/proc/self/mounts")
NETWORK = frozenset(
    "9p afs beegfs ceph cifs davfs fuse.ceph fuse.davfs2 fuse.glusterfs fuse.rclone fuse.s3fs "
    "fuse.sshfs gfs2 glusterfs gpfs lustre ncpfs nfs nfs4 ocfs2 pvfs2 smb3 smbfs".split()
)


def network_drive(path: Path, mounts: Path = MOUNTS) -> str:
    """The kind of network file system that `path` is on, "" for none or where nobody says so."""
    try:
        lines = mounts.read_text("utf-8", "replace").splitlines()
    except OSError:
        return ""  # no Linux
    place, found = path.absolute(), ("", "")
    for line in lines:
        fields = line.split(" ")
        # Blanks, tabs and backslashes in a name are written as octal numbers.
        where = fields[1].encode("latin-1", "replace").decode("unicode_escape")
        if place.is_relative_to(where) and len(where) >= len(found[0]):
            found = where, fields[2]
    return found[1] if found[1] in NETWORK else ""
