"""Writes a drive in the layout dicp as bags: write_drive.py DRIVE OUT [SENSOR=x,y,z,qx,qy,qz,qw ...]

DRIVE has point_clouds/*.bin (float32 x, y, z, Doppler), times/*.bin (float32 seconds) and ref_poses.txt, whose first
column are seconds. With sensors each has these in DRIVE/SENSOR, and is mounted on base_link as stated: a rig.

OUT gets drive-none.bag, drive-bz2.bag and drive-lz4.bag (ROS 1, by rosbag), and drive-db3 (ROS 2, by Python's sqlite3).
The points of the first are in another order and padded, those of the last big-endian.
"""
import os
import sqlite3
import struct
import sys

drive, out = sys.argv[1:3]
rig = [(word.split("=")[0], [float(number) for number in word.split("=")[1].split(",")]) for word in sys.argv[3:]]
FLOAT32 = 7
CLOUD, TRANSFORMS = "PointCloud2", "TFMessage"


def stamps(folder):
    with open(os.path.join(folder, "ref_poses.txt")) as poses:
        for line in poses:
            seconds, fraction = line.split()[0].split(".")
            yield int(seconds), int(fraction)


def scans(folder):
    for number, (seconds, nanoseconds) in enumerate(stamps(folder), 1):
        name = "%05d.bin" % number
        with open(os.path.join(folder, "point_clouds", name), "rb") as points, open(os.path.join(folder, "times", name), "rb") as times:
            rows = zip(struct.iter_unpack("<4f", points.read()), struct.iter_unpack("<f", times.read()))
            yield seconds, nanoseconds, [(*row, time) for row, (time,) in rows]


class Ros1:
    """A message as ROS 1 serialises it."""

    def __init__(self):
        self.bytes = b""

    def put(self, kinds, *values):
        self.bytes += struct.pack("<" + kinds, *values)

    def text(self, words):
        self.put("I", len(words))
        self.bytes += words.encode()

    def header(self, seconds, nanoseconds, frame):
        self.put("III", 0, seconds, nanoseconds)
        self.text(frame)


class Cdr:
    """The same in CDR, little-endian."""

    def __init__(self):
        self.body = b""

    def put(self, kinds, *values):
        for kind, value in zip(kinds, values):
            self.body += b"\0" * (-len(self.body) % struct.calcsize("<" + kind))
            self.body += struct.pack("<" + kind, value)

    def text(self, words):
        self.put("I", len(words) + 1)
        self.body += words.encode() + b"\0"

    def header(self, seconds, nanoseconds, frame):
        self.put("II", seconds, nanoseconds)
        self.text(frame)

    @property
    def bytes(self):
        return b"\0\1\0\0" + self.body


def ros1_cloud(seconds, nanoseconds, frame, rows):
    fields = [("doppler", 8), ("x", 12), ("z", 16), ("y", 20), ("time_offset_s", 28)]
    data = b"".join(struct.pack("<8x4f4xf4x", d, x, z, y, t) for x, y, z, d, t in rows)
    message = Ros1()
    message.header(seconds, nanoseconds, frame)
    message.put("III", 1, len(rows), len(fields))
    for name, offset in fields:
        message.text(name)
        message.put("IBI", offset, FLOAT32, 1)
    message.put("BIII", 0, 36, 36 * len(rows), len(data))
    message.bytes += data + b"\1"
    return message.bytes


def cdr_cloud(seconds, nanoseconds, frame, rows):
    fields = ["x", "y", "z", "doppler", "time_offset_s"]
    message = Cdr()
    message.header(seconds, nanoseconds, frame)
    message.put("III", 1, len(rows), len(fields))
    for k, name in enumerate(fields):
        message.text(name)
        message.put("IBI", 4 * k, FLOAT32, 1)
    data = b"".join(struct.pack(">5f", *row) for row in rows)
    message.put("BIII", 1, 20, 20 * len(rows), len(data))  # big-endian
    message.body += data + b"\1"
    return message.bytes


def transforms(message):
    """What /tf_static has: where each sensor sits on the vehicle."""
    message.put("I", len(rig))
    for name, pose in rig:
        message.header(1700000000, 0, "base_link")
        message.text(name)
        message.put("ddddddd", *pose)
    return message.bytes


def recorded(cloud, message):
    """All messages in the order in which they are recorded: topic, kind, seconds, nanoseconds, bytes."""
    everything = [("/tf_static", TRANSFORMS, 1700000000, 0, transforms(message()))] if rig else []
    for name in [name for name, _ in rig] or ["lidar"]:
        for seconds, nanoseconds, rows in scans(os.path.join(drive, name) if rig else drive):
            # Recorded in the middle of the next scan.
            everything.append(("/%s/points" % name, CLOUD, seconds + 1, nanoseconds, cloud(seconds, nanoseconds, name, rows)))
    return sorted(everything, key=lambda one: one[2:4])


def write_rosbags():
    import genpy
    import rosbag
    kind_of = {CLOUD: ("sensor_msgs/PointCloud2", "1158d486dd51d683ce2f1be655c3c181"),
               TRANSFORMS: ("tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec")}
    messages = [(topic, type(kind, (), {"_type": kind_of[kind][0], "_md5sum": kind_of[kind][1], "_full_text": "not looked at\n"}),
                 genpy.Time(seconds, nanoseconds), data)
                for topic, kind, seconds, nanoseconds, data in recorded(ros1_cloud, Ros1)]
    for compression in ("none", "bz2", "lz4"):
        with rosbag.Bag(os.path.join(out, "drive-%s.bag" % compression), "w", compression=compression) as bag:
            for topic, kind, time, data in messages:
                bag.write(topic, (kind._type, data, kind._md5sum, kind), time, raw=True)


def write_db3():
    folder = os.path.join(out, "drive-db3")
    os.mkdir(folder)
    database = sqlite3.connect(os.path.join(folder, "drive_0.db3"))
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
                     "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL,data BLOB NOT NULL)")
    type_of = {CLOUD: "sensor_msgs/msg/PointCloud2", TRANSFORMS: "tf2_msgs/msg/TFMessage"}
    ids = {}
    for topic, kind, seconds, nanoseconds, data in recorded(cdr_cloud, Cdr):
        if topic not in ids:
            ids[topic] = len(ids) + 1
            database.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')", (ids[topic], topic, type_of[kind]))
        database.execute("INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)",
                         (ids[topic], seconds * 1000000000 + nanoseconds, data))
    database.commit()
    database.close()
    with open(os.path.join(folder, "metadata.yaml"), "w") as metadata:
        metadata.write("rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
                       "  relative_file_paths:\n    - drive_0.db3\n")


write_rosbags()
write_db3()
