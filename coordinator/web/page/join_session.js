// The web worker that has the tab's session with the coordinator; join_engine.js starts it. A band is a range of rows and
// samples of a job's image, which the coordinator has leased to this tab. This worker passes the rows of bands to renderers
// (join_renderer.js), one for each core, and sends the finished bands. Its timers are not slowed when the tab is hidden, and it
// never computes for long, so that heartbeats go on.

import {Blobs, Final, LinkEnded, sentence} from "/join_blobs.js";
import {Renderer, RendererEnded, MEMORY_PER_BLOB_BYTE} from "/join_renderer.js";
import {Alarm, Backoff} from "/join_wait.js";
import {Program, fromBase64} from "/join_wasm.js";

const PIECE_S = 0.1;            // rendering time of the rows that a renderer is given at once
const RATE_OVER_S = 8;          // samplesPerSecond is the mean over this time
const STATE_EVERY_MS = 200;     // the page gets the state at most this often
const REPORT_CORES_MS = 1000;   // time from a change of the cores to the report
const SILENCE_MS = 15000;       // after this silence, tests if the coordinator answers HTTP
const ANSWER_MS = 10000;        // time limit for the HTTP answer in this test
const FULL_DISK_MS = 5000;      // wait if the coordinator's disk is full
// A finished band is given up if it is refused more often than this with the status 403 or 409. Some
// refusals are normal: a restarted coordinator refuses a band until it has leased the band to this tab
// again.
const MAX_REFUSALS = 20;
const LOG_LINES = 50;

const alarm = new Alarm();      // rings when the coordinator has admitted this tab
const connectBackoff = new Backoff();
const sendBackoff = new Backoff();

let options;
let program;
let session;                    // address of the BandsawSession (worker/browser/exports.h)
let module;                     // compiled bandsaw.wasm
let blobs;
let socket = null;
let reconnecting = null;        // timer
let beating = null;             // timer
let connected = false;          // the coordinator has admitted this tab on the present stream
let heardAt = 0;                // performance.now() of the last message
let pausedWhy = null;           // a sentence; null: not paused
let dismissed = null;           // {reason, until}; until (ms): time when the tab may join again
let mostSceneMemory = Infinity; // limit of memoryBytes, after a scene was too large for a renderer
let tooLarge = null;            // the sentence that the page shows about the last such scene
let over = false;
let renderers = [];
const tasks = new Map();        // the bands that are held, in the order of their leases
const secondsPerRow = new Map();  // by job
let outgoing = [];              // finished bands
let sending = false;
let lastEnd = 0;                // seconds, when the last band was finished
const pieces = [];              // the rendering of the last rows: {began, at, samples}, from time `began` to `at`
const newLines = [];            // of the log, to be sent after the next heartbeat
const lastLines = [];           // of the log, to be sent with a failed band

/// The state that the page shows. Phases: "starting"; "connecting"; "waiting" (this tab holds no band), "loading" (a scene),
/// "rendering"; "pausing" (the bands that this tab holds are finished), "paused"; at the end "stopped" or "failed". `text`: a
/// sentence about the phase.
const state = {phase: "starting", text: "Loading the renderer …", rowsDone: 0, bandsDone: 0, samplesPerSecond: 0, job: 0, width: 0,
  height: 0, name: "", cores: 0, memoryBytes: 0};

// ---- The state that the page shows. ----

let shownAt = 0;
let showing = null;

/// Sends the state to the page: at once if `now` is true, otherwise when STATE_EVERY_MS have passed
/// since the last time. Repeats this while samplesPerSecond is above 0, because the page must see
/// the rate fall to 0 when no more rows are rendered.
function show(now = false) {
  if (over) return;
  const due = shownAt + STATE_EVERY_MS - performance.now();
  if (!now && due > 0) {
    showing ??= setTimeout(() => show(true), due);
    return;
  }
  clearTimeout(showing);
  showing = null;
  shownAt = performance.now();
  const since = shownAt / 1000 - RATE_OVER_S;
  while (pieces.length > 0 && pieces[0].at < since) pieces.shift();
  const span = pieces.length > 0 ? Math.max(1, shownAt / 1000 - pieces[0].began) : 1;
  state.samplesPerSecond = Math.round(pieces.reduce((sum, one) => sum + one.samples, 0) / span);
  postMessage({...state});
  if (state.samplesPerSecond > 0) showing = setTimeout(() => show(true), STATE_EVERY_MS);
}

