// Compares the speed of the renderer as WebAssembly in node with that of one native core, for the same image. Run by hand.
// Prints for each scene the CPU seconds of both, and the ratio of the native seconds to those of WebAssembly.
// Usage: node speed.mjs MODULE.wasm BIN SCENE.textproto…
import {basename} from 'node:path';
import {importScene, inTemporaryFolder, renderNatively} from './native.mjs';
import {load} from './module.mjs';

const [file, bin, ...scenes] = process.argv.slice(2);
const times = 5;  // the fastest counts

console.log('scene        native s   wasm s   ratio');
for (const scene of scenes) {
  await inTemporaryFolder(async (folder) => {
    const module = await load(file);
    module.build(importScene(bin, scene, folder));
    let native = Infinity;
    let wasm = Infinity;
    for (let i = 0; i < times; ++i) {
      const band = renderNatively(bin, scene, folder, {width: 272, height: 204, samples: 8});
      native = Math.min(native, band.cpuSeconds);
      const begin = process.cpuUsage();
      module.render(band.settings);
      wasm = Math.min(wasm, process.cpuUsage(begin).user / 1e6);
    }
    console.log(basename(scene, '.textproto').padEnd(12), native.toFixed(3).padStart(8), wasm.toFixed(3).padStart(8),
      (native / wasm).toFixed(2).padStart(7));
  });
}
