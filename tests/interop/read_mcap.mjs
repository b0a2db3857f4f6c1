// Reads an MCAP file with @mcap/core and decodes its protobuf and JSON messages by the schemas in the file: an
// implementation that shares nothing with ours. As a program: node read_mcap.mjs FILE prints what is in it.
import { createRequire } from 'node:module';
import fs from 'node:fs';
import fsPromises from 'node:fs/promises';
import process from 'node:process';

const require = createRequire(import.meta.url);

/// Ends with the status for a skipped test where the packages are missing.
export function skipWithoutPackages(others = []) {
  for (const name of ['@mcap/core', '@mcap/support', '@mcap/nodejs', 'protobufjs', ...others]) {
    try {
      require.resolve(name);
    } catch {
      console.log(`skipped: ${name} is not installed (scripts/install_viewer.sh tests)`);
      process.exit(77);
    }
  }
}

/// The whole file: { header, statistics, schemas, channels, metadata, chunks, messages: [{topic, type, logTime,
/// publishTime, sequence, value}] }. Throws where a checksum, an index or the summary is wrong.
export async function readMcap(file) {
  const { McapIndexedReader, McapStreamReader } = require('@mcap/core');
  const { loadDecompressHandlers, protobufFromBinaryDescriptor } = require('@mcap/support');
  const { FileHandleReadable } = require('@mcap/nodejs');
  const { crc32 } = require('@foxglove/crc');
  const decompressHandlers = await loadDecompressHandlers();
  const handle = await fsPromises.open(file);
  try {
    const reader = await McapIndexedReader.Initialize({ readable: new FileHandleReadable(handle), decompressHandlers });
    const decoders = new Map();
    for (const [id, schema] of reader.schemasById) {
      if (schema.encoding === 'protobuf') {
        const type = protobufFromBinaryDescriptor(schema.data).lookupType(schema.name);
        decoders.set(id, (bytes) => type.decode(bytes));
      } else {
        JSON.parse(new TextDecoder().decode(schema.data));
        decoders.set(id, (bytes) => JSON.parse(new TextDecoder().decode(bytes)));
      }
    }
    const messages = [];
    for await (const message of reader.readMessages({ validateCrcs: true })) {
      const channel = reader.channelsById.get(message.channelId);
      messages.push({
        topic: channel.topic,
        type: reader.schemasById.get(channel.schemaId).name,
        logTime: message.logTime,
        publishTime: message.publishTime,
        sequence: message.sequence,
        value: decoders.get(channel.schemaId)(message.data),
        bytes: message.data,
      });
    }
    const metadata = [];
    for await (const record of reader.readMetadata()) {
      metadata.push(record);
    }
    checkStream(new McapStreamReader({ decompressHandlers, validateCrcs: true }), fs.readFileSync(file), messages, crc32);
    return {
      header: reader.header,
      footer: reader.footer,
      statistics: reader.statistics,
      schemas: [...reader.schemasById.values()],
      channels: [...reader.channelsById.values()],
      chunks: reader.chunkIndexes,
      metadata,
      messages,
    };
  } finally {
    await handle.close();
  }
}

/// The same from front to back, without the index: as many messages, and the checksum of the data section.
function checkStream(reader, bytes, messages, crc32) {
  reader.append(bytes);
  let count = 0;
  let dataCrc;
  for (let record = reader.nextRecord(); record != undefined; record = reader.nextRecord()) {
    count += record.type === 'Message' ? 1 : 0;
    dataCrc = record.type === 'DataEnd' ? record.dataSectionCrc : dataCrc;
  }
  if (!reader.done() || count !== messages.length) {
    throw new Error(`${count} messages from front to back, ${messages.length} by the index`);
  }
  const footer = 8 + 1 + 8 + 20; // magic, opcode, length, content
  const summaryStart = Number(bytes.readBigUInt64LE(bytes.length - footer + 9));
  const expected = crc32(bytes.subarray(0, summaryStart - (1 + 8 + 4)));
  if (dataCrc !== expected) {
    throw new Error(`the checksum of the data section is ${dataCrc}, expected ${expected}`);
  }
}

const kReaders = [undefined, ['getUint8', 1], ['getInt8', 1], ['getUint16', 2], ['getInt16', 2], ['getUint32', 4],
  ['getInt32', 4], ['getFloat32', 4], ['getFloat64', 8]];

/// The columns of a foxglove.PointCloud by name.
export function columnsOf(cloud) {
  const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
  const stride = cloud.point_stride;
  if (view.byteLength % stride !== 0) {
    throw new Error(`${view.byteLength} bytes are no points of ${stride}`);
  }
  const columns = {};
  for (const field of cloud.fields) {
    const [read, width] = kReaders[field.type];
    if (field.offset + width > stride) {
      throw new Error(`field ${field.name} reaches beyond the point`);
    }
    columns[field.name] = [];
    for (let at = field.offset; at < view.byteLength; at += stride) {
      columns[field.name].push(view[read](at, true));
    }
  }
  return columns;
}

/// google.protobuf.Timestamp or Duration in ns.
export function nanoseconds(time) {
  return BigInt(time.seconds.toString()) * 1_000_000_000n + BigInt(time.nanos ?? 0);
}

if (process.argv[1] === new URL(import.meta.url).pathname) {
  skipWithoutPackages();
  const file = await readMcap(process.argv[2]);
  const counts = {};
  for (const message of file.messages) {
    counts[`${message.topic} (${message.type})`] = (counts[`${message.topic} (${message.type})`] ?? 0) + 1;
  }
  console.log(file.header, counts, `${file.chunks.length} chunks`, file.metadata);
  for (const topic of new Set(file.messages.map((message) => message.topic))) {
    const last = file.messages.filter((message) => message.topic === topic).at(-1);
    console.log(topic, last.logTime, JSON.stringify(last.value, (key, value) =>
      key === 'data' ? `${value.length} bytes` : Array.isArray(value) && value.length > 3 ? value.slice(0, 3) : value));
  }
}
