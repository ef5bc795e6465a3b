// Loads bandsaw_test.wasm, the renderer as WebAssembly, in node, and calls its functions (tests/wasm/entry.h).
import {readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';

/** Returns the functions of WASI for a module without files, arguments and environment. All except the two below fail. */
function wasi(memory) {
  const refused = 52;  // ENOSYS
  return new Proxy({
    fd_write: (fd, list, count, written) => {
      const view = new DataView(memory().buffer);
      let bytes = 0;
      for (let i = 0; i < count; ++i) {
        const at = view.getUint32(list + 8 * i, true);
        const size = view.getUint32(list + 8 * i + 4, true);
        process.stderr.write(Buffer.from(memory().buffer, at, size));
        bytes += size;
      }
      view.setUint32(written, bytes, true);
      return 0;
    },
    proc_exit: (code) => { throw new Error(`the module ended with status ${code}`); },
  }, {get: (known, name) => known[name] ?? (() => refused)});
}

/** Loads a module, with an implementation for each function of WASI that the module imports, and returns its Renderer. */
export async function load(file) {
  const module = await WebAssembly.compile(readFileSync(file));
  let instance;
  const functions = wasi(() => instance.exports.memory);
  const imports = {};
  for (const {module: from, name} of WebAssembly.Module.imports(module)) {
    (imports[from] ??= {})[name] = functions[name];
  }
  instance = await WebAssembly.instantiate(module, imports);
  instance.exports._initialize();
  return new Renderer(instance.exports);
}

class Renderer {
  constructor(wasm) { this.wasm = wasm; }

  canary() { return hex(this.wasm.bandsaw_canary()); }
  fusedHash() { return hex(this.wasm.bandsaw_fused_hash()); }
  sumsHash() { return hex(this.wasm.bandsaw_sums_hash()); }

  /** Builds the scene of a folder that bandsaw-import wrote. */
  build(folder) {
    for (const name of readdirSync(folder).filter((n) => /^[0-9a-f]{64}$/.test(n))) {
      this.wasm.bandsaw_add_blob(...this.copy(readFileSync(join(folder, name))));
    }
    if (!this.wasm.bandsaw_build(...this.copy(readFileSync(join(folder, 'manifest'))))) {
      throw new Error(`${folder}: ${this.error()}`);
    }
  }

  /** Renders the first samples of all pixels; returns the bytes of the sums. */
  render({width, height, depth, integrator, seed, samples}) {
    const at = this.wasm.bandsaw_render(width, height, depth, integrator, BigInt(seed), BigInt(samples));
    if (at === 0) {
      throw new Error(this.error());
    }
    return Buffer.from(this.wasm.memory.buffer, at, width * height * 3 * 8);
  }

  /** Copies bytes into the module's memory; returns their address and number, the arguments of a call. */
  copy(bytes) {
    const at = this.wasm.bandsaw_memory(bytes.length);
    new Uint8Array(this.wasm.memory.buffer, at, bytes.length).set(bytes);
    return [at, bytes.length];
  }

  error() {
    const bytes = new Uint8Array(this.wasm.memory.buffer);
    const at = this.wasm.bandsaw_error();
    return Buffer.from(bytes.subarray(at, bytes.indexOf(0, at))).toString();
  }
}

const hex = (value) => BigInt.asUintN(64, value).toString(16).padStart(16, '0');
