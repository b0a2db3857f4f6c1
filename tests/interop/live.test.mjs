// What run --live sends, received by @foxglove/ws-protocol over the sockets of `ws`, against the MCAP file of the same
// run. Status 77 (skipped) where the packages are missing. DYNAMIC_ICP_PROGRAM names the program.
import assert from 'node:assert/strict';
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { once } from 'node:events';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';
import { createInterface } from 'node:readline';

import { columnsOf, readMcap, skipWithoutPackages } from './read_mcap.mjs';

skipWithoutPackages(['@foxglove/ws-protocol', 'ws']);
const require = createRequire(import.meta.url);
const { FoxgloveClient } = require('@foxglove/ws-protocol');
const { protobufFromBinaryDescriptor } = require('@mcap/support');
const { WebSocket } = require('ws');

const program = process.env.DYNAMIC_ICP_PROGRAM;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'live-'));
const children = [];

/// A run with a live view at a free port; the address once it is told.
async function startRunOf(input, ...words) {
  const child = spawn(program, ['run', input, '--live=0', '--threads', '1', ...words], { cwd: folder, stdio: ['ignore', 'ignore', 'pipe'] });
  children.push(child);
  const exited = once(child, 'exit');
  for await (const line of createInterface({ input: child.stderr })) {
    const found = /http:\/\/([\d.]+:\d+)\//.exec(line);
    if (found) return { child, exited, authority: found[1] };
  }
  throw new Error('no address was told');
}

const startRun = (...words) => startRunOf('drive', ...words);

