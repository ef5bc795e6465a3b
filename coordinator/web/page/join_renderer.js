// One core of the tab, for join_session.js: starts a web worker with join_render.js, and keeps account of the scenes that it
// has loaded. A scene is identified by the digest of its manifest; its data come as blobs.

const SCENES = 2;  // loaded at most: in a sequence, those of the present frame and of the next one
const AHEAD = 4;   // number of blobs that are fetched in advance, while the worker copies earlier ones
export const SCENE_PER_BYTE = 4;  // a scene is assumed to take so many times the bytes of its blobs (coordinator/scheduler/README.md)

/// The renderer has ended; another one can be started in its place. `sceneBytes`: the bytes of the blobs of the only scene that
/// it had or was loading; 0: it had no scene, or several.
export class RendererEnded extends Error {
  constructor(why, sceneBytes) {
    super(why);
    this.sceneBytes = sceneBytes;
  }
}

const isOutOfMemory = (error) => error instanceof RangeError || error instanceof WebAssembly.RuntimeError;

export class Renderer {
  /// `module`: the compiled bandsaw.wasm. `memoryBytes`: the memory that its scenes may take.
  constructor(module, memoryBytes) {
    this.memoryBytes = memoryBytes;
    this.scenes = new Map();  // digest of the manifest: {rowStep, size}, the most recently used last
    this.loading = 0;         // bytes of the blobs of a scene that is being loaded, as far as they are known
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

  error() {
    const sizes = [...this.scenes.values()].map(({size}) => size);
    if (this.loading > 0) sizes.push(this.loading);
    return new RendererEnded(this.ended, sizes.length === 1 ? sizes[0] : 0);
  }

  /// Calls a function of join_render.js. Returns a promise of its value; it fails with RendererEnded, or the call's error.
  ask(call, values = {}, moved = []) {
    if (this.ended) return Promise.reject(this.error());
    const id = ++this.lastId;
    const answer = new Promise((done, failed) => this.asked.set(id, {done, failed}));
    this.worker.postMessage({id, call, ...values}, moved);
    return answer;
  }

  has(scene) {
    return this.scenes.has(scene);
  }

  /// Returns a number of rows: bands of the scene should be divided at its multiples. The scene
  /// MUST be loaded; from now on it is the one that was used most recently.
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

  async loadBlobs(scene, get, step) {
    while (this.scenes.size >= SCENES) await this.drop();
    const manifest = await get(scene);
    this.loading = manifest.byteLength;
    let blobs = await this.ask("begin", {scene, manifest});
    const size = manifest.byteLength + blobs.reduce((sum, blob) => sum + blob.size, 0);
    const loaded = [...this.scenes.values()].reduce((sum, one) => sum + one.size, 0);
    if (this.scenes.size > 0 && SCENE_PER_BYTE * (size + loaded) > this.memoryBytes) {
      while (this.scenes.size > 0) await this.drop();
      blobs = await this.ask("begin", {scene, manifest});  // no blobs are shared any more
    }
    this.loading = size;
    const fetched = [];
    const fetchNext = () => {
      if (fetched.length >= blobs.length) return;
      const bytes = get(blobs[fetched.length].digest);
      bytes.catch(() => {});  // a failure is handled where the promise is awaited, below
      fetched.push(bytes);
    };
    for (let i = 0; i < AHEAD; ++i) fetchNext();
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