function setPhase(phase, text) {
  if (state.phase === phase && state.text === text) return;
  Object.assign(state, {phase, text});
  show(true);
}

/// Sets the phase of the state from what the session does now.
function updatePhase() {
  if (over) return;
  const held = tasks.size;
  const rendering = [...tasks.values()].some((task) => task.rowsGiven > task.first);
  if (pausedWhy) {
    if (held > 0) setPhase("pausing", `${pausedWhy} The rows that this tab has begun are finished first.`);
    else setPhase("paused", pausedWhy);
  } else if (!connected) {
    setPhase("connecting", state.phase === "connecting" ? state.text : "Connecting to the coordinator …");
  } else if (rendering) {
    setPhase("rendering", "Rendering.");
  } else if (held > 0) {
    setPhase("loading", "Loading the scene …");
  } else {
    setPhase("waiting", `Connected. ${tooLarge ?? "There is nothing to render now."}`);
  }
}

/// Adds a line with the present time to the log of this tab.
function log(text) {
  const line = `${new Date().toISOString()} ${text}`;
  for (const lines of [newLines, lastLines]) {
    lines.push(line);
    if (lines.length > LOG_LINES) lines.shift();
  }
}

/// Ends the engine: this tab renders no more. `phase`: "stopped" or "failed".
function end(phase, text) {
  if (over) return;
  setPhase(phase, text);
  over = true;
  clearTimeout(reconnecting);
  clearInterval(beating);
  socket?.close(1000);
  renderers.forEach((renderer) => renderer.end("the tab has left"));
}

// ---- The stream. ----

const send = (bytes) => {
  if (bytes.length > 0 && socket?.readyState === WebSocket.OPEN) socket.send(bytes);
};

/// Opens the stream to the coordinator, a WebSocket. Does nothing if there is a stream, or if a
/// pause has begun and all held bands are finished and sent.
function connect() {
  clearTimeout(reconnecting);
  reconnecting = null;
  if (over || socket || isDrained()) return;
  const mine = new WebSocket(`${options.base.replace(/^http/, "ws")}/join/session`, ["bandsaw.1", `bandsaw.secret.${options.secret}`]);
  mine.binaryType = "arraybuffer";
  let opened = false;
  mine.onopen = () => {
    opened = true;
    heardAt = performance.now();
    mine.send(program.bytes("session_hello", session));
  };
  mine.onmessage = ({data}) => {
    if (mine === socket) receive(new Uint8Array(data));
  };
  mine.onclose = ({code, reason}) => {
    if (mine === socket) disconnected(code, reason, opened);
  };
  socket = mine;
}

/// Ends the present stream, and opens another one.
function reconnect() {
  const old = socket;
  socket = null;
  lost();
  old?.close(1000);
  connect();
}

/// Updates the session after the stream has ended. The session keeps its bands.
function lost() {
  connected = false;
  clearInterval(beating);
  program.bytes("session_disconnected", session);
  updatePhase();
}

/// Handles the end of the stream. If the link by which this tab joined has ended, ends the engine.
/// Otherwise connects again later. `code`, `reason`: those of the WebSocket's end; 4401 means that the link has ended.
/// `opened`: whether the stream was open before.
async function disconnected(code, reason, opened) {
  socket = null;
  lost();
  if (over) return;
  if (code === 4401) {
    end("stopped", reason || "The link has ended.");
    return;
  }
  if (!opened && await linkEnded()) return;
  if (over || socket || isDrained()) return;
  if (reason) log(`the coordinator closed the connection: ${reason}`);
  const wait = dismissed ? dismissed.until - Date.now() : 0;
  const why = wait > 0 ? `The coordinator does not take this tab now: ${dismissed.reason}`
    : reason ? `The coordinator has ended the connection (${reason}). Trying again …`
    : "The coordinator cannot be reached. Trying again …";
  setPhase(pausedWhy ? "pausing" : "connecting", why);
  reconnecting = setTimeout(connect, Math.max(connectBackoff.next(), wait));
}

