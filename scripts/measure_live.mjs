// What a live view costs the odometry: a drive of full size comes at 10 Hz into a folder and is followed, without live
// view, with one that nobody watches, with a page, and with many clients of which some never read and some vanish and
// come back. Prints for each the time of the odometry a scan, the latency, what threads of the live view and all others
// take of a core at that rate, and which scans were left out; and how busy the machine was. Nothing else should run on it.
// usage: node scripts/measure_live.mjs PROGRAM [--scans 150] [--clients 50] [--rounds 2] [--rate 10] [--threads 0]
//        (2 minutes a round; the packages of tests/interop: scripts/install_viewer.sh tests)
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const require = createRequire(fileURLToPath(new URL('../tests/interop/package.json', import.meta.url)));
const { WebSocket } = require('ws');

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: Object.fromEntries([['scans', '150'], ['clients', '50'], ['rounds', '2'], ['rate', '10'], ['threads', '0']]
    .map(([name, number]) => [name, { type: 'string', default: number }])),
});
if (positionals.length !== 1) {
  console.error('usage: node scripts/measure_live.mjs PROGRAM [--scans N] [--clients N] [--rounds N] [--rate HZ] [--threads N]');
  process.exit(2);
}
const program = path.resolve(positionals[0]);
const [scans, clients, rounds, rate] = ['scans', 'clients', 'rounds', 'rate'].map((name) => Number(values[name]));
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'measure-live-'));
const ticksPerSecond = Number(execFileSync('getconf', ['CLK_TCK'], { encoding: 'utf8' }));
const kWarmUp = 20; // scans: the first ten come at once

/// Puts the scans of the drive into a folder, one after the other, at their rate; those to begin with at once.
async function putScans(into) {
  const names = fs.readdirSync(path.join(folder, 'drive', 'point_clouds')).sort();
  const begin = performance.now();
  for (const [k, name] of names.entries()) {
    await sleep(begin + 1000 * Math.max(0, k - 10) / rate - performance.now());
    for (const kind of ['times', 'point_clouds']) {
      fs.copyFileSync(path.join(folder, 'drive', kind, name), path.join(into, `.${kind}`));
      fs.renameSync(path.join(into, `.${kind}`), path.join(into, kind, name));
    }
  }
}

/// Seconds of processor time of a thread or a process, and its name.
function secondsOf(stat) {
  const [, name, rest] = /^\d+ \((.*)\) (.*)/.exec(fs.readFileSync(stat, 'utf8'));
  const numbers = rest.split(' ');
  return { name, seconds: (Number(numbers[11]) + Number(numbers[12])) / ticksPerSecond };
}

/// What a function gives; null where what it looks at is no longer there.
function ifThere(look) {
  try {
    return look();
  } catch (error) {
    if (['ENOENT', 'ESRCH'].includes(error.code)) return null;
    throw error;
  }
}

/// Of the threads of the live view, and of all others, whether they still run or not; null: the process has ended.
function secondsUsed(pid) {
  const all = ifThere(() => secondsOf(`/proc/${pid}/stat`));
  const threads = ifThere(() => fs.readdirSync(`/proc/${pid}/task`));
  if (!all || !threads) return null;
  const live = threads.map((thread) => ifThere(() => secondsOf(`/proc/${pid}/task/${thread}/stat`)))
    .filter((one) => one?.name.startsWith('live ')).reduce((sum, { seconds }) => sum + seconds, 0);
  return { live, rest: all.seconds - live };
}

/// A client that subscribes to all and does as `kind` says: 'reads', 'never reads' or 'vanishes' after a while. How many
/// messages of points it got, by the time of the scan.
function watch(authority, kind) {
  const points = new Set();
  let isOver = false;
  const open = () => {
    if (isOver) return;
    const socket = new WebSocket(`ws://${authority}/`, ['foxglove.websocket.v1']);
    let pointsId = -1;
    socket.on('error', () => {});
    socket.on('message', (data, isBinary) => {
      if (!isBinary) {
        const message = JSON.parse(data);
        if (message.op !== 'advertise') return;
        pointsId = message.channels.find(({ topic }) => topic === '/points').id;
        socket.send(JSON.stringify({ op: 'subscribe', subscriptions: message.channels.map(({ id }) => ({ id, channelId: id })) }));
        if (kind === 'never reads') socket._socket.pause();
        if (kind === 'vanishes') setTimeout(() => socket.terminate(), 500 + 1500 * Math.random());
      } else if (data[0] === 1 && data.readUInt32LE(1) === pointsId) {
        points.add(data.readBigUInt64LE(5));
      }
    });
    socket.on('close', () => { if (kind === 'vanishes') setTimeout(open, 100); });
    sockets.push(socket);
  };
  const sockets = [];
  open();
  return { points, end: () => { isOver = true; sockets.forEach((socket) => socket.terminate()); } };
}

const quantile = (sorted, part) => sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];

