// A drive that @mcap/core writes is followed while it comes, through standard input and in a file: the run is that of the
// finished file. Status 77 (skipped) where the packages are missing. DYNAMIC_ICP_PROGRAM names the program.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import fs from 'node:fs';
import fsPromises from 'node:fs/promises';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';

import { skipWithoutPackages } from './read_mcap.mjs';

skipWithoutPackages();
const require = createRequire(import.meta.url);
const { McapIndexedReader, McapWriter } = require('@mcap/core');
const { loadDecompressHandlers } = require('@mcap/support');
const { FileHandleReadable } = require('@mcap/nodejs');

const program = process.env.DYNAMIC_ICP_PROGRAM;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'follow-'));
const run = (words, options = {}) => spawn(program, ['run', ...words, '--threads', '1', '--quiet'], { cwd: folder, stdio: ['pipe', 'inherit', 'inherit'], ...options });

/// Writes the messages of a file again, chunk by chunk, to `write`.
async function rewrite(file, write, settings) {
  const handle = await fsPromises.open(file);
  const reader = await McapIndexedReader.Initialize({ readable: new FileHandleReadable(handle), decompressHandlers: await loadDecompressHandlers() });
  let position = 0n;
  const writer = new McapWriter({
    writable: {
      position: () => position,
      write: async (bytes) => {
        position += BigInt(bytes.byteLength);
        await write(Buffer.from(bytes));
      },
    },
    ...settings,
  });
  await writer.start({ profile: '', library: 'by @mcap/core' });
  const channels = new Map();
  for await (const message of reader.readMessages()) {
    if (!channels.has(message.channelId)) {
      const channel = reader.channelsById.get(message.channelId);
      const schema = reader.schemasById.get(channel.schemaId);
      const schemaId = schema ? await writer.registerSchema(schema) : 0;
      channels.set(message.channelId, await writer.registerChannel({ ...channel, schemaId }));
    }
    await writer.addMessage({ ...message, channelId: channels.get(message.channelId) });
  }
  await writer.end();
  await handle.close();
}

const trajectory = (name) => fs.readFileSync(path.join(folder, name, 'trajectory.tum'), 'utf8');

try {
  execFileSync(program, ['simulate', 'city', '--output', 'drive', '--frames', '14', '--seed', '4', '--quiet', '--set', 'lidar.columns=500'], { cwd: folder });
  execFileSync(program, ['convert', 'drive', '--to', 'mcap', '--output', 'drive.mcap', '--quiet'], { cwd: folder });
  assert.equal((await once(run(['drive.mcap', '--output', 'finished']), 'exit'))[0], 0);

  const piped = run(['-', '--follow', '--output', 'piped']);
  const pipedEnd = once(piped, 'exit');
  await rewrite(path.join(folder, 'drive.mcap'), async (bytes) => {
    for (let at = 0; at < bytes.length; at += 99991) {
      if (!piped.stdin.write(bytes.subarray(at, at + 99991))) await once(piped.stdin, 'drain');
    }
  }, { chunkSize: 700000 });
  piped.stdin.end();
  assert.equal((await pipedEnd)[0], 0);
  assert.equal(trajectory('piped'), trajectory('finished'));

  const growing = path.join(folder, 'growing.mcap');
  fs.writeFileSync(growing, '');
  const grown = run(['growing.mcap', '--follow', '--output', 'grown']);
  const grownEnd = once(grown, 'exit');
  let piece = 0;
  await rewrite(path.join(folder, 'drive.mcap'), async (bytes) => {
    fs.appendFileSync(growing, bytes);
    if (++piece % 50 === 0) await sleep(5);
  }, { useChunks: false, useSummaryOffsets: false });
  assert.equal((await grownEnd)[0], 0);
  assert.equal(trajectory('grown'), trajectory('finished'));
} finally {
  fs.rmSync(folder, { recursive: true });
}
console.log('passed');
