// Writes a drive in the layout dicp as MCAP files: node write_drive.mjs DRIVE OUT [SENSOR=x,y,z,qx,qy,qz,qw ...]
// DRIVE has point_clouds/*.bin (float32 x, y, z, Doppler), times/*.bin (float32 seconds) and ref_poses.txt, whose first
// column are seconds. With sensors each has these in DRIVE/SENSOR, and is mounted on base_link as stated: a rig.
// OUT gets drive-ros1.mcap (by @foxglove/rosmsg-serialization), drive-ros2.mcap and drive-mcap, a bag of rosbag2 (CDR by
// @foxglove/rosmsg2-serialization), drive-protobuf.mcap (by protobufjs) and drive-json.mcap, both of foxglove.PointCloud.
// Chunks are packed with zstd, those of the last and of the bag not at all.
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { parse } from "@foxglove/rosmsg";
import { MessageWriter as Ros1Writer } from "@foxglove/rosmsg-serialization";
import { MessageWriter as CdrWriter } from "@foxglove/rosmsg2-serialization";
import zstd from "@foxglove/wasm-zstd";
import { McapWriter } from "@mcap/core";
import protobuf from "protobufjs";
import { Buffered } from "./buffered.mjs";

await zstd.isLoaded;
const [drive, out, ...mounted] = process.argv.slice(2);
const rig = mounted.map((word) => {
  const [x, y, z, qx, qy, qz, qw] = word.split("=")[1].split(",").map(Number);
  return { name: word.split("=")[0], translation: { x, y, z }, rotation: { x: qx, y: qy, z: qz, w: qw } };
});

const names = ["x", "y", "z", "doppler", "time_offset_s"];
const stride = 4 * names.length;

async function scansOf(folder, name) {
  const scans = [];
  const lines = (await readFile(join(folder, "ref_poses.txt"), "utf8")).trim().split("\n");
  for (const [k, line] of lines.entries()) {
    const [sec, nsec] = line.split(" ")[0].split(".").map(Number);
    const file = String(k + 1).padStart(5, "0") + ".bin";
    const points = await readFile(join(folder, "point_clouds", file));
    const times = await readFile(join(folder, "times", file));
    const data = Buffer.alloc((points.length / 16) * stride);
    for (let i = 0; i < points.length / 16; ++i) {
      points.copy(data, i * stride, 16 * i, 16 * i + 16);
      times.copy(data, i * stride + 16, 4 * i, 4 * i + 4);
    }
    scans.push({ name, sec, nsec, data });
  }
  return scans;
}

const scans = [];
for (const { name } of rig) {
  scans.push(...(await scansOf(join(drive, name), name)));
}
if (rig.length === 0) {
  scans.push(...(await scansOf(drive, "lidar")));
}
const logTime = ({ sec, nsec }) => BigInt(sec + 1) * 1000000000n + BigInt(nsec);
scans.sort((a, b) => (logTime(a) < logTime(b) ? -1 : 1));

/** A kind of messages: what its channels say, and how clouds and static transforms become bytes. */
async function write(name, { encoding, schema, cloud, transforms }, isPacked = true) {
  const file = new Buffered();
  const compressChunk = isPacked ? (chunk) => ({ compression: "zstd", compressedData: zstd.compress(chunk, 1) }) : undefined;
  const writer = new McapWriter({ writable: file, compressChunk, chunkSize: 200000 });
  await writer.start({ profile: "", library: "test" });
  const channel = async (topic, type) => {
    const schemaId = await writer.registerSchema({ name: type, encoding: schema, data: new TextEncoder().encode("not looked at") });
    return writer.registerChannel({ topic, schemaId, messageEncoding: encoding, metadata: new Map() });
  };
  if (rig.length > 0) {
    const channelId = await channel("/tf_static", transforms.type);
    const time = 1700000000000000000n;
    await writer.addMessage({ channelId, sequence: 0, logTime: time, publishTime: time, data: transforms.encode() });
  }
  const channels = new Map();
  for (const [sequence, scan] of scans.entries()) {
    if (!channels.has(scan.name)) {
      channels.set(scan.name, await channel(`/${scan.name}/points`, cloud.type));
    }
    const time = logTime(scan);
    await writer.addMessage({ channelId: channels.get(scan.name), sequence, logTime: time, publishTime: time, data: cloud.encode(scan) });
  }
  await writer.end();
  await writeFile(join(out, name), file.bytes());
}