/// Asks the coordinator by HTTP if the link is still valid. If the link has ended, ends the engine and returns true. If the
/// coordinator gives any other answer, calls `reached` and returns false. Without an answer, returns false.
async function linkEnded(reached = () => {}) {
  try {
    const answer = await fetch(`${options.base}/join/about`,
      {headers: blobs.headers(), cache: "no-store", signal: AbortSignal.timeout(ANSWER_MS)});
    if (answer.status === 401) {
      end("stopped", sentence(await answer.text()));
      return true;
    }
    reached();
  } catch {
    // The coordinator cannot be reached.
  }
  return false;
}

/// Handles a message of the coordinator, and does what the session orders in return.
function receive(message) {
  heardAt = performance.now();
  let orders;
  try {
    orders = program.json("session_receive", session, message);
  } catch (error) {
    log(error.message);
    socket.close(4000, "bytes that are not a message");
    return;
  }
  for (const task of orders.stop) drop(task);
  for (const bytes of orders.send) send(fromBase64(bytes));
  if (!connected) welcomed();
  if (orders.start) take(orders.start);
  if (orders.dismissal) dismiss(orders.dismissal);
  updatePhase();
}

/// Begins heartbeats and wakes sendBands() if the coordinator has admitted this tab.
function welcomed() {
  const now = program.json("session_state", session);
  if (!now.connected) return;
  connected = true;
  state.name = now.name;
  connectBackoff.reset();
  sendBackoff.reset();
  log(`joined as ${now.name}`);
  clearInterval(beating);
  beating = setInterval(beat, now.heartbeat_ms);
  alarm.ring();
  leaveIfDrained();
}

/// Handles the coordinator's order to leave: ends the engine if the tab may never join again, otherwise closes the stream.
/// disconnected() opens the next stream after the waiting time.
function dismiss({reason, wait_ms: wait, for_ever: forEver}) {
  log(`dismissed: ${reason}`);
  if (forEver) {
    end("stopped", `The coordinator has sent this tab away: ${reason}`);
    return;
  }
  dismissed = {reason, until: Date.now() + wait};
  socket?.close(1000);
}

/// Sends a heartbeat and the new lines of the log. If nothing was heard for SILENCE_MS, asks by
/// HTTP if the coordinator can be reached. Without an answer the stream is dead, and another one is
/// opened.
function beat() {
  if (!connected) return;
  send(program.bytes("session_heartbeat", session));
  if (newLines.length > 0) send(program.bytes("session_log", session, newLines.splice(0).join("\n")));
  if (performance.now() - heardAt > SILENCE_MS) {
    heardAt = performance.now() + ANSWER_MS;  // so that no second request is made meanwhile
    let there = false;
    linkEnded(() => { there = true; }).then((ended) => there || ended || over || reconnect());
  }
}

// ---- Rendering. ----

/// Begins a band. `start`: {task, job, manifest, width, height, first, last, samples, lease}. `task` is the band's id in this tab,
/// `first` and `last` are its range of rows, and `samples` is the number of samples of all its pixels together.
function take(start) {
  log(`leased job=${start.job} rows=${start.first}:${start.last}`);
  tooLarge = null;
  tasks.set(start.task, {...start, id: start.task, scene: start.manifest, lease: fromBase64(start.lease), rowsGiven: start.first,
    rowsDone: 0, parts: [], began: 0, seconds: 0, prepared: 0});
  Object.assign(state, {job: start.job, width: start.width, height: start.height});
  pump();
}