/// All that a client is sent until the server ends.
function receive(authority) {
  const client = new FoxgloveClient({ ws: new WebSocket(`ws://${authority}/`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
  const channels = new Map();
  const got = { info: null, channels: [], statuses: [], times: [], messages: [], done: null };
  client.on('serverInfo', (info) => { got.info = info; });
  client.on('status', (status) => got.statuses.push(status));
  client.on('time', ({ timestamp }) => got.times.push(timestamp));
  client.on('advertise', (list) => {
    for (const channel of list) {
      got.channels.push(channel);
      channels.set(client.subscribe(channel.id), channel);
    }
  });
  client.on('message', ({ subscriptionId, timestamp, data }) => {
    // The view lies in a larger buffer that the socket may use again.
    got.messages.push({ topic: channels.get(subscriptionId).topic, timestamp, bytes: new Uint8Array(data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength)) });
  });
  client.on('error', () => {});
  got.done = new Promise((done) => client.on('close', done));
  return got;
}

async function sameAsTheFile() {
  const { exited, authority } = await startRun('--output', 'run', '--mcap', 'run.mcap');
  const clients = [receive(authority), receive(authority)];
  await Promise.all(clients.map(({ done }) => done));
  assert.equal((await exited)[0], 0);
  const file = await readMcap(path.join(folder, 'run.mcap'));
  const recorded = new Map(file.messages.map((message) => [`${message.topic} ${message.logTime}`, message]));
  const last = file.messages.at(-1).logTime;
  for (const { info, channels, statuses, times, messages } of clients) {
    assert.match(info.name, /^dynamic-icp .*: drive$/);
    assert.deepEqual(info.capabilities, ['time']);
    assert.deepEqual(statuses.map(({ message }) => message), ['the run has ended']);
    assert.ok(times.length > 0 && times.at(-1) === last);
    assert.deepEqual(channels.map(({ topic }) => topic).sort(), file.channels.map(({ topic }) => topic).sort());
    for (const channel of channels) {
      const mine = messages.filter(({ topic }) => topic === channel.topic);
      assert.ok(mine.length > 0, channel.topic);
      if (channel.topic !== '/ground_truth/path') assert.equal(mine.at(-1).timestamp, last, channel.topic);
      mine.reduce((before, { timestamp }) => (assert.ok(timestamp > before), timestamp), -1n);
      assert.equal(channel.encoding, 'protobuf');
      assert.equal(channel.schemaEncoding, 'protobuf');
      const type = protobufFromBinaryDescriptor(new Uint8Array(Buffer.from(channel.schema, 'base64'))).lookupType(channel.schemaName);
      for (const { bytes } of mine) assert.equal(type.verify(type.decode(bytes)), null);
      if (channel.topic === '/points') {
        assert.ok(columnsOf(type.decode(mine[0].bytes)).doppler_compensated.length > 1000);
      }
    }
    for (const { topic, timestamp, bytes } of messages) {
      if (topic === '/odometry/state') continue; // times of computation differ
      const same = recorded.get(`${topic} ${timestamp}`);
      assert.ok(same, `${topic} at ${timestamp}`);
      assert.ok(Buffer.compare(bytes, same.bytes) === 0, `${topic} at ${timestamp}`);
    }
  }
}

/// Clients that are killed, or never read, change nothing.
async function clientsThatAreGone() {
  const { child, exited, authority } = await startRun('--output', 'other');
  const subscribe = JSON.stringify({ op: 'subscribe', subscriptions: [0, 1, 2, 3, 4].map((id) => ({ id, channelId: id })) });
  const sockets = Array.from({ length: 20 }, () => new WebSocket(`ws://${authority}/`, ['foxglove.websocket.v1']));
  await Promise.all(sockets.map((socket) => once(socket, 'open')));
  for (const socket of sockets) socket.send(subscribe);
  sockets.forEach((socket, k) => {
    socket.on('error', () => {});
    if (k % 2) socket.once('message', () => socket.terminate());
    else socket._socket.pause();
  });
  assert.equal((await exited)[0], 0, child.spawnargs.join(' '));
  sockets.forEach((socket) => socket.terminate());
  for (const name of ['trajectory.tum', 'objects.jsonl']) {
    assert.equal(fs.readFileSync(path.join(folder, 'other', name), 'utf8'), fs.readFileSync(path.join(folder, 'run', name), 'utf8'), name);
  }
}

/// Clients that are processes of their own and are killed while they are sent something.
async function clientsThatAreKilled() {
  const { exited, authority } = await startRun('--output', 'killed');
  const client = `
    const { WebSocket } = require(${JSON.stringify(require.resolve('ws'))});
    const socket = new WebSocket('ws://${authority}/', ['foxglove.websocket.v1']);
    const subscriptions = [0, 1, 2, 3, 4].map((id) => ({ id, channelId: id }));
    socket.on('open', () => socket.send(JSON.stringify({ op: 'subscribe', subscriptions })));
    socket.on('message', (data, isBinary) => isBinary && console.log('got'));`;
  const clients = Array.from({ length: 4 }, () => spawn(process.execPath, ['-e', client], { stdio: ['ignore', 'pipe', 'inherit'] }));
  children.push(...clients);
  await Promise.all(clients.map(async (one) => {
    await Promise.race([once(one.stdout, 'data'), once(one, 'exit')]);
    one.kill('SIGKILL');
  }));
  assert.equal((await exited)[0], 0);
  assert.equal(fs.readFileSync(path.join(folder, 'killed', 'trajectory.tum'), 'utf8'), fs.readFileSync(path.join(folder, 'run', 'trajectory.tum'), 'utf8'));
}

/// A port that another run has, and a run that is killed: its clients notice, its port is free again, nothing is half there.
async function portsAndKills() {
  fs.mkdirSync(path.join(folder, 'waits', 'point_clouds'), { recursive: true });
  for (const name of fs.readdirSync(path.join(folder, 'drive', 'point_clouds'))) {
    fs.copyFileSync(path.join(folder, 'drive', 'point_clouds', name), path.join(folder, 'waits', 'point_clouds', name));
  }
  const { child, exited, authority } = await startRunOf('waits', '--follow', '--output', 'never');
  const port = authority.split(':')[1];
  const second = spawnSync(program, ['run', 'drive', `--live=${port}`, '--output', 'second'], { cwd: folder, encoding: 'utf8' });
  assert.equal(second.status, 1, second.stderr);
  assert.match(second.stderr, new RegExp(port));
  assert.ok(!fs.existsSync(path.join(folder, 'second')));
  const client = receive(authority);
  child.kill('SIGKILL');
  await client.done;
  await exited;
  assert.ok(!fs.existsSync(path.join(folder, 'never')));
  const again = spawnSync(program, ['run', 'drive', `--live=${port}`, '--output', 'again', '--max-frames', '2'], { cwd: folder, encoding: 'utf8' });
  assert.equal(again.status, 0, again.stderr);
  assert.deepEqual(fs.readdirSync(folder).filter((name) => name.includes('partial')), []);
}

/// Other pages, other hosts.
async function whoMayNot() {
  const { child, authority } = await startRun('--output', 'third');
  const opened = (options) => new Promise((done) => {
    const socket = new WebSocket(`ws://${authority}/`, ['foxglove.websocket.v1'], options);
    socket.on('open', () => { socket.terminate(); done('open'); });
    socket.on('error', (error) => done(error.message));
  });
  assert.match(await opened({ origin: 'https://evil.example' }), /403/);
  assert.match(await opened({ headers: { host: `evil.example:${authority.split(':')[1]}` } }), /403/);
  assert.equal(await opened({ origin: `http://${authority}` }), 'open');
  child.kill('SIGTERM');
}

try {
  execFileSync(program, ['simulate', 'city', '--output', 'drive', '--frames', '12', '--seed', '4', '--quiet', '--set', 'lidar.columns=500'], { cwd: folder });
  await sameAsTheFile();
  await clientsThatAreGone();
  await clientsThatAreKilled();
  await portsAndKills();
  await whoMayNot();
} finally {
  children.forEach((child) => child.kill('SIGKILL'));
  await Promise.all(children.map((child) => child.exitCode ?? child.signalCode ?? once(child, 'exit')));
  fs.rmSync(folder, { recursive: true });
}
console.log('passed');
