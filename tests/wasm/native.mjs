// Runs the native programs bandsaw and bandsaw-import, for comparison with the renderer as WebAssembly.
import {execFileSync} from 'node:child_process';
import {mkdirSync, mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

/** Calls `body` with a new folder, and then removes the folder. */
export async function inTemporaryFolder(body) {
  const folder = mkdtempSync(join(tmpdir(), 'bandsaw-wasm-'));
  try {
    await body(folder);
  } finally {
    rmSync(folder, {recursive: true});
  }
}

/** Writes the scene's package to a new folder in `folder`, and returns the path of the new folder. */
export function importScene(bin, scene, folder) {
  const parts = join(folder, 'package');
  mkdirSync(parts);
  // The last two arguments limit the import: 600 s of CPU time and 4 GB of memory.
  execFileSync(join(bin, 'bandsaw-import'), ['scene', scene, parts, '600', '4000000000'], {stdio: ['ignore', 'ignore', 'inherit']});
  return parts;
}

/** Renders the first samples of all pixels on one thread; returns the settings, the bytes of the sums, and the CPU seconds. */
export function renderNatively(bin, scene, folder, {width, height, samples}) {
  const band = join(folder, 'image.band');
  const report = join(folder, 'report.json');
  execFileSync(join(bin, 'bandsaw'), ['render', scene, '--width', String(width), '--height', String(height),
    '--samples', String(samples), '--rows', `0:${height}`, '--threads', '1', '--report', report, '--quiet', '-o', band], {stdio: ['ignore', 'ignore', 'inherit']});
  return {...readBand(band), cpuSeconds: JSON.parse(readFileSync(report)).time.cpu_s};
}

/** Returns the settings and the sums of the one record of a file that bandsaw render --rows wrote (renderlib/render/band_file.h). */
function readBand(path) {
  const bytes = readFileSync(path);
  const record = bytes.subarray(bytes.indexOf('BSWBAND4'));
  const size = Number(record.readBigUInt64LE(8));
  const after = 16 + 64;  // mark, size, and the digest of the scene in hexadecimal
  const width = record.readUInt32LE(after);
  const height = record.readUInt32LE(after + 4);
  const sums = width * height * 3 * 8;
  if (record.length !== size) {
    throw new Error(`${path}: more than one record`);
  }
  return {settings: {width, height, depth: record.readUInt16LE(after + 8), integrator: record.readUInt16LE(after + 10),
    seed: record.readBigUInt64LE(after + 12), samples: record.readBigUInt64LE(after + 28)},
    sums: record.subarray(size - 8 - sums, size - 8)};
}
