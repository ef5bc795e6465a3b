// A web worker that renders rows of bands on one core, with one instance of bandsaw.wasm. A band is a
// range of rows and samples of an image. A lease is the message by which the coordinator gives a band
// to this tab.
//
// join_renderer.js starts the web worker. The web worker answers each message {id, call, …} with
// {id, value}, {id, error} or {id, error, fatal: true}. After `fatal` the instance cannot be used any
// more: it had no memory left, or it has crashed. Before the first row of a scene, the renderer
// prepares data. After each step of this preparation the web worker sends {step: true}.

import {Program} from "/join_wasm.js";

let program;
let renderer;

const calls = {
  async start({module}) {
    program = await Program.start(module, () => postMessage({step: true}));
    renderer = program.run("renderer_new");
  },
  /// Returns the blobs that the scene needs: [{digest, size}…].
  begin: ({scene, manifest}) => program.json("renderer_begin_scene", renderer, scene, new Uint8Array(manifest)),
  blob({digest, bytes}) {
    const data = new Uint8Array(bytes);
    // The renderer takes the ownership of the memory. So place() is called here, and not by run(), which would free the memory.
    const answer = program.run("renderer_add_blob", renderer, digest, program.place(data), data.length);
    program.read(answer);
  },
  build: ({scene}) => program.json("renderer_build_scene", renderer, scene),
  drop({scene}) {
    program.bytes("renderer_drop_scene", renderer, scene);
  },
  /// Renders the rows [first, last) of the band of a lease. Returns `sums` (the sums of the samples of
  /// each pixel), `counters` (for the coordinator), `seconds` (the rendering time) and `rgb`. If
  /// `picture` is true, `rgb` has the rows as RGBA bytes for the page, otherwise it is null.
  render({lease, first, last, picture}) {
    const began = performance.now();
    const sums = program.bytes("renderer_render", renderer, lease, first, last).buffer;
    const seconds = (performance.now() - began) / 1000;
    const counters = program.bytes("renderer_counters", renderer);
    const rgb = picture ? new Uint8ClampedArray(program.bytes("renderer_picture", renderer).buffer) : null;
    return {sums, counters, seconds, rgb};
  },
};

/// Returns the buffers that move to the receiver instead of being copied.
const moved = (value) => [value?.sums, value?.rgb?.buffer].filter((one) => one);

/// Returns the fields {error} or {fatal, error} of the answer to a call that threw `error`. A
/// RuntimeError or a RangeError is fatal: the instance has crashed or had no memory left.
function problem(error) {
  if (!(error instanceof WebAssembly.RuntimeError) && !(error instanceof RangeError)) return {error: error.message};
  const used = program ? Math.round(program.memory.buffer.byteLength / 1e6) : 0;
  return {fatal: true, error: `the renderer ended with ${used} MB in use, ` +
    `perhaps all the memory that the browser gives: ${error.message}`};
}

// The messages are processed one at a time, in their order.
let last = Promise.resolve();
onmessage = ({data}) => {
  last = last.then(async () => {
    try {
      const value = await calls[data.call](data);
      postMessage({id: data.id, value}, moved(value));
    } catch (error) {
      postMessage({id: data.id, ...problem(error)});
    }
  });
};
