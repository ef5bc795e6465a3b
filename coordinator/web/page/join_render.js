// A worker that renders rows of bands, one core. It answers each message {id, call, …} with {id, value} or {id, error};
// `fatal`: the instance cannot be used any more, because it had no memory left or is wrong. While it prepares what it needs
// before the first row, it sends {step: true} now and then.

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
    // The program takes the memory over.
    const answer = program.run("renderer_add_blob", renderer, digest, program.place(data), data.length);
    program.read(answer);
  },
  build: ({scene}) => program.json("renderer_build_scene", renderer, scene),
  drop({scene}) {
    program.bytes("renderer_drop_scene", renderer, scene);
  },
  /// Renders the rows [first, last) of a lease.
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

function problem(error) {
  if (!(error instanceof WebAssembly.RuntimeError) && !(error instanceof RangeError)) return {error: error.message};
  const used = program ? Math.round(program.memory.buffer.byteLength / 1e6) : 0;
  return {fatal: true, error: `the renderer ended with ${used} MB in use, perhaps all that the browser gives: ${error.message}`};
}

// One at a time, in the order of the messages.
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
