// Tests that the renderer as WebAssembly gives the bits of the native programs.
// Usage: node run.mjs bits|gallery MODULE.wasm BIN GALLERY SAME_BITS NATIVE
//   bits     The module must compute the same two hashes as the program NATIVE: the canary (the hash of a small image) and the
//            hash of the results of many fused multiply-adds, which WebAssembly emulates.
//   gallery  Every scene of the folder GALLERY is rendered 48 pixels wide. The sums of its pixels must have the bits of
//            BIN/bandsaw render. The file SAME_BITS lists thirteen scenes, each with a hash. The sums of these scenes must have
//            the listed hashes.
// Exit status: 0 all is equal, 1 something differs, 77 the file of the module is missing.
import {execFileSync} from 'node:child_process';
import {existsSync, readFileSync, readdirSync} from 'node:fs';
import {basename, join} from 'node:path';
import {importScene, inTemporaryFolder, renderNatively} from './native.mjs';
import {load} from './module.mjs';

const [part, file, bin, gallery, sameBits, native] = process.argv.slice(2);
if (!existsSync(file)) {
  console.log(`SKIPPED: ${file} was not built: run deploy/wasm.sh`);
  process.exit(77);
}
let failures = 0;
function check(what, found, wanted) {
  const equal = found === wanted;
  failures += equal ? 0 : 1;
  console.log(`${equal ? 'ok   ' : 'WRONG'} ${what}${equal ? '' : `: ${found}, native ${wanted}`}`);
}

/** Compares the bytes of two arrays of doubles; returns 'equal' or the place of the first difference. */
function firstDifference(a, b) {
  const at = a.findIndex((byte, i) => byte !== b[i]);
  return a.length !== b.length ? `${a.length} bytes` : at < 0 ? 'equal' : `the first different sum is number ${at >> 3}`;
}

async function checkBits() {
  const module = await load(file);
  const [canary, fused] = execFileSync(native, {encoding: 'utf8'}).trim().split(' ');
  check('hash of fused products', module.fusedHash(), fused);
  check('canary', module.canary(), canary);
}

async function checkScene(scene, folder, hashes) {
  const name = scene.slice(gallery.length + 1).replace(/\.textproto$/, '');
  const {settings, sums} = renderNatively(bin, scene, folder, {width: 48, height: 36, samples: 8});
  const parts = importScene(bin, scene, folder);
  const module = await load(file);  // a new memory for each scene
  module.build(parts);
  check(scene.slice(gallery.length + 1), firstDifference(module.render(settings), sums), 'equal');
  if (hashes.has(name)) {
    module.render({...settings, width: 20, height: 15, seed: 7, samples: 16});  // as tests/hard_cases/same_bits_test.cpp
    check(`${name}, the hash of ${basename(sameBits)}`, module.sumsHash(), hashes.get(name));
    hashes.delete(name);
  }
}

async function checkGallery() {
  const lines = readFileSync(sameBits, 'utf8').trim().split('\n').slice(1);
  const hashes = new Map(lines.map((line) => line.split(/\s+/)));
  const scenes = readdirSync(gallery, {recursive: true}).filter((name) => name.endsWith('.textproto')).sort();
  check('number of scenes', scenes.length > 70, true);
  for (const name of scenes) {
    await inTemporaryFolder((folder) => checkScene(join(gallery, name), folder, hashes));
  }
  check(`scenes of ${basename(sameBits)} that the gallery lacks`, [...hashes.keys()].join(' '), '');
}

await (part === 'bits' ? checkBits() : checkGallery());
process.exit(failures === 0 ? 0 : 1);
