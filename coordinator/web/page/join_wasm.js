// Runs bandsaw.wasm, the renderer compiled to WebAssembly, and calls its functions (worker/browser/exports.h).

const BAD_FILE = 8;  // errno values of WASI, the system interface of WebAssembly
const NOT_SUPPORTED = 58;

/// Returns the functions of WASI that the program may call. They give the program a console, clocks
/// and random numbers, but no files. `memory`: a function that returns the instance's memory.
function system(memory) {
  const view = () => new DataView(memory().buffer);
  const empty = (count, size) => {
    view().setUint32(count, 0, true);
    view().setUint32(size, 0, true);
    return 0;
  };
  return {
    args_sizes_get: empty,
    args_get: () => 0,
    environ_sizes_get: empty,
    environ_get: () => 0,
    clock_time_get(clock, precision, at) {
      const ms = clock === 0 ? Date.now() : performance.now();
      view().setBigUint64(at, BigInt(Math.round(ms * 1e6)), true);
      return 0;
    },
    random_get(at, size) {
      crypto.getRandomValues(new Uint8Array(memory().buffer, at, size));
      return 0;
    },
    fd_write(file, pieces, count, written) {
      let text = "";
      let size = 0;
      for (let i = 0; i < count; ++i) {
        const at = view().getUint32(pieces + 8 * i, true);
        const length = view().getUint32(pieces + 8 * i + 4, true);
        text += new TextDecoder().decode(new Uint8Array(memory().buffer, at, length));
        size += length;
      }
      view().setUint32(written, size, true);
      console.warn(text.trimEnd());
      return 0;
    },
    fd_prestat_get: () => BAD_FILE,
    proc_exit(code) {
      throw new WebAssembly.RuntimeError(`the program ended with code ${code}`);
    },
  };
}

/// Returns the functions that the module imports. An imported function that is not known here
/// returns NOT_SUPPORTED when it is called. `memory`: as for system(). `step`: as for
/// Program.start().
function imports(module, memory, step) {
  const known = {...system(memory), step};
  const out = {};
  for (const {module: from, name, kind} of WebAssembly.Module.imports(module)) {
    if (kind !== "function") throw new Error(`bandsaw.wasm wants ${from}.${name}, which a page does not have`);
    (out[from] ??= {})[name] = known[name] ?? (() => NOT_SUPPORTED);
  }
  return out;
}

/// One instance of the module.
export class Program {
  /// Returns a promise of a new instance. `step`: called by the renderer after each step of its
  /// preparation before the first row.
  static async start(module, step = () => {}) {
    const program = new Program();
    const instance = await WebAssembly.instantiate(module, imports(module, () => program.memory, step));
    program.functions = instance.exports;
    program.memory = instance.exports.memory;
    program.functions._initialize?.();
    return program;
  }

  /// Copies the bytes into the memory of the instance, and returns the address of the copy.
  place(bytes) {
    const at = this.functions.bandsaw_allocate(bytes.length) >>> 0;
    new Uint8Array(this.memory.buffer, at, bytes.length).set(bytes);
    return at;
  }

  /// Calls the function `bandsaw_NAME` and returns its result. A number among the arguments is
  /// passed unchanged. A text or bytes are passed as the address and the length of a copy.
  run(name, ...args) {
    const placed = [];
    const flat = args.flatMap((arg) => {
      if (typeof arg === "number") return [arg];
      const bytes = typeof arg === "string" ? new TextEncoder().encode(arg) : arg;
      placed.push(this.place(bytes));
      return [placed.at(-1), bytes.length];
    });
    const result = this.functions[`bandsaw_${name}`](...flat);
    placed.forEach((at) => this.functions.bandsaw_free(at));
    return result;
  }

  /// Returns a copy of the bytes of a BandsawAnswer, or throws them as an error. `answer`: the
  /// address of the BandsawAnswer. This is three 32-bit words: the address of the bytes, their
  /// number, and 1 if they are the text of an error.
  read(answer) {
    const view = new DataView(this.memory.buffer);
    const at = answer >>> 0;
    const bytes = new Uint8Array(this.memory.buffer, view.getUint32(at, true), view.getUint32(at + 4, true)).slice();
    if (view.getUint32(at + 8, true)) throw new Error(new TextDecoder().decode(bytes));
    return bytes;
  }

  // The next three functions call the function `bandsaw_NAME` as run() does. They return its answer as bytes,
  // as text or as parsed JSON. If the answer is an error, they throw it.
  bytes(name, ...args) {
    return this.read(this.run(name, ...args));
  }
  text(name, ...args) {
    return new TextDecoder().decode(this.bytes(name, ...args));
  }
  json(name, ...args) {
    return JSON.parse(this.text(name, ...args));
  }
}

export const fromBase64 = (text) => Uint8Array.from(atob(text), (one) => one.charCodeAt(0));
