#!/usr/bin/env python3
"""Writes the CT of a skull from Debian's package invesalius-examples as one NRRD file.

Usage: prepare_skull.py OUTPUT.nrrd [INPUT.inv3]

An .inv3 is a gzipped tar: main.plist describes, matrix.dat holds int16 Hounsfield units, x fastest,
slices from the neck to the crown. Rows run from the back of the head to the face, against LPS, so
the second axis points to the front: direction (0, -1, 0). Columns run to the left, as LPS does. The
origin puts the middle of the box at zero.
"""

import os
import plistlib
import sys
import tarfile
import zlib

PACKAGED = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3"


class PrepareError(Exception):
    """One line: the cause, then the remedy."""


def read_project(path):
    """The description and the voxels' bytes."""
    if not os.path.exists(path):
        raise PrepareError(f"{path}: not found; install it with: "
                           "apt-get install invesalius-examples")
    try:
        with tarfile.open(path, "r:gz") as archive:
            members = {os.path.basename(member.name): member for member in archive}
            plist = plistlib.load(archive.extractfile(members["main.plist"]))
            voxels = archive.extractfile(members[plist["matrix"]["filename"]]).read()
    except (tarfile.TarError, OSError, EOFError, KeyError, zlib.error,
            plistlib.InvalidFileException) as error:
        raise PrepareError(f"{path}: not an InVesalius project ({error!r}); "
                           "reinstall invesalius-examples") from error
    return plist, voxels


def check_matrix(path, plist, voxels):
    """Sizes in x, y, z, after checking that the voxels are what the description says."""
    depth, height, width = plist["matrix"]["shape"]
    wanted = 2 * depth * height * width
    dtype = plist["matrix"]["dtype"]
    if dtype != "int16" or len(voxels) != wanted:
        raise PrepareError(f"{path}: {len(voxels)} bytes of {dtype} where {wanted} of int16 are "
                           "expected; reinstall invesalius-examples")
    return width, height, depth


def nrrd_header(sizes, spacing):
    signs = (1, -1, 1)  # of x, y, z in LPS
    axes = []
    for axis in range(3):
        vector = ["0", "0", "0"]
        vector[axis] = repr(signs[axis] * spacing[axis])
        axes.append(f"({','.join(vector)})")
    origin = [-sign * step * (size - 1) / 2 for sign, step, size in zip(signs, spacing, sizes)]
    lines = [
        "NRRD0005",
        "type: int16",
        "dimension: 3",
        "space: left-posterior-superior",
        "sizes: " + " ".join(map(str, sizes)),
        "space directions: " + " ".join(axes),
        "kinds: domain domain domain",
        "endian: little",
        "encoding: raw",
        "space origin: (" + ",".join(map(repr, origin)) + ")",
        "modality:=CT",
        "unit:=HU",
    ]
    return ("\n".join(lines) + "\n\n").encode("ascii")


def write_atomically(path, parts):
    temporary = path + ".part"
    try:
        with open(temporary, "wb") as file:
            file.writelines(parts)
        os.replace(temporary, path)
    except OSError as error:
        if os.path.exists(temporary):
            os.remove(temporary)
        raise PrepareError(f"{path}: {error.strerror}; name a file in a folder that can be "
                           "written to") from error


def main(arguments):
    if len(arguments) not in (1, 2) or arguments[0].startswith("-"):
        print("usage: prepare_skull.py OUTPUT.nrrd [INPUT.inv3]", file=sys.stderr)
        return 2
    source = arguments[1] if len(arguments) == 2 else PACKAGED
    try:
        plist, voxels = read_project(source)
        sizes = check_matrix(source, plist, voxels)
        write_atomically(arguments[0], [nrrd_header(sizes, plist["spacing"]), voxels])
    except PrepareError as error:
        print(f"prepare_skull.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