/// Forgets a band that is not wanted any more, or has failed.
function drop(id) {
  tasks.delete(id);
  outgoing = outgoing.filter((band) => band.task.id !== id);
  if (tasks.size === 0) state.job = 0;
}

/// Reports to the coordinator that this tab cannot render a band, and forgets it.
function fail(task, reason) {
  if (tasks.get(task.id) !== task) return;
  drop(task.id);
  log(`failed job=${task.job} rows=${task.first}:${task.last}: ${reason}`);
  send(program.bytes("session_failed", session, task.id, reason, lastLines.join("\n")));
  leaveIfDrained();
  updatePhase();
}

/// Gives work to the renderers that have none.
function pump() {
  for (const renderer of renderers) {
    if (renderer.busy || renderer.leaving) continue;
    const task = [...tasks.values()].find((one) => one.rowsGiven < one.last);
    if (!task) return;
    renderer.busy = true;
    const work = renderer.has(task.scene) ? renderRows(renderer, task) : loadScene(renderer, task);
    work.catch((error) => failed(renderer, task, error)).then(() => {
      renderer.busy = false;
      if (renderer.ended) replace(renderer);
      if (renderer.leaving) renderer.end("fewer cores are wanted");
      updatePhase();
      pump();
    });
  }
}

/// Handles an error of a renderer that was loading the scene of a band, or rendering rows of it.
function failed(renderer, task, error) {
  if (error instanceof LinkEnded) {
    end("stopped", error.message);
    return;
  }
  const isTooLarge = error instanceof RendererEnded && error.sceneBytes > 0;
  // If blobs are wrong or the scene is too large, no band of the scene can be rendered here.
  for (const one of [...tasks.values()]) {
    if (one === task || (one.scene === task.scene && (error instanceof Final || isTooLarge))) fail(one, error.message);
  }
  if (isTooLarge) takeOnlySmaller(task.job, error.sceneBytes);
}

/// Must be called when a scene whose blobs have `sceneBytes` bytes has ended a renderer, probably
/// because there was too little memory. After this call, the tab offers the coordinator memory for
/// scenes of at most three quarters of this size.
function takeOnlySmaller(job, sceneBytes) {
  tooLarge = `The scene of job ${job} needs more memory than this browser gives; other machines render it.`;
  mostSceneMemory = Math.min(mostSceneMemory, 0.75 * MEMORY_PER_BLOB_BYTE * sceneBytes);
  setCores(state.cores);
  program.bytes("session_offer", session, state.cores, state.memoryBytes);
  if (connected) reconnect();
}

/// Starts another renderer in the place of one that has ended.
function replace(renderer) {
  const at = renderers.indexOf(renderer);
  if (at < 0 || over) return;
  log(renderer.ended);
  if (!renderer.started) {
    end("failed", `The renderer cannot run here: ${renderer.ended}`);
    return;
  }
  renderers[at] = new Renderer(module, state.memoryBytes);
}

/// Lets a renderer load the scene of a band.
async function loadScene(renderer, task) {
  // Progress is reported for this band, as long as none of its rows was given to a renderer.
  const step = (amount) => {
    if (task.rowsGiven === task.first && tasks.has(task.id)) {
      program.bytes("session_preparing", session, task.id, task.prepared += amount);
    }
  };
  step(1);
  beat();
  updatePhase();
  const wanted = () => !over && [...tasks.values()].some((one) => one.scene === task.scene);
  const began = performance.now();
  await renderer.load(task.scene, (digest) => blobs.get(digest, wanted, step), () => step(1));
  log(`scene ${task.scene.slice(0, 12)}: ready in ${((performance.now() - began) / 1000).toFixed(2)} s`);
}

/// Returns the end of the rows that a renderer is given next, a multiple of `step` or the band's end.
function endOfPiece(task, step) {
  const known = secondsPerRow.get(task.job);
  const share = (task.last - task.rowsGiven) / (2 * renderers.length);  // so that all renderers end together
  const rows = known ? Math.max(1, Math.min(PIECE_S / known, share)) : 1;
  return Math.min(task.last, Math.ceil((task.rowsGiven + Math.floor(rows)) / step) * step);
}

