// The functions by which the page /join lets this tab render for a farm. The web worker join_session.js does the work.

const GIGABYTE = 2 ** 30;
// Limit of the memory that scenes may take in one instance of bandsaw.wasm. It is below the limit
// of a 32-bit WebAssembly instance, which has at most 4 GB of memory for everything.
const MAX_INSTANCE_BYTES = 3.5 * GIGABYTE;

/// Returns the number of bytes that the scenes of all cores together may take: half of the device's
/// memory. If the browser does not report the device's memory, 4 GB are assumed.
const memory = () => (navigator.deviceMemory ?? 4) * GIGABYTE / 2;

/// Returns a few words on the browser, as in "Firefox 140 on Linux".
export function describe(agent = navigator.userAgent) {
  const found = /(Firefox|Edg|OPR|Chrome|CriOS|FxiOS|Version)\/(\d+)/g;
  const all = [...agent.matchAll(found)].map(([, name, version]) => ({name, version}));
  const names = {Edg: "Edge", OPR: "Opera", CriOS: "Chrome", FxiOS: "Firefox", Version: "Safari"};
  // Edge and Opera also name Chrome, before their own name.
  const one = all.find(({name}) => name === "Edg" || name === "OPR") ?? all[0];
  const browser = one ? `${names[one.name] ?? one.name} ${one.version}` : "a browser";
  const on = [[/Android/, "Android"], [/iPhone|iPad/, "iOS"], [/Windows/, "Windows"], [/Mac OS/, "macOS"], [/CrOS/, "ChromeOS"],
    [/Linux/, "Linux"]].find(([pattern]) => pattern.test(agent))?.[1];
  return on ? `${browser} on ${on}` : browser;
}

/// Starts to render. `secret`: the secret in the link by which this browser joins. `base`: the
/// coordinator's address, as in "https://desk:8787". `cores`: number of cores to render with.
/// `name`: shown to the farm's users; empty: describe(). `onState`: called with each change of the
/// state. The state has the fields of `state` in join_session.js. When rows of the image are
/// rendered, it also has `rows` {first, last, rgb}.
export function startEngine({secret, base = location.origin, cores = 1, name = "", onState}) {
  const worker = new Worker("/join_session.js", {type: "module"});
  let over = false;
  const take = (state) => {
    if (over) return;
    over = state.phase === "stopped" || state.phase === "failed";
    if (over) worker.terminate();
    onState(state);
  };
  worker.onmessage = ({data}) => take(data);
  worker.onerror = (event) => {
    event.preventDefault();
    take({phase: "failed", text: `The renderer could not start here: ${event.message || "a file is missing"}. Reload the page.`});
  };
  const send = (message) => over || worker.postMessage(message);
  send({call: "start", secret, base, cores, name: name || describe(), build: `WebAssembly, ${describe()}`,
    memory: memory(), maxInstanceBytes: MAX_INSTANCE_BYTES});
  return {
    setCores: (count) => send({call: "cores", count}),
    /// Takes no more bands (ranges of rows of an image), and finishes those that this tab has taken.
    /// `why`: a sentence for the page and the farm.
    pause: (why = "Paused.") => send({call: "pause", why}),
    resume: () => send({call: "pause", why: null}),
    stop: () => send({call: "stop"}),
  };
}
