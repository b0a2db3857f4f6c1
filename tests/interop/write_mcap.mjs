// Writes MCAP files by @mcap/core: node write_mcap.mjs FOLDER
// FOLDER/messages.txt names all messages: topic, type, encoding, time in ns, data in hexadecimal. Every file holds them all.
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import { McapWriter } from "@mcap/core";
import zstd from "@foxglove/wasm-zstd";
import { Buffered } from "./buffered.mjs";

await zstd.isLoaded;
const folder = process.argv[2];

const text = (words) => new TextEncoder().encode(words);
const channels = [
  { topic: "/lidar/points", type: "sensor_msgs/msg/PointCloud2", schema: "ros2msg", encoding: "cdr" },
  { topic: "/ros1/points", type: "sensor_msgs/PointCloud2", schema: "ros1msg", encoding: "ros1" },
  { topic: "/cloud", type: "foxglove.PointCloud", schema: "protobuf", encoding: "protobuf" },
  { topic: "/cloud_json", type: "foxglove.PointCloud", schema: "jsonschema", encoding: "json" },
];

// Numbers that say nothing, always the same.
let state = 12345;
const random = () => (state = (Math.imul(state, 1103515245) + 12345) & 0x7fffffff) >> 8;

const messages = [];
for (let k = 0; k < 60; ++k) {
  const data = new Uint8Array(random() % 3000);
  for (let i = 0; i < data.length; ++i) {
    data[i] = k % 2 === 0 ? random() & 0xff : k;
  }
  // Some are recorded a little after the next one.
  messages.push({ channel: k % channels.length, time: 1700000000000000001n + BigInt(k + (k % 5 === 0 ? 2 : 0)) * 100000000n, data });
}

async function write(name, options) {
  const file = new Buffered();
  const writer = new McapWriter({ writable: file, ...options });
  await writer.start({ profile: "ros2", library: "test" });
  const ids = [];
  for (const { topic, type, schema, encoding } of channels) {
    const schemaId = await writer.registerSchema({ name: type, encoding: schema, data: text("definition of " + type) });
    ids.push(await writer.registerChannel({ topic, schemaId, messageEncoding: encoding, metadata: new Map([["key", "value"]]) }));
  }
  await writer.addMetadata({ name: "about", metadata: new Map([["a", "b"]]) });
  for (const [sequence, { channel, time, data }] of messages.entries()) {
    if (sequence === 30) {
      await writer.addAttachment({ name: "a.txt", logTime: time, createTime: time, mediaType: "text/plain", data: text("attached") });
    }
    await writer.addMessage({ channelId: ids[channel], sequence, logTime: time, publishTime: time - 5n, data });
  }
  await writer.end();
  await writeFile(join(folder, name), file.bytes());
}

const packed = { compressChunk: (chunk) => ({ compression: "zstd", compressedData: zstd.compress(chunk, 3) }), chunkSize: 10000 };
await write("indexed-zstd.mcap", packed);
await write("indexed-none.mcap", { chunkSize: 10000 });
await write("unindexed-no-chunks.mcap", { useChunks: false });
await write("unindexed-no-summary.mcap", { ...packed, useStatistics: false, useSummaryOffsets: false, repeatSchemas: false, repeatChannels: false,
  useAttachmentIndex: false, useMetadataIndex: false, useMessageIndex: false, useChunkIndex: false });
await write("unindexed-no-statistics.mcap", { ...packed, useStatistics: false });
await write("unindexed-no-channels.mcap", { ...packed, repeatSchemas: false, repeatChannels: false });
await write("indexed-no-message-index.mcap", { ...packed, useMessageIndex: false });

const lines = messages.map(({ channel, time, data }) =>
  [channels[channel].topic, channels[channel].type, channels[channel].encoding, time, "0x" + Buffer.from(data).toString("hex")].join(" "));
await writeFile(join(folder, "messages.txt"), lines.join("\n") + "\n");