/// Lets a renderer render the next rows of a band, and finishes the band if they were the last ones.
async function renderRows(renderer, task) {
  const first = task.rowsGiven;
  const last = endOfPiece(task, renderer.rowStep(task.scene));
  if (task.rowsGiven === task.first) {
    task.began = performance.now() / 1000;
    program.bytes("session_rendering", session, task.id, 0, new Uint8Array(0));
    beat();
  }
  task.rowsGiven = last;
  updatePhase();
  renderer.step = () => {
    if (tasks.get(task.id) === task) program.bytes("session_rendering", session, task.id, 0, new Uint8Array(0));
  };
  const {sums, counters, seconds, rgb} = await renderer.ask("render", {lease: task.lease, first, last, picture: true});
  const samples = task.samples * (last - first) / (task.last - task.first);
  const now = performance.now() / 1000;
  pieces.push({at: now, began: now - seconds, samples});
  secondsPerRow.set(task.job, seconds / (last - first));
  if (tasks.get(task.id) !== task) return;  // it is not wanted any more
  task.parts.push({first, sums});
  task.rowsDone += last - first;
  task.seconds += seconds;
  state.rowsDone += last - first;
  program.bytes("session_rendering", session, task.id, task.rowsDone, counters);
  postMessage({...state, job: task.job, width: task.width, height: task.height, rows: {first, last, rgb}}, [rgb.buffer]);
  show();
  if (task.rowsDone === task.last - task.first) finish(task);
}

/// Joins the rows of a band, and appends the band to the bands that are sent. Forgets a band that
/// is not wanted any more.
function finish(task) {
  if (program.text("session_finished", session, task.id) !== "true") {
    drop(task.id);
    return;
  }
  const rowBytes = task.width * 3 * 8;
  const sums = new Uint8Array((task.last - task.first) * rowBytes);
  for (const part of task.parts) sums.set(new Uint8Array(part.sums), (part.first - task.first) * rowBytes);
  task.parts = [];
  // Time in which two bands were rendered together counts once, for the band that ends first.
  const now = performance.now() / 1000;
  const renderSeconds = now - Math.max(task.began, lastEnd);
  lastEnd = now;
  log(`rendered job=${task.job} rows=${task.first}:${task.last} in ${renderSeconds.toFixed(2)} s`);
  outgoing.push({task, sums, renderSeconds, refusals: 0});
  beat();
  sendBands();
}

// ---- Finished bands. ----

async function sha256(bytes) {
  if (crypto.subtle) return new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
  return program.bytes("session_sha256", session, bytes);
}

/// Sends the finished bands one after the other, each until the coordinator has taken or refused it.
async function sendBands() {
  if (sending) return;
  sending = true;
  while (outgoing.length > 0 && !over) {
    const band = outgoing[0];
    const wait = await sendOnce(band);
    if (wait > 0) await alarm.wait(wait);
  }
  sending = false;
}

/// Tries to send a band. Returns the milliseconds to wait before the next try.
async function sendOnce(band) {
  const {task, sums} = band;
  band.digest ??= await sha256(sums);
  if (!connected) return sendBackoff.next();
  if (!tasks.has(task.id)) return 0;
  let header;
  let response;
  let answer;
  try {
    header = program.bytes("session_band_header", session, task.id, band.digest, sums.length, band.renderSeconds, task.seconds);
  } catch (error) {
    fail(task, error.message);
    return 0;
  }
  try {
    response = await fetch(`${options.base}/join/band`, {method: "POST", body: new Blob([header, sums]),
      headers: {...blobs.headers(), "X-Bandsaw": "1", "Content-Type": "application/octet-stream"}});
    answer = new Uint8Array(await response.arrayBuffer());
  } catch {
    return sendBackoff.next();
  }
  if (!tasks.has(task.id)) return 0;
  if (response.ok) {
    sent(band, program.text("session_band_reply", session, task.id, answer));
    return 0;
  }
  const why = sentence(new TextDecoder().decode(answer));
  if (response.status === 401) {
    end("stopped", why);
    return 0;
  }
  log(`kept job=${task.job} rows=${task.first}:${task.last}: ${why}`);
  const final = response.status === 400 || response.status === 404 || response.status === 413 ||
    ((response.status === 403 || response.status === 409) && ++band.refusals > MAX_REFUSALS);
  if (final) {
    fail(task, why);
    return 0;
  }
  return response.status === 429 ? FULL_DISK_MS : sendBackoff.next();
}

