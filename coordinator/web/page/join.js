// The page /join, for browsers that render for a farm. It asks the user to start, then shows what this
// device renders.

import {count, duration, text} from "./dom.js";
import {Picture} from "./join_picture.js";
import {Pauses} from "./join_pauses.js";

const $ = (id) => document.getElementById(id);
const allCores = Math.max(1, navigator.hardwareConcurrency || 1);
// The secret follows the # in the address. Browsers do not send this part of an address to a
// server. The secret stays in the address, so that a reload works.
const secret = location.hash.slice(1);
const words = (n) => n === 1 ? "1 core" : `${n} cores`;

function show(section) {
  for (const id of ["problem", "intro", "work"]) $(id).hidden = id !== section;
}

/// Shows a problem in place of the page. The sentence gets a capital letter and a full stop.
function problem(heading, sentence) {
  text($("problem").querySelector("h1"), heading);
  text($("problem").querySelector("p"), sentence.replace(/^./, (first) => first.toUpperCase()).replace(/\.?$/, "."));
  show("problem");
}

/// Returns the answer to /join/about, a JoinAbout of proto/web.proto. Throws an Error with a sentence.
async function about() {
  let response;
  try {
    response = await fetch("/join/about", {headers: {Authorization: `Bearer ${secret}`}, cache: "no-store"});
  } catch {
    throw new Error("The coordinator cannot be reached. " +
      "Is the coordinator running, and is this device in its network?");
  }
  const answer = await response.json().catch(() => ({}));
  if (!response.ok) throw new Error(answer.error || `The coordinator answered ${response.status}.`);
  return answer;
}

/// Keeps the screen awake from update(true) to update(false), by a wake lock of the browser. The
/// browser ends the lock when the page is hidden. So update() must be called again whenever the page
/// is hidden or shown.
class Awake {
  #wanted = false;
  #lock = null;
  async update(wanted) {
    const now = wanted && !document.hidden;
    if (now === this.#wanted) return;
    this.#wanted = now;
    if (now) this.#lock = await navigator.wakeLock.request("screen").catch(() => null);
    if (!this.#wanted) {  // #wanted may have changed while the lock was requested
      await this.#lock?.release().catch(() => {});
      this.#lock = null;
    }
  }
}

/// Starts the renderer, when the user has pressed the button, and shows what it renders.
async function work() {
  show("work");
  text($("phase"), "Starting");
  let module;
  try {
    module = await import("/join_engine.js");
  } catch {
    problem("The renderer is missing", "This coordinator has no renderer for browsers: install a version of Bandsaw that has this renderer, and start the coordinator again.");
    return;
  }
  const picture = new Picture($("picture"), $("no-picture"));
  const awake = new Awake();
  const began = Date.now();
  let engine = null;
  let state = {};
  const pauses = new Pauses((reason) => {
    if (engine) reason ? engine.pause(reason) : engine.resume();
    update();
  });

  function update() {
    const reason = pauses.reason();
    text($("phase"), reason || state.text || "Starting");
    $("phase").className = `state ${reason ? "" : state.phase === "rendering" ? "rendering" : state.phase ?? ""}`;
    text($("pause"), pauses.byUser ? "Go on" : "Pause");
    text($("speed"), !reason && state.samplesPerSecond > 0 ? `${count(state.samplesPerSecond)}/s` : "–");
    text($("rows"), String(state.rowsDone ?? 0));
    text($("pulse"), [state.name, state.job ? `job ${state.job}` : ""].filter(Boolean).join(" · "));
    const {dataset} = document.body;  // for tests and other programs that drive the page
    [dataset.phase, dataset.text, dataset.rows, dataset.rate] =
      [state.phase ?? "", state.text ?? "", state.rowsDone ?? 0, state.samplesPerSecond ?? 0];
    if ("wakeLock" in navigator) awake.update($("awake").checked && !reason && !["stopped", "failed"].includes(state.phase));
  }
  const onState = (next) => {
    const {rows, ...rest} = next;
    state = {...state, ...rest};
    picture.draw({...state, rows});
    update();
    if (next.phase === "stopped") problem("This device has stopped rendering", state.text);
    if (next.phase === "failed") problem("This device cannot render", state.text);
  };

  $("cores").addEventListener("input", () => {
    text($("cores-now"), `${$("cores").value} of ${allCores}`);
    engine?.setCores(Number($("cores").value));
  });
  $("cores").dispatchEvent(new Event("input"));
  $("pause").addEventListener("click", () => pauses.setByUser(!pauses.byUser));
  $("hidden").addEventListener("change", () => pauses.setMayHide($("hidden").checked));
  $("awake").addEventListener("change", update);
  document.addEventListener("visibilitychange", update);
  setInterval(() => text($("time"), duration(Math.round((Date.now() - began) / 1000))), 1000);

  try {
    engine = await module.startEngine({secret, base: location.origin, cores: Number($("cores").value), onState});
  } catch (error) {
    problem("This device cannot render", error.message);
    return;
  }
  if (pauses.reason()) engine.pause(pauses.reason());
  update();
}

/// Checks that this browser can join the farm. Then shows the button that starts the renderer.
async function enter() {
  if (!secret) {
    problem("The link is incomplete", "This page is opened by a link that ends in # and a secret; open the whole link, or scan its code again.");
    return;
  }
  if (typeof WebAssembly === "undefined" || typeof WebSocket === "undefined") {
    problem("This browser cannot render",
      "This browser has no WebAssembly or no WebSocket. Use a newer browser.");
    return;
  }
  try {
    const {renderer} = await about();
    if (!renderer) {
      problem("The renderer is missing", "The renderer for browsers is not installed on the host: install share/bandsaw/browser beside Bandsaw's programs, and start the coordinator again.");
      return;
    }
  } catch (error) {
    problem("This device cannot join", error.message);
    return;
  }
  $("cores").max = String(allCores);
  $("cores").value = String(Math.max(1, allCores - 1));  // one core is left for the user
  text($("intro-cores"), `${words(Number($("cores").value))} of ${allCores}`);
  $("awake").parentElement.hidden = !("wakeLock" in navigator);
  $("metered").hidden = !(navigator.connection?.type === "cellular" || navigator.connection?.saveData);
  show("intro");
  $("start").focus();
}

$("start").addEventListener("click", work);
window.addEventListener("hashchange", () => location.reload());
enter();
