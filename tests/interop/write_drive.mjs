// Writes a drive in the layout dicp as MCAP files: node write_drive.mjs DRIVE OUT
// DRIVE has point_clouds/*.bin (float32 x, y, z, Doppler), times/*.bin (float32 seconds) and ref_poses.txt, whose first
// column are seconds. OUT gets drive-ros2.mcap (CDR by @foxglove/rosmsg2-serialization), drive-protobuf.mcap (by
// protobufjs) and drive-json.mcap, both of foxglove.PointCloud; chunks are packed with zstd.
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { parse } from "@foxglove/rosmsg";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import zstd from "@foxglove/wasm-zstd";
import { McapWriter } from "@mcap/core";
import protobuf from "protobufjs";
import { Buffered } from "./buffered.mjs";

await zstd.isLoaded;
const [drive, out] = process.argv.slice(2);

const names = ["x", "y", "z", "doppler", "time_offset_s"];
const stride = 4 * names.length;

async function* scans() {
  const lines = (await readFile(join(drive, "ref_poses.txt"), "utf8")).trim().split("\n");
  for (const [k, line] of lines.entries()) {
    const [sec, nsec] = line.split(" ")[0].split(".").map(Number);
    const name = String(k + 1).padStart(5, "0") + ".bin";
    const points = await readFile(join(drive, "point_clouds", name));
    const times = await readFile(join(drive, "times", name));
    const data = Buffer.alloc((points.length / 16) * stride);
    for (let i = 0; i < points.length / 16; ++i) {
      points.copy(data, i * stride, 16 * i, 16 * i + 16);
      times.copy(data, i * stride + 16, 4 * i, 4 * i + 4);
    }
    yield { sec, nsec, data };
  }
}

async function write(name, channel, encode) {
  const file = new Buffered();
  const compressChunk = (chunk) => ({ compression: "zstd", compressedData: zstd.compress(chunk, 1) });
  const writer = new McapWriter({ writable: file, compressChunk });
  await writer.start({ profile: "", library: "test" });
  const schemaId = await writer.registerSchema({ name: channel.type, encoding: channel.schema, data: new TextEncoder().encode("not looked at") });
  const channelId = await writer.registerChannel({ topic: "/lidar/points", schemaId, messageEncoding: channel.encoding, metadata: new Map() });
  let sequence = 0;
  for await (const scan of scans()) {
    const logTime = BigInt(scan.sec + 1) * 1000000000n + BigInt(scan.nsec);
    await writer.addMessage({ channelId, sequence: sequence++, logTime, publishTime: logTime, data: encode(scan) });
  }
  await writer.end();
  await writeFile(join(out, name), file.bytes());
}

const separator = "=".repeat(80);
const definition = `std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
${separator}
MSG: sensor_msgs/PointField
string name
uint32 offset
uint8 datatype
uint32 count
${separator}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
${separator}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
`;
const cdr = new MessageWriter(parse(definition, { ros2: true }));
await write("drive-ros2.mcap", { type: "sensor_msgs/msg/PointCloud2", schema: "ros2msg", encoding: "cdr" }, ({ sec, nsec, data }) =>
  cdr.writeMessage({
    header: { stamp: { sec, nanosec: nsec }, frame_id: "lidar" },
    height: 1,
    width: data.length / stride,
    fields: names.map((name, k) => ({ name, offset: 4 * k, datatype: 7, count: 1 })),
    is_bigendian: false,
    point_step: stride,
    row_step: data.length,
    data,
    is_dense: true,
  }),
);

const { root } = protobuf.parse(`syntax = "proto3";
message Timestamp { int64 seconds = 1; int32 nanos = 2; }
message Vector3 { double x = 1; double y = 2; double z = 3; }
message Quaternion { double x = 1; double y = 2; double z = 3; double w = 4; }
message Pose { Vector3 position = 1; Quaternion orientation = 2; }
message PackedElementField { string name = 1; fixed32 offset = 2; int32 type = 3; }
message PointCloud {
  Timestamp timestamp = 1; string frame_id = 2; Pose pose = 3; fixed32 point_stride = 4;
  repeated PackedElementField fields = 5; bytes data = 6;
}`, { keepCase: true });
const pose = { position: { x: 0, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
const fields = names.map((name, k) => ({ name, offset: 4 * k, type: 7 }));
const cloud = root.lookupType("PointCloud");
await write("drive-protobuf.mcap", { type: "foxglove.PointCloud", schema: "protobuf", encoding: "protobuf" }, ({ sec, nsec, data }) =>
  cloud.encode(cloud.create({ timestamp: { seconds: sec, nanos: nsec }, frame_id: "lidar", pose, point_stride: stride, fields, data })).finish(),
);
await write("drive-json.mcap", { type: "foxglove.PointCloud", schema: "jsonschema", encoding: "json" }, ({ sec, nsec, data }) =>
  new TextEncoder().encode(JSON.stringify({ timestamp: { sec, nsec }, frame_id: "lidar", pose, point_stride: stride, fields, data: data.toString("base64") })),
);
