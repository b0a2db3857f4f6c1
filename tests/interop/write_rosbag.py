"""Writes ROS 1 bags by rosbag, the recorder's own library: write_rosbag.py FOLDER

FOLDER/messages.txt names all messages: topic, type, encoding, time in ns, data in hexadecimal. Every bag holds them all.
"""
import os
import random
import shutil
import sys

import genpy
import rosbag

folder = sys.argv[1]
definitions = {
    "sensor_msgs/PointCloud2": "Header header\nuint32 height\n",
    "sensor_msgs/Imu": "Header header\n",
}
channels = [("/points", "sensor_msgs/PointCloud2"), ("/imu", "sensor_msgs/Imu"), ("/tf", "sensor_msgs/Imu")]


def message_class(name):
    return type(name.split("/")[1], (), {"_type": name, "_md5sum": "0" * 32, "_full_text": definitions[name]})


classes = {name: message_class(name) for name in definitions}
numbers = random.Random(1)
messages = []
for k in range(80):
    size = numbers.randrange(3000)
    data = bytes(numbers.randrange(256) for _ in range(size)) if k % 2 else bytes([k]) * size
    # Some are recorded a little after the next one.
    time = 1700000000000000001 + (k + (2 if k % 5 == 0 else 0)) * 100000000
    messages.append((channels[k % 3], time, data))


def write(name, compression, closed=True):
    path = os.path.join(folder, name)
    bag = rosbag.Bag(path, "w", compression=compression, chunk_threshold=10000)
    for (topic, kind), time, data in messages:
        stamp = genpy.Time(time // 1000000000, time % 1000000000)
        bag.write(topic, (kind, data, classes[kind]._md5sum, classes[kind]), stamp, raw=True)
    if not closed:  # as the recorder leaves it when it is killed
        bag._file.flush()
        shutil.copy(path, path + ".killed")
    bag.close()
    if not closed:
        os.rename(path + ".killed", path)


for compression in ("none", "bz2", "lz4"):
    write("indexed-%s.bag" % compression, compression)
write("unindexed-none.bag", "none", closed=False)

with open(os.path.join(folder, "messages.txt"), "w") as manifest:
    for (topic, kind), time, data in messages:
        manifest.write("%s %s ros1 %d 0x%s\n" % (topic, kind, time, data.hex()))