/// One run over the drive as it comes; `kinds` are those of its clients, null: without a live view.
async function measure(kinds) {
  const into = path.join(folder, 'followed');
  const output = path.join(folder, 'run');
  for (const kind of ['times', 'point_clouds']) fs.mkdirSync(path.join(into, kind), { recursive: true });
  const words = ['run', into, '--follow', '--max-frames', String(scans), '--threads', values.threads, '--output', output];
  const child = spawn(program, kinds ? [...words, '--live=0'] : words, { stdio: ['ignore', 'pipe', 'pipe'] });
  const exited = once(child, 'exit');
  const watching = [];
  let told = '';
  let summary = '';
  child.stdout.on('data', (text) => { summary += text; });
  createInterface({ input: child.stderr }).on('line', (line) => {
    told += `${line}\n`;
    const authority = /http:\/\/([\d.]+:\d+)\//.exec(line)?.[1];
    if (authority) kinds.forEach((kind) => watching.push({ kind, ...watch(authority, kind) }));
  });
  const writing = putScans(into);
  let used = secondsUsed(child.pid);
  const load = os.loadavg()[0];
  while (child.exitCode === null && child.signalCode === null) {
    const now = secondsUsed(child.pid);
    if (!now) break;
    used = now.live >= used.live ? now : used; // at the end its threads go first
    await sleep(100);
  }
  await writing;
  const [status] = await exited;
  watching.forEach(({ end }) => end());
  if (status !== 0) throw new Error(`status ${status}: ${told}`);
  const times = fs.readFileSync(path.join(output, 'frames.jsonl'), 'utf8').trim().split('\n')
    .map((line) => JSON.parse(line).ms.total).slice(kWarmUp).sort((a, b) => a - b);
  const record = JSON.parse(fs.readFileSync(path.join(output, 'run.json'), 'utf8'));
  const leftOut = record.warnings.map((text) => /left out (\d+) scans/.exec(text)?.[1]).find((number) => number) ?? 0;
  const reader = watching.find(({ kind }) => kind === 'reads');
  fs.rmSync(into, { recursive: true });
  fs.rmSync(output, { recursive: true });
  return {
    times,
    live: used.live / scans * rate,
    rest: used.rest / scans * rate,
    leftOut: Number(leftOut),
    latency: Number(/^latency +(\d+) ms median/m.exec(summary)?.[1]),
    got: reader ? reader.points.size : null,
    load,
  };
}

const many = Array.from({ length: clients }, (_, k) => ['reads', 'never reads', 'vanishes'][k % 5 === 0 ? 0 : k % 2 ? 1 : 2]);
const cases = [['no live view', null], ['nobody watches', []], ['one page', ['reads']], [`${clients} clients`, many]];
const results = cases.map(() => []);
try {
  execFileSync(program, ['simulate', 'city', '--output', path.join(folder, 'drive'), '--frames', String(scans), '--seed', '4', '--quiet']);
  for (let round = 0; round < rounds; ++round) {
    for (const [k, [name, kinds]] of cases.entries()) {
      process.stderr.write(`round ${round + 1} of ${rounds}: ${name}\n`);
      results[k].push(await measure(kinds));
    }
  }
} finally {
  fs.rmSync(folder, { recursive: true });
}
console.log(`${scans} scans at ${rate} Hz, ${rounds} rounds, ${os.cpus().length} processors, load ${results.flat().map(({ load }) => load.toFixed(1)).join(' ')}`);
console.log(`of ${clients} clients ${['reads', 'never reads', 'vanishes'].map((kind) => `${many.filter((one) => one === kind).length} ${kind}`).join(', ')}\n`);
console.log(`${''.padEnd(16)}${['p50', 'p99', 'p99 ratio', 'latency', 'live', 'rest', 'left out', 'page got'].map((word) => word.padStart(11)).join('')}`);
let reference = null;
for (const [k, [name]] of cases.entries()) {
  const times = results[k].flatMap((one) => one.times).sort((a, b) => a - b);
  const mean = (of) => results[k].reduce((sum, one) => sum + of(one), 0) / rounds;
  reference ??= quantile(times, 0.99);
  const got = results[k].some((one) => one.got !== null) ? `${mean((one) => one.got).toFixed(0)}/${scans}` : '';
  console.log(name.padEnd(16) + [
    `${quantile(times, 0.5).toFixed(1)} ms`, `${quantile(times, 0.99).toFixed(1)} ms`, (quantile(times, 0.99) / reference).toFixed(2),
    `${mean((one) => one.latency).toFixed(0)} ms`, mean((one) => one.live).toFixed(3), mean((one) => one.rest).toFixed(3), mean((one) => one.leftOut).toFixed(1), got,
  ].map((text) => text.padStart(11)).join(''));
}
console.log(`
p50, p99: odometry a scan (ms.total of frames.jsonl). latency: median, from the last byte of a scan to its result. live, rest: share of
one core that the threads of the live view, and all others (odometry, reading), take at this rate: processor time a scan times the rate.
left out: scans the view never showed. page got: messages of points that one page received.`);
