"""Writes a bag of ROS 2, two databases and their metadata.yaml, by Python's sqlite3: write_db3.py FOLDER

The tables are those that rosbag2 makes. FOLDER/messages.txt names all messages: topic, type, encoding, time in ns, data
in hexadecimal.
"""
import os
import random
import sqlite3
import sys

folder = sys.argv[1]
bag = os.path.join(folder, "indexed-drive")
os.mkdir(bag)
channels = [("/points", "sensor_msgs/msg/PointCloud2"), ("/imu", "sensor_msgs/msg/Imu")]
numbers = random.Random(2)
messages = []
for k in range(60):
    size = numbers.randrange(20000 if k % 2 == 0 else 300)
    messages.append((k % 2, 1700000000000000001 + k * 100000000, bytes(numbers.randrange(256) for _ in range(size))))

names = ["drive_0.db3", "drive_1.db3"]
for part, name in enumerate(names):
    database = sqlite3.connect(os.path.join(bag, name))
    database.execute("CREATE TABLE schema(schema_version INTEGER PRIMARY KEY,ros_distro TEXT NOT NULL)")
    database.execute("CREATE TABLE metadata(id INTEGER PRIMARY KEY,metadata_version INTEGER NOT NULL,metadata TEXT NOT NULL)")
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
                     "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL,type_description_hash TEXT NOT NULL)")
    database.execute("CREATE TABLE message_definitions(id INTEGER PRIMARY KEY,topic_type TEXT NOT NULL,encoding TEXT NOT NULL,"
                     "encoded_message_definition TEXT NOT NULL,type_description_hash TEXT NOT NULL)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL,data BLOB NOT NULL)")
    database.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    database.execute("INSERT INTO schema VALUES (4, 'jazzy')")
    for number, (topic, kind) in enumerate(channels):
        # Numbers differ from file to file.
        database.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '', '')", (number + 1 + 10 * part, topic, kind))
        database.execute("INSERT INTO message_definitions VALUES (?, ?, 'ros2msg', ?, '')", (number + 1, kind, "definition of " + kind))
    for channel, time, data in messages[30 * part:30 * part + 30]:
        database.execute("INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)", (channel + 1 + 10 * part, time, data))
    database.commit()
    database.close()

with open(os.path.join(bag, "metadata.yaml"), "w") as metadata:
    metadata.write("""rosbag2_bagfile_information:
  version: 5
  storage_identifier: sqlite3
  duration:
    nanoseconds: 5900000000
  starting_time:
    nanoseconds_since_epoch: 1700000000000000001
  message_count: 60
  topics_with_message_count:
    - topic_metadata:
        name: /points
        type: sensor_msgs/msg/PointCloud2
        serialization_format: cdr
        offered_qos_profiles: "- history: 3\\n  depth: 0"
      message_count: 30
  compression_format: ""
  compression_mode: ""
  relative_file_paths:
    - drive_0.db3
    - drive_1.db3
  files:
    - path: drive_0.db3
""")

with open(os.path.join(folder, "messages.txt"), "w") as manifest:
    for channel, time, data in messages:
        manifest.write("%s %s cdr %d 0x%s\n" % (*channels[channel], time, data.hex()))
