"""Writes a drive in the layout dicp in other layouts of a file a scan, by numpy: write_drive_files.py DRIVE OUT

DRIVE as write_drive.py has it. The files of each folder of OUT are named by the times of their scans.
"""
import os
import struct
import sys

import numpy

drive, out = sys.argv[1:3]
NAMES = ["x", "y", "z", "doppler", "time_offset_s"]


def scans():
    """Name by time, and float32 rows of x, y, z, Doppler, time."""
    with open(os.path.join(drive, "ref_poses.txt")) as poses:
        for number, line in enumerate(poses, 1):
            name = "%05d.bin" % number
            points = numpy.fromfile(os.path.join(drive, "point_clouds", name), "<f4").reshape(-1, 4)
            times = numpy.fromfile(os.path.join(drive, "times", name), "<f4")
            yield line.split()[0], numpy.column_stack([points, times])


def structured(rows, kinds):
    table = numpy.empty(len(rows), [(name, kind) for name, kind in zip(NAMES, kinds)])
    for k, name in enumerate(NAMES):
        table[name] = rows[:, k]
    return table.tobytes()


def text(file, rows, delimiter):
    numpy.savetxt(file, rows.astype("f8"), "%.17g", delimiter)


def npz(path, rows):
    numpy.savez(path, points=rows[:, :3], doppler=rows[:, 3], time_offset_s=rows[:, 4])


def npz_packed(path, rows):
    numpy.savez_compressed(path, doppler=rows[:, 3].astype("f8"), xyz=numpy.asfortranarray(rows[:, :3]),
                           time_offset_s=rows[:, 4].astype(">f4"))


def npy(path, rows):
    numpy.save(path, rows)


def bin_of(kinds):
    return lambda path, rows: open(path, "wb").write(structured(rows, kinds))


def csv(path, rows):
    with open(path, "w") as file:
        file.write(",".join(NAMES) + "\n")
        text(file, rows, ",")


def txt(path, rows):
    with open(path, "w") as file:
        file.write("# " + " ".join(NAMES) + "\n")
        text(file, rows, " ")


def pcd(encoding):
    def write(path, rows):
        with open(path, "wb") as file:
            file.write(("VERSION 0.7\nFIELDS %s\nSIZE 4 4 4 4 8\nTYPE F F F F F\nCOUNT 1 1 1 1 1\nWIDTH %d\nHEIGHT 1\n"
                        "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA %s\n" % (" ".join(NAMES), len(rows), len(rows), encoding)).encode())
            if encoding == "ascii":
                text(file, rows, " ")
            elif encoding == "binary":
                file.write(structured(rows, ["<f4"] * 4 + ["<f8"]))
            else:  # by columns, LZF of literals alone
                columns = b"".join(rows[:, k].astype("<f4" if k < 4 else "<f8").tobytes() for k in range(5))
                runs = [columns[at:at + 32] for at in range(0, len(columns), 32)]
                packed = b"".join(bytes([len(run) - 1]) + run for run in runs)
                file.write(struct.pack("<II", len(packed), len(columns)) + packed)
    return write


def ply(encoding):
    def write(path, rows):
        with open(path, "wb") as file:
            file.write(("ply\nformat %s 1.0\ncomment a drive\nelement vertex %d\n" % (encoding, len(rows))).encode())
            for name in NAMES:
                file.write(("property %s %s\n" % ("float" if name == "doppler" else "double", name)).encode())
            file.write(b"end_header\n")
            if encoding == "ascii":
                text(file, rows, " ")
            else:
                order = "<" if encoding == "binary_little_endian" else ">"
                file.write(structured(rows, [order + ("f4" if name == "doppler" else "f8") for name in NAMES]))
    return write


FORMS = {
    "npz": ("npz", npz),
    "npz-packed": ("npz", npz_packed),
    "npy": ("npy", npy),
    "bin-float32": ("bin", bin_of(["<f4"] * 5)),
    "bin-float64": ("bin", bin_of(["<f8"] * 5)),
    "csv": ("csv", csv),
    "txt": ("txt", txt),
    "pcd-ascii": ("pcd", pcd("ascii")),
    "pcd-binary": ("pcd", pcd("binary")),
    "pcd-compressed": ("pcd", pcd("binary_compressed")),
    "ply-ascii": ("ply", ply("ascii")),
    "ply-little": ("ply", ply("binary_little_endian")),
    "ply-big": ("ply", ply("binary_big_endian")),
}
for folder in FORMS:
    os.mkdir(os.path.join(out, folder))
for stamp, rows in scans():
    for folder, (ending, write) in FORMS.items():
        write(os.path.join(out, folder, "%s.%s" % (stamp, ending)), rows)
