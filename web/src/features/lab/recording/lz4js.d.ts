declare module 'lz4js' {
  /** The content of an LZ4 frame, at most `maxSize` bytes. */
  export function decompress(frame: Uint8Array, maxSize?: number): Uint8Array;
  /** An LZ4 frame. */
  export function compress(content: Uint8Array): Uint8Array;
}
