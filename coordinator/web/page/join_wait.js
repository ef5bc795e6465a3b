// Ways to wait, for the session of a tab that renders (join_session.js, join_blobs.js).

/// Waiting times in milliseconds that double from 200 ms to 5 s. Each is shortened by a random part of up to one half, so that the
/// tabs do not all connect again at the same moment.
export class Backoff {
  constructor() {
    this.reset();
  }
  reset() {
    this.most = 200;
  }
  next() {
    const wait = this.most * (0.5 + 0.5 * Math.random());
    this.most = Math.min(2 * this.most, 5000);
    return wait;
  }
}

export const pause = (ms) => new Promise((done) => setTimeout(done, ms));

/// A wait that can be ended early.
export class Alarm {
  /// Returns a promise that is fulfilled after `ms` milliseconds, or earlier when ring() is called.
  wait(ms) {
    return new Promise((done) => {
      this.ring = done;
      setTimeout(done, ms);
    });
  }
  ring() {}
}
