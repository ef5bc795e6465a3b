// The view of all jobs, as a list.

import {chooser} from "./drop.js";
import {preview} from "./picture.js";
import {count, duration, el, goal, isOver, keyed, percent, rate, stateOf, text} from "./dom.js";

/// Returns the line of text that describes a job in the list, from a JobStatus of proto/farm.proto.
function summary(status) {
  const words = [`${status.settings.width} × ${status.settings.height}`];
  const {frames} = status;
  if (frames) {
    const all = frames.expected + frames.waiting + frames.rendering + frames.done + frames.failed;
    words.push(`${frames.done} of ${all} frames`);
  }
  if (isOver(status)) {
    if (!frames) words.push(`${status.samples_per_pixel} samples a pixel`);
    if (status.error >= 0) words.push(`error ${percent(status.error)}`);
    words.push(duration(status.elapsed_s));
    return words.join(" · ");
  }
  words.push(goal(status.stop));
  if (status.error >= 0) words.push(`error ${percent(status.error)}`);
  if (status.samples_per_s > 0) words.push(rate(status.samples_per_s));
  if (status.remaining_s >= 0) words.push(`${duration(status.remaining_s)} left`);
  return words.join(" · ");
}

/// Returns the list's row of a job, {element, update(job)}. `first`: the job when the row is made.
function jobRow(first) {
  const id = first.status.job;
  const img = el("img.thumb", {alt: "", loading: "lazy"});
  const name = el("span.name");
  const state = el("span.state");
  const bar = el("div.bar", {}, el("i"));
  const words = el("p.soft.small");
  const link = el("a.job", {href: `#/jobs/${id}`}, img,
    el("div.head", {}, name, el("span.soft", {}, `job ${id}`), state), bar, words);
  return {
    element: el("li", {}, link),
    update({status}) {
      const is = stateOf(status);
      preview(img, status, 256);
      text(name, status.name);
      text(state, is === "running" ? percent(status.fraction) : is);
      state.className = `state ${is}`;
      bar.className = `bar ${is}`;
      bar.firstChild.style.width = `${100 * (is === "done" ? 1 : status.fraction)}%`;
      text(words, is === "failed" || is === "paused" ? status.reason : [summary(status), status.reason].filter(Boolean).join(" · "));
    },
  };
}

/// Returns the view of all jobs: {element, update(overview)}.
export function jobsView() {
  const list = el("ul.jobs");
  const empty = el("p.empty", {hidden: true}, "No jobs yet. Drop a .glb or a .textproto here, look into the gallery, or use ",
    el("code", {}, "bandsaw submit"), ".");
  const more = el("p.soft.small");
  const parts = new Map();
  return {
    element: el("div", {}, el("div.title", {}, el("h1", {}, "Jobs"), chooser()), empty, list, more),
    update(overview) {
      keyed(list, parts, overview.job, (job) => job.status.job, jobRow);
      empty.hidden = overview.job.length > 0;
      text(more, overview.jobs_left_out > 0
        ? `${count(overview.jobs_left_out)}older jobs are not shown; \`bandsaw jobs\` lists them` : "");
    },
  };
}
