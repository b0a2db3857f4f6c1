"""Writes a drive in the layout dicp as bags: write_drive.py DRIVE OUT

DRIVE has point_clouds/*.bin (float32 x, y, z, Doppler), times/*.bin (float32 seconds) and ref_poses.txt, whose first
column are seconds. OUT gets drive.bag (ROS 1, by rosbag) and drive-db3 (ROS 2, by Python's sqlite3). The points of the
first are in another order and padded, those of the second big-endian.
"""
import os
import sqlite3
import struct
import sys

drive, out = sys.argv[1:3]
FLOAT32 = 7


def stamps():
    with open(os.path.join(drive, "ref_poses.txt")) as poses:
        for line in poses:
            seconds, fraction = line.split()[0].split(".")
            yield int(seconds), int(fraction)


def scans():
    for number, (seconds, nanoseconds) in enumerate(stamps(), 1):
        name = "%05d.bin" % number
        with open(os.path.join(drive, "point_clouds", name), "rb") as points, open(os.path.join(drive, "times", name), "rb") as times:
            rows = zip(struct.iter_unpack("<4f", points.read()), struct.iter_unpack("<f", times.read()))
            yield seconds, nanoseconds, [(*row, time) for row, (time,) in rows]


def ros1_cloud(seconds, nanoseconds, rows):
    text = lambda words: struct.pack("<I", len(words)) + words.encode()
    fields = [("doppler", 8), ("x", 12), ("z", 16), ("y", 20), ("time_offset_s", 28)]
    data = b"".join(struct.pack("<8x4f4xf4x", d, x, z, y, t) for x, y, z, d, t in rows)
    message = struct.pack("<III", 0, seconds, nanoseconds) + text("lidar") + struct.pack("<III", 1, len(rows), len(fields))
    for name, offset in fields:
        message += text(name) + struct.pack("<IBI", offset, FLOAT32, 1)
    return message + struct.pack("<BIII", 0, 36, 36 * len(rows), len(data)) + data + b"\1"


def cdr_cloud(seconds, nanoseconds, rows):
    message = b""

    def align(size):
        nonlocal message
        message += b"\0" * (-len(message) % size)

    def number(value):
        nonlocal message
        align(4)
        message += struct.pack("<I", value)

    def text(words):
        nonlocal message
        number(len(words) + 1)
        message += words.encode() + b"\0"

    number(seconds)
    number(nanoseconds)
    text("lidar")
    number(1)
    number(len(rows))
    fields = ["x", "y", "z", "doppler", "time_offset_s"]
    number(len(fields))
    for k, name in enumerate(fields):
        text(name)
        number(4 * k)
        message += struct.pack("<B", FLOAT32)
        number(1)
    message += b"\1"  # big-endian
    number(20)
    number(20 * len(rows))
    data = b"".join(struct.pack(">5f", *row) for row in rows)
    number(len(data))
    return b"\0\1\0\0" + message + data + b"\1"


def write_rosbag():
    import genpy
    import rosbag
    kind = type("PointCloud2", (), {"_type": "sensor_msgs/PointCloud2", "_md5sum": "1158d486dd51d683ce2f1be655c3c181",
                                    "_full_text": "Header header\n"})
    with rosbag.Bag(os.path.join(out, "drive.bag"), "w", compression="lz4") as bag:
        for seconds, nanoseconds, rows in scans():
            message = ros1_cloud(seconds, nanoseconds, rows)
            # Recorded in the middle of the next scan.
            bag.write("/lidar/points", (kind._type, message, kind._md5sum, kind), genpy.Time(seconds + 1, nanoseconds), raw=True)


def write_db3():
    folder = os.path.join(out, "drive-db3")
    os.mkdir(folder)
    database = sqlite3.connect(os.path.join(folder, "drive_0.db3"))
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
                     "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL,data BLOB NOT NULL)")
    database.execute("INSERT INTO topics VALUES (1, '/lidar/points', 'sensor_msgs/msg/PointCloud2', 'cdr', '')")
    for seconds, nanoseconds, rows in scans():
        database.execute("INSERT INTO messages (topic_id, timestamp, data) VALUES (1, ?, ?)",
                         ((seconds + 1) * 1000000000 + nanoseconds, cdr_cloud(seconds, nanoseconds, rows)))
    database.commit()
    database.close()
    with open(os.path.join(folder, "metadata.yaml"), "w") as metadata:
        metadata.write("rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
                       "  relative_file_paths:\n    - drive_0.db3\n")


write_rosbag()
write_db3()
