// The view of the workers, the machines that render.

import {get} from "./api.js";
import {duration, el, keyed, percent, rate, text} from "./dom.js";
import {browserLink} from "./link.js";

/// Returns the card of a worker, {element, update({worker, share})}. `first`: the worker's status when the card is made; the name on
/// the card does not change later. `share`: the worker's part of the farm's speed, [0, 1].
function workerCard(first) {
  const state = el("span.state");
  const speed = el("span.soft.small");
  const job = el("a.small", {href: "#/jobs"});
  const bar = el("div.bar", {}, el("i"));
  const about = el("p.soft.small.wide");
  const log = el("pre", {tabindex: "0"});
  const details = el("details.wide.small", {}, el("summary", {}, "Log"), log);
  const readLog = async () => {
    if (!details.open) return;
    const lines = await get(`/api/workers/log?name=${encodeURIComponent(first.name)}`).then((reply) => reply.line, (error) => [error.message]);
    const atEnd = log.scrollTop + log.clientHeight >= log.scrollHeight - 8;
    text(log, lines.join("\n"));
    if (atEnd) log.scrollTop = log.scrollHeight;
  };
  details.addEventListener("toggle", readLog);
  return {
    element: el("li.card.worker", {}, el("span.name", {}, first.name), state,
      el("div", {}, speed, bar), job, about, details),
    update({worker, share}) {
      text(state, worker.state);
      state.className = `state ${worker.state}`;
      text(speed, worker.samples_per_s > 0 ? `${rate(worker.samples_per_s)} · ${percent(share)} of the farm` : "not measured yet");
      bar.firstChild.style.width = `${100 * share}%`;
      text(job, worker.job === "0" ? "" : `job ${worker.job}`);
      job.href = `#/jobs/${worker.job}`;
      const words = [worker.reason, worker.browser && "in a browser", worker.threads === 1 ? "1 thread" : `${worker.threads} threads`, worker.address];
      if (worker.connected_s > 0) words.push(`here for ${duration(worker.connected_s)}`);
      words.push(worker.build);
      text(about, words.filter(Boolean).join(" · "));
      readLog();
    },
  };
}

/// Returns the view of the workers: {element, update(overview)}. `overview`: an Overview of proto/web.proto.
export function workersView() {
  const list = el("ul.workers");
  const empty = el("p.empty", {hidden: true}, "No workers yet. ", el("code", {}, "bandsaw serve"),
    " printed the line that lets a machine join.");
  const parts = new Map();
  const link = browserLink();
  return {
    element: el("div", {}, el("div.title", {}, el("h1", {}, "Workers")), link.element, empty, list),
    update(overview) {
      link.refresh();
      const there = overview.worker.filter((worker) => !["lost", "refused", "quarantined"].includes(worker.state));
      const all = there.reduce((sum, worker) => sum + worker.samples_per_s, 0);
      const shares = overview.worker.map((worker) => ({worker, share: there.includes(worker) && all > 0 ? worker.samples_per_s / all : 0}));
      keyed(list, parts, shares, ({worker}) => worker.name + worker.address, ({worker}) => workerCard(worker));
      empty.hidden = overview.worker.length > 0;
    },
  };
}
