// What writers of MCAP write to.

/** Keeps what is written in memory. */
export class Buffered {
  pieces = [];
  size = 0n;
  async write(bytes) {
    this.pieces.push(Buffer.from(bytes));
    this.size += BigInt(bytes.byteLength);
  }
  position() {
    return this.size;
  }
  bytes() {
    return Buffer.concat(this.pieces);
  }
}
