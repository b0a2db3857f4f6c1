// Reading protobuf: https://protobuf.dev/programming-guides/encoding

const VARINT = 0;
const FIXED64 = 1;
const BYTES = 2;
const FIXED32 = 5;

/** A number of 7 bits a byte, the low ones first. Negative ones, of 64 bits, lose nothing that is used here. */
function readVarint(view, at) {
  let value = 0;
  let factor = 1;
  for (let k = 0; k < 10; ++k) {
    const byte = view.getUint8(at + k);
    value += (byte & 127) * factor;
    factor *= 128;
    if (byte < 128) return [value, at + k + 1];
  }
  throw new Error('a number goes on for more than ten bytes');
}

/**
 * The fields of a message, in their order.
 * @param {DataView} view of exactly the message
 * @returns {Generator<[number, number | DataView]>} number of the field; texts, lists and messages are their bytes
 */
export function* fieldsOf(view) {
  for (let at = 0; at < view.byteLength;) {
    const [tag, begin] = readVarint(view, at);
    const kind = tag % 8;
    let value;
    if (kind === VARINT) {
      [value, at] = readVarint(view, begin);
    } else if (kind === FIXED64) {
      [value, at] = [view.getFloat64(begin, true), begin + 8];
    } else if (kind === FIXED32) {
      [value, at] = [view.getUint32(begin, true), begin + 4];
    } else if (kind === BYTES) {
      const [size, from] = readVarint(view, begin);
      if (from + size > view.byteLength) throw new Error('a field goes on behind its message');
      [value, at] = [new DataView(view.buffer, view.byteOffset + from, size), from + size];
    } else {
      throw new Error(`field ${Math.floor(tag / 8)} is of kind ${kind}, which nothing here is`);
    }
    yield [Math.floor(tag / 8), value];
  }
}

/** The last value of each field by its number; what a message leaves out is not there. */
export const valuesOf = (view) => Object.fromEntries(fieldsOf(view));

/** All values of one field. */
export const listOf = (view, wanted) => [...fieldsOf(view)].filter(([number]) => number === wanted).map(([, value]) => value);

/** @param {DataView|undefined} view */
export const textOf = (view) => (view ? new TextDecoder().decode(view) : '');