/// Counts and forgets a band that the coordinator has taken. `outcome`: "stored", "duplicate" or
/// "unwanted", for the log.
function sent({task}, outcome) {
  drop(task.id);
  sendBackoff.reset();
  ++state.bandsDone;
  log(`${outcome} job=${task.job} rows=${task.first}:${task.last}`);
  leaveIfDrained();
  updatePhase();
  show();
}

// ---- What the page asks for. ----

/// Returns true if a pause has begun and all held bands are finished and sent.
const isDrained = () => pausedWhy !== null && program.json("session_state", session).drained;

/// Closes the stream if a pause has begun and all held bands are finished and sent.
function leaveIfDrained() {
  if (!isDrained()) return;
  const old = socket;
  socket = null;
  lost();
  old?.close(1000);
}

/// Starts or ends renderers, so that there is one for each of `count` cores, and divides the memory for
/// scenes among them.
function setCores(count) {
  state.cores = Math.max(1, Math.floor(count));
  state.memoryBytes = Math.floor(Math.min(options.memory / state.cores, options.maxInstanceBytes, mostSceneMemory));
  while (renderers.length < state.cores) renderers.push(new Renderer(module, state.memoryBytes));
  for (const renderer of renderers.splice(state.cores)) {
    renderer.leaving = true;
    if (!renderer.busy) renderer.end("fewer cores are wanted");
  }
  renderers.forEach((renderer) => { renderer.memoryBytes = state.memoryBytes; });
  pump();
  show();
}

let offering = null;  // timer

/// The calls of join_engine.js, by their names.
const calls = {
  async start(given) {
    options = given;
    module = await compile();
    program = await Program.start(module);
    const instance = Array.from(crypto.getRandomValues(new Uint8Array(16)), (one) => one.toString(16).padStart(2, "0")).join("");
    setCores(given.cores);  // the renderers start while the session makes its test render
    session = program.run("session_new", instance, given.name, given.build, state.cores, state.memoryBytes) >>> 0;
    program.read(program.run("session_answer", session));
    blobs = new Blobs(given.base, given.secret, sha256);
    updatePhase();
    if (!pausedWhy) connect();
  },
  /// Changes the number of cores. The coordinator learns it when the tab connects again, soon after the
  /// last change.
  cores({count}) {
    setCores(count);
    program.bytes("session_offer", session, state.cores, state.memoryBytes);
    clearTimeout(offering);
    offering = setTimeout(() => connected && reconnect(), REPORT_CORES_MS);
  },
  /// `why`: a sentence that begins a pause, or null, which ends the pause.
  pause({why}) {
    const was = pausedWhy;
    pausedWhy = why;
    if (why && !was) {
      send(program.bytes("session_drain", session, why));
      leaveIfDrained();
    } else if (!why && was) {
      program.bytes("session_resume", session);
      reconnect();
    }
    updatePhase();
  },
  stop() {
    end("stopped", "Stopped. Bands that were not finished are rendered by others.");
  },
};

async function compile() {
  const response = await fetch(`${options.base}/join/bandsaw.wasm`, {cache: "no-cache"});
  if (!response.ok) throw new Error(sentence(await response.text()));
  return WebAssembly.compileStreaming(response);
}

// Each call begins when the one before it has ended, because the start takes a moment.
let lastCall = Promise.resolve();
onmessage = ({data}) => {
  lastCall = lastCall.then(() => over || calls[data.call](data)).catch((error) => end("failed", `The renderer cannot run here: ${error.message}`));
};
