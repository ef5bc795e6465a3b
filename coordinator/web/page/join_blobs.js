// Fetches the blobs of scenes (byte arrays, named by their SHA-256) for a tab that renders, and checks their digests.

import {Backoff, pause} from "/join_wait.js";

// Maximum number of bytes of the blobs that are kept. Blobs are kept because several renderers load
// the same scene at about the same time.
const KEPT_BYTES = 64 * 2 ** 20;
// Fetching a blob fails when this number of answers had wrong bytes, because then the coordinator's
// copy must be wrong.
const WRONG_TIMES = 3;

/// The link has ended or was revoked.
export class LinkEnded extends Error {}
/// The request has failed, and would fail again.
export class Final extends Error {}

const hex = (bytes) => Array.from(bytes, (one) => one.toString(16).padStart(2, "0")).join("");

/// Returns the sentence that reports an error in the body of an HTTP answer. If the body is not
/// {"error": sentence} in JSON, returns the whole body.
export function sentence(text) {
  try {
    return JSON.parse(text).error;
  } catch {
    return text;
  }
}

export class Blobs {
  /// `sha256`: a function from bytes to a promise of their digest, 32 bytes.
  constructor(base, secret, sha256) {
    Object.assign(this, {base, secret, sha256});
    this.kept = new Map();  // digest: {promise, size}, the most recently used last
    this.bytes = 0;
  }

  headers() {
    return {Authorization: `Bearer ${this.secret}`};
  }

  /// Returns a promise of a blob's bytes. A failed request is repeated, as long as `wanted()` is
  /// true. `took`: called with the number of bytes of each piece that arrives. The promise fails
  /// with Final, with LinkEnded, or with a RangeError if there is no memory for the blob.
  get(digest, wanted, took) {
    const known = this.kept.get(digest);
    if (known) {
      this.kept.delete(digest);
      this.kept.set(digest, known);
      return known.promise;
    }
    const entry = {promise: this.fetch(digest, wanted, took), size: 0};
    this.kept.set(digest, entry);
    entry.promise.then(
      (bytes) => {
        entry.size = bytes.byteLength;
        this.bytes += entry.size;
        this.makeRoom();
      },
      () => this.kept.delete(digest));
    return entry.promise;
  }

  /// Forgets the blobs that were used least recently, until KEPT_BYTES or less are kept.
  makeRoom() {
    for (const [digest, {size}] of this.kept) {
      if (this.bytes <= KEPT_BYTES) return;
      if (size === 0) continue;  // still being fetched
      this.bytes -= size;
      this.kept.delete(digest);
    }
  }

  /// Makes requests until the blob has arrived with the right digest. The parameters and the errors
  /// are those of get().
  async fetch(digest, wanted, took) {
    const backoff = new Backoff();
    for (let wrong = 0;;) {
      const bytes = await this.once(digest, wrong > 0, took).catch((error) => {
        if (error instanceof Final || error instanceof LinkEnded || error instanceof RangeError) throw error;
        return null;
      });
      if (bytes) {
        if (hex(await this.sha256(bytes)) === digest) return bytes.buffer;
        if (++wrong === WRONG_TIMES) throw new Final(`blob ${digest} arrives with wrong bytes`);
        continue;
      }
      if (!wanted()) throw new Final("the scene is not wanted any more");
      await pause(backoff.next());
    }
  }

  /// Makes one request and returns the bytes. `again`: the browser's cache is not used, because the
  /// bytes in the cache may be wrong. If a repeated request would fail too, throws Final or LinkEnded.
  /// Otherwise throws another Error.
  async once(digest, again, took) {
    const response = await fetch(`${this.base}/join/blob/${digest}`, {headers: this.headers(), cache: again ? "reload" : "default"});
    if (response.status === 401) throw new LinkEnded(sentence(await response.text()));
    if (response.status >= 400 && response.status < 500 && response.status !== 429) {
      throw new Final(`blob ${digest}: ${sentence(await response.text())}`);
    }
    if (!response.ok) throw new Error(`the coordinator answered ${response.status}`);
    const pieces = [];
    let size = 0;
    for (const reader = response.body.getReader();;) {
      const {done, value} = await reader.read();
      if (done) break;
      pieces.push(value);
      size += value.length;
      took(value.length);
    }
    const bytes = new Uint8Array(size);
    pieces.reduce((at, piece) => (bytes.set(piece, at), at + piece.length), 0);
    return bytes;
  }
}