const separator = "=".repeat(80) + "\n";
const time = { ros1: "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n",
  ros2: "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + separator +
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" };
const cloudDefinition = `std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
${separator}MSG: sensor_msgs/PointField
string name
uint32 offset
uint8 datatype
uint32 count
${separator}`;
const transformsDefinition = `geometry_msgs/TransformStamped[] transforms
${separator}MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
${separator}MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
${separator}MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
${separator}MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
${separator}`;

function ros(version) {
  const isRos2 = version === "ros2";
  const writer = (definition) => new (isRos2 ? CdrWriter : Ros1Writer)(parse(definition + time[version], { ros2: isRos2 }));
  const type = (folder, name) => (isRos2 ? `${folder}/msg/${name}` : `${folder}/${name}`);
  const header = (sec, nsec, frame_id) => ({ seq: 0, stamp: isRos2 ? { sec, nanosec: nsec } : { sec, nsec }, frame_id });
  const clouds = writer(cloudDefinition);
  return {
    encoding: isRos2 ? "cdr" : "ros1",
    schema: isRos2 ? "ros2msg" : "ros1msg",
    cloud: {
      type: type("sensor_msgs", "PointCloud2"),
      encode: ({ name, sec, nsec, data }) =>
        clouds.writeMessage({
          header: header(sec, nsec, name),
          height: 1,
          width: data.length / stride,
          fields: names.map((field, k) => ({ name: field, offset: 4 * k, datatype: 7, count: 1 })),
          is_bigendian: false,
          point_step: stride,
          row_step: data.length,
          data,
          is_dense: true,
        }),
    },
    transforms: {
      type: type("tf2_msgs", "TFMessage"),
      encode: () =>
        writer(transformsDefinition).writeMessage({
          transforms: rig.map(({ name, translation, rotation }) => ({
            header: header(1700000000, 0, "base_link"), child_frame_id: name, transform: { translation, rotation } })),
        }),
    },
  };
}

const { root } = protobuf.parse(`syntax = "proto3";
message Timestamp { int64 seconds = 1; int32 nanos = 2; }
message Vector3 { double x = 1; double y = 2; double z = 3; }
message Quaternion { double x = 1; double y = 2; double z = 3; double w = 4; }
message Pose { Vector3 position = 1; Quaternion orientation = 2; }
message PackedElementField { string name = 1; fixed32 offset = 2; int32 type = 3; }
message PointCloud {
  Timestamp timestamp = 1; string frame_id = 2; Pose pose = 3; fixed32 point_stride = 4;
  repeated PackedElementField fields = 5; bytes data = 6;
}
message FrameTransform {
  Timestamp timestamp = 1; string parent_frame_id = 2; string child_frame_id = 3; Vector3 translation = 4; Quaternion rotation = 5;
}
message FrameTransforms { repeated FrameTransform transforms = 1; }`, { keepCase: true });

function foxglove(encoding, schema, stamp, encode) {
  const pose = { position: { x: 0, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
  const fields = names.map((name, k) => ({ name, offset: 4 * k, type: 7 }));
  return {
    encoding,
    schema,
    cloud: {
      type: "foxglove.PointCloud",
      encode: ({ name, sec, nsec, data }) =>
        encode("PointCloud", { timestamp: stamp(sec, nsec), frame_id: name, pose, point_stride: stride, fields, data }),
    },
    transforms: {
      type: "foxglove.FrameTransforms",
      encode: () =>
        encode("FrameTransforms", {
          transforms: rig.map(({ name, translation, rotation }) => ({
            timestamp: stamp(1700000000, 0), parent_frame_id: "base_link", child_frame_id: name, translation, rotation })),
        }),
    },
  };
}

const asProtobuf = (type, message) => root.lookupType(type).encode(root.lookupType(type).create(message)).finish();
const asJson = (_, message) => new TextEncoder().encode(JSON.stringify({ ...message, data: message.data?.toString("base64") }));

await write("drive-ros1.mcap", ros("ros1"));
await write("drive-ros2.mcap", ros("ros2"));
await write("drive-protobuf.mcap", foxglove("protobuf", "protobuf", (seconds, nanos) => ({ seconds, nanos }), asProtobuf));
await write("drive-json.mcap", foxglove("json", "jsonschema", (sec, nsec) => ({ sec, nsec }), asJson), false);
await mkdir(join(out, "drive-mcap"));
await write("drive-mcap/drive_0.mcap", ros("ros2"), false);
await writeFile(join(out, "drive-mcap", "metadata.yaml"),
  "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n  relative_file_paths:\n    - drive_0.mcap\n");
