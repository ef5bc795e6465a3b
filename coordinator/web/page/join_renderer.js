// One core of the tab, for join_session.js: starts a web worker with join_render.js, and keeps a
// list of the scenes that this web worker has loaded. The data of a scene come as blobs, byte arrays
// that are named by their digests. One of the blobs is the manifest, which names the others. The
// digest of the manifest identifies the scene.

// Maximum number of loaded scenes. While an animation is rendered, they are the scenes of the present
// frame and of the next frame.
const MAX_SCENES = 2;
// Number of blobs that are fetched in advance, while the web worker copies earlier ones.
const BLOBS_AHEAD = 4;
// A scene is assumed to take so many bytes of memory for each byte of its blobs
// (coordinator/scheduler/README.md).
export const MEMORY_PER_BLOB_BYTE = 4;

/// The renderer has ended. Another renderer can be started in its place. `sceneBytes`: the bytes of
/// the blobs of the only scene that the renderer had loaded or was loading. If there was no such
/// scene, or more than one, `sceneBytes` is 0.
export class RendererEnded extends Error {
  constructor(why, sceneBytes) {
    super(why);
    this.sceneBytes = sceneBytes;
  }
}

const isOutOfMemory = (error) => error instanceof RangeError || error instanceof WebAssembly.RuntimeError;

export class Renderer {
  /// `module`: the compiled bandsaw.wasm. `memoryBytes`: the memory that the renderer's scenes may
  /// take.
  constructor(module, memoryBytes) {
    this.memoryBytes = memoryBytes;
    this.scenes = new Map();  // digest of the manifest: {rowStep, size}, the most recently used last
    this.loading = 0;         // known bytes of the blobs of the scene that is being loaded
    this.asked = new Map();   // requests without an answer, id: {done, failed}
    this.lastId = 0;
    this.busy = false;        // set by join_session.js: true while this renderer has work
    this.leaving = false;     // set by join_session.js: true if this renderer is to be ended once it is not busy
    this.step = () => {};     // called after each step of the preparation before the first row
    this.worker = new Worker("/join_render.js", {type: "module"});
    this.worker.onmessage = ({data}) => this.answer(data);
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.end(`the renderer ended: ${event.message || "its file is missing"}`);
    };
    this.started = false;
    this.ready = this.ask("start", {module}).then(() => { this.started = true; });
    this.ready.catch((error) => this.end(error.message));
  }

  /// Handles a message of the web worker: the end of a step, a fatal error, or the answer to a
  /// request.
  answer({id, value, error, fatal, step}) {
    if (step) {
      this.step();
      return;
    }
    if (fatal) {
      this.end(error);
      return;
    }
    const one = this.asked.get(id);
    this.asked.delete(id);
    if (error !== undefined) {
      one?.failed(new Error(error));
    } else {
      one?.done(value);
    }
  }

  /// Ends the web worker. All requests without an answer fail.
  end(why) {
    if (this.ended) return;
    this.ended = why;
    this.worker.terminate();
    for (const one of this.asked.values()) one.failed(this.error());
    this.asked.clear();
  }

  /// Returns the error with which all requests fail after the renderer has ended.
  error() {
    const sizes = [...this.scenes.values()].map(({size}) => size);
    if (this.loading > 0) sizes.push(this.loading);
    return new RendererEnded(this.ended, sizes.length === 1 ? sizes[0] : 0);
  }

  /// Calls a function of join_render.js. Returns a promise of the function's value. The promise
  /// fails with RendererEnded, or with the error of the function. `moved`: buffers of `values` that
  /// move to the web worker instead of being copied.
  ask(call, values = {}, moved = []) {
    if (this.ended) return Promise.reject(this.error());
    const id = ++this.lastId;
    const answer = new Promise((done, failed) => this.asked.set(id, {done, failed}));
    this.worker.postMessage({id, call, ...values}, moved);
    return answer;
  }

  /// Returns true if the scene is loaded. `scene`: the digest of its manifest.
  has(scene) {
    return this.scenes.has(scene);
  }

  /// Returns the row step of the scene: a band should be divided only at rows that are multiples of
  /// this number. Marks the scene as the one that was used last. The scene must be loaded.
  rowStep(scene) {
    const known = this.scenes.get(scene);
    this.scenes.delete(scene);
    this.scenes.set(scene, known);
    return known.rowStep;
  }

  /// Loads a scene. `get`: a function from a digest to a promise of its blob; `step`: called with each step of progress. Fails
  /// with RendererEnded if there is too little memory, with the errors of `get`, or with the error of a wrong scene.
  async load(scene, get, step) {
    await this.ready;
    try {
      await this.loadBlobs(scene, get, step);
    } catch (error) {
      if (!isOutOfMemory(error)) throw error;
      this.end(`the browser gives no memory for the scene: ${error.message}`);
      throw this.error();
    } finally {
      this.loading = 0;
    }
  }

  /// Does the work of load(). First drops other scenes, until there is a place and memory for the
  /// new scene.
  async loadBlobs(scene, get, step) {
    while (this.scenes.size >= MAX_SCENES) await this.drop();
    const manifest = await get(scene);
    this.loading = manifest.byteLength;
    let blobs = await this.ask("begin", {scene, manifest});
    const size = manifest.byteLength + blobs.reduce((sum, blob) => sum + blob.size, 0);
    const loaded = [...this.scenes.values()].reduce((sum, one) => sum + one.size, 0);
    if (this.scenes.size > 0 && MEMORY_PER_BLOB_BYTE * (size + loaded) > this.memoryBytes) {
      while (this.scenes.size > 0) await this.drop();
      // Now `blobs` also has the blobs that this scene shared with a dropped scene.
      blobs = await this.ask("begin", {scene, manifest});
    }
    this.loading = size;
    const fetched = [];
    const fetchNext = () => {
      if (fetched.length >= blobs.length) return;
      const bytes = get(blobs[fetched.length].digest);
      bytes.catch(() => {});  // the loop below awaits the promise and handles its error
      fetched.push(bytes);
    };
    for (let i = 0; i < BLOBS_AHEAD; ++i) fetchNext();
    for (let i = 0; i < blobs.length; ++i) {
      const bytes = await fetched[i];
      fetched[i] = null;
      fetchNext();
      await this.ask("blob", {digest: blobs[i].digest, bytes});
      step();
    }
    const {row_step: rowStep} = await this.ask("build", {scene});
    this.scenes.set(scene, {rowStep, size});
    this.loading = 0;
    step();
  }

  /// Drops the scene that was used least recently.
  async drop() {
    const [scene] = this.scenes.keys();
    this.scenes.delete(scene);
    await this.ask("drop", {scene});
  }
}
