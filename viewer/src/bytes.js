// The bytes of scans and maps, as docs/report.md lays them down. Nothing here needs a page.

/** Stands for a value that is not known; far outside of everything measured. */
export const UNKNOWN = -1e9;

const UNKNOWN_DOPPLER = -32768;
const NO_SURFACE = 255;
const RESIDUAL_STEP = 0.005; // m
const DOPPLER_STEP = 0.01; // m/s
const BYTES_PER_POINT = 12;

/** Whether this browser can undo the compression. */
export const canInflate = () => typeof DecompressionStream === 'function';

/** @param {string} text @returns {Uint8Array} */
export function decodeBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** Undoes a zlib stream (RFC 1950). @param {Uint8Array} bytes @returns {Promise<ArrayBuffer>} */
export async function inflate(bytes) {
  const stream = new DecompressionStream('deflate');
  const writer = stream.writable.getWriter();
  // Damaged data make both ends fail; the reader reports it.
  writer.write(bytes).catch(() => {});
  writer.close().catch(() => {});
  return new Response(stream.readable).arrayBuffer();
}

/** Differences back into values, three columns into x y z x y z ..., times the unit. */
function positionsFrom(columns, unit, wrap) {
  const count = columns[0].length;
  const positions = new Float32Array(3 * count);
  columns.forEach((column, axis) => {
    let value = 0;
    for (let i = 0; i < count; ++i) {
      value = wrap(value + column[i]);
      positions[3 * i + axis] = value * unit;
    }
  });
  return positions;
}

function speeds(column) {
  const values = new Float32Array(column.length);
  for (let i = 0; i < column.length; ++i) {
    values[i] = column[i] === UNKNOWN_DOPPLER ? UNKNOWN : column[i] * DOPPLER_STEP;
  }
  return values;
}

function distances(column) {
  const values = new Float32Array(column.length);
  for (let i = 0; i < column.length; ++i) values[i] = column[i] === NO_SURFACE ? UNKNOWN : column[i] * RESIDUAL_STEP;
  return values;
}

/**
 * @typedef {object} Scan
 * @property {number} count
 * @property {Float32Array} positions m, sensor frame, x y z x y z ...
 * @property {Float32Array} doppler m/s
 * @property {Float32Array} compensated m/s or UNKNOWN
 * @property {Uint8Array} label 0 not used, 1 static, 2 dynamic, 3 + k object k
 * @property {Float32Array} residual m or UNKNOWN
 */

/** @param {ArrayBuffer} buffer @returns {Scan} */
export function decodeScan(buffer) {
  const count = buffer.byteLength >= 8 ? new DataView(buffer).getUint32(0, true) : -1;
  if (buffer.byteLength !== 8 + BYTES_PER_POINT * count) {
    throw new Error(`a scan of ${count} points has ${buffer.byteLength} bytes, not ${8 + BYTES_PER_POINT * count}`);
  }
  const unit = new DataView(buffer).getFloat32(4, true);
  const column = (k) => new Int16Array(buffer, 8 + 2 * count * k, count);
  return {
    count,
    positions: positionsFrom([column(0), column(1), column(2)], unit, (value) => (value << 16) >> 16),
    doppler: speeds(column(3)),
    compensated: speeds(column(4)),
    label: new Uint8Array(buffer, 8 + 10 * count, count),
    residual: distances(new Uint8Array(buffer, 8 + 11 * count, count)),
  };
}

/**
 * @param {ArrayBuffer} buffer
 * @returns {{count: number, origin: number[], positions: Float32Array}} positions in m after the origin
 */
export function decodeMap(buffer) {
  const view = new DataView(buffer);
  const count = buffer.byteLength >= 32 ? view.getUint32(0, true) : -1;
  if (buffer.byteLength !== 32 + 12 * count) {
    throw new Error(`a map of ${count} points has ${buffer.byteLength} bytes, not ${32 + 12 * count}`);
  }
  const column = (k) => new Int32Array(buffer, 32 + 4 * count * k, count);
  return {
    count,
    origin: [0, 1, 2].map((axis) => view.getFloat64(8 + 8 * axis, true)),
    positions: positionsFrom([column(0), column(1), column(2)], view.getFloat32(4, true), (value) => value | 0),
  };
}
