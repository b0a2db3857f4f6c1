#!/usr/bin/env python3
"""Files made to harm who reads them: bombs, sizes that overflow, names that climb out, links. Each must be refused with
a message that names it, in little time and memory, and nothing may appear outside the folder for results.

usage: hostile.py PROGRAM       status 1 where one got through
"""
import io
import os
import resource
import struct
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

LONGEST_S = 60
MOST_MEMORY = 1 << 31


def npy(shape, data=b""):
    header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}"
    header = header.ljust((-(10 + len(header) + 1)) % 64 + len(header)) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + data


def npz(members):
    bytes_ = io.BytesIO()
    with zipfile.ZipFile(bytes_, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return bytes_.getvalue()


def columns(column):
    return npz({f"{name}.npy": column for name in ("x", "y", "z", "doppler")})


def bomb():
    """4 columns of 64 million zeros in 2 MB."""
    count = 64_000_000
    return columns(npy(f"({count},)", bytes(8 * count)))


def pcd(points):
    return f"VERSION 0.7\nFIELDS x y z doppler\nSIZE 4 4 4 4\nTYPE F F F F\nWIDTH {points}\nHEIGHT 1\nPOINTS {points}\nDATA binary\n".encode()


def pcd_packed(packed, unpacked):
    return pcd(8).replace(b"DATA binary", b"DATA binary_compressed") + struct.pack("<II", packed, unpacked) + b"\0" * 64


def ply(points):
    fields = "".join(f"property float {name}\n" for name in ("x", "y", "z", "doppler"))
    return f"ply\nformat binary_little_endian 1.0\nelement vertex {points}\n{fields}end_header\n".encode()


MCAP = b"\x89MCAP0\r\n"


def mcap(opcode, length, content):
    return MCAP + bytes([opcode]) + struct.pack("<Q", length) + content + MCAP


FILES = {
    "bomb.npz": bomb,
    "climbs.npz": lambda: npz({"../../climbed.npy": npy("(2,)", bytes(16)), "/tmp/climbed.npy": npy("(2,)", bytes(16))}),
    "wide.npz": lambda: columns(npy("(4611686018427387904,)")),
    "wraps.npz": lambda: columns(npy("(4294967296, 4294967296, 2)")),
    "many.pcd": lambda: pcd(2**62),
    "wraps.pcd": lambda: pcd(2**64 - 1),
    "packed.pcd": lambda: pcd_packed(64, 0xFFFFFFFF),
    "long.pcd": lambda: pcd_packed(0xFFFFFFFF, 128),
    "many.ply": lambda: ply(2**62),
    "wraps.ply": lambda: ply(2**64 - 1),
    "long.mcap": lambda: mcap(0x01, 2**63, b"\0" * 16),
    "wraps.mcap": lambda: mcap(0x01, 2**64 - 1, b"\0" * 16),
    # A chunk that says it unpacks to 2^62 bytes.
    "chunk.mcap": lambda: mcap(0x06, 60, struct.pack("<QQQII", 0, 1, 2**62, 0, 4) + b"zstd" + struct.pack("<Q", 16) + b"\0" * 16),
    "long.bag": lambda: b"#ROSBAG V2.0\n" + struct.pack("<I", 0xFFFFFFFF) + b"\0" * 64,
}


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))


def convert(program, scan, out):
    return subprocess.run([program, "convert", str(scan), "--to", "dicp", "--quiet", "--output", str(out)], capture_output=True, text=True,
                          errors="replace", timeout=LONGEST_S, preexec_fn=limit_memory)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: hostile.py PROGRAM")
    program = os.path.abspath(sys.argv[1])
    wrong = 0
    with tempfile.TemporaryDirectory(prefix="hostile-") as folder:
        out = Path(folder) / "results" / "out"
        for name, make in FILES.items():
            place = Path(folder) / "inputs" / Path(name).stem / Path(name).suffix[1:]
            place.mkdir(parents=True)
            file = place / name
            file.write_bytes(make())
            done = convert(program, file if name.endswith(("mcap", "bag")) else place, out)
            text = done.stdout + done.stderr
            fault = ""
            if done.returncode != 1:
                fault = f"status {done.returncode}"
            elif str(place) not in text:
                fault = "not named"
            elif out.parent.exists() and any(out.parent.iterdir()):
                fault = "left something"
            elif [entry.name for entry in Path(folder).iterdir() if entry.name not in ("inputs", "results")]:
                fault = "wrote outside"
            print(f"{name:<12} {fault or 'refused'}: {text.strip()[-160:]}")
            wrong += bool(fault)
    print(f"{len(FILES)} files, {wrong} got through")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
