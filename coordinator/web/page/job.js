// The view of one job: its picture or its frames, its figures, and the buttons that pause or cancel it.

import {get, post} from "./api.js";
import {count, duration, el, goal, isOver, percent, rate, stateOf, text} from "./dom.js";
import {frames} from "./frames.js";
import {attempt} from "./notice.js";
import {picture} from "./picture.js";
import {plot} from "./plot.js";

/// Returns the number of all frames of a job. `of`: the numbers of frames in each state.
const allFrames = (of) => of.expected + of.waiting + of.rendering + of.done + of.failed;

/// Returns the figures of a job: {name: text}. A figure whose text is empty is not shown.
function figuresOf(status) {
  const known = (value, words) => (value >= 0 ? words(value) : isOver(status) ? "not known" : "not known yet");
  const {frames: count_of} = status;
  return {
    "Frames": count_of ? `${count_of.done} of ${allFrames(count_of)}${count_of.failed > 0 ? `, ${count_of.failed} failed` : ""}` : "",
    "Size": `${status.settings.width} × ${status.settings.height}`,
    "Asked for": goal(status.stop),
    [count_of ? "Largest error" : "Error"]: known(status.error, percent),
    "Samples a pixel": count_of ? "" : status.samples_per_pixel,
    "Speed": isOver(status) ? "" : rate(status.samples_per_s),
    "Time": duration(status.elapsed_s),
    "Time left": isOver(status) ? "" : known(status.remaining_s, duration),
    "Processor time": duration(status.cpu_s),
    "Rays": count(Number(status.rays)),
    "Workers used": String(status.workers_used),
  };
}

/// Returns {element, update(status)}. The element has the buttons that pause, resume and cancel the job
/// `id`, and the field in which users change its priority.
function actions(id) {
  const command = (order) => () => attempt(() => post(`/api/jobs/${id}/${order}`));
  const pause = el("button", {onclick: command("pause")}, "Pause");
  const resume = el("button", {onclick: command("resume")}, "Resume");
  const cancel = el("button.danger", {onclick: command("cancel")}, "Cancel");
  const priority = el("input", {type: "number", min: "-1000", max: "1000", step: "1", id: "priority"});
  priority.addEventListener("change", () => {
    if (priority.checkValidity() && priority.value !== "") {
      attempt(() => post(`/api/jobs/${id}/priority`, {priority: Number(priority.value)}));
    }
  });
  const element = el("div.row", {}, pause, resume, cancel,
    el("label.row.soft", {for: "priority"}, "Priority", priority));
  return {
    element,
    update(status) {
      const is = stateOf(status);
      element.hidden = isOver(status);
      pause.hidden = is !== "running";
      resume.hidden = is !== "paused";
      if (document.activeElement !== priority) priority.value = status.priority;
    },
  };
}

/// Returns the view of the job `id`: {element, update(), leave()}. update() fetches the job from the
/// coordinator and shows it. leave() must be called when the page shows another view.
export function jobView(id) {
  const title = el("h1");
  const state = el("span.state");
  const done = el("strong");
  const left = el("span.soft");
  const bar = el("div.bar", {}, el("i"));
  const why = el("p.soft.small");
  const figures = el("dl");
  const log = el("pre", {hidden: true});
  const orders = actions(id);
  const single = picture();
  const shown = el("div", {}, single.element);
  let strip = null;  // set for a job with frames
  const curve = plot();
  const side = el("div.stack", {},
    el("section.card", {}, el("div.big", {}, done, left), bar, why),
    orders.element, curve.element, el("section.card", {}, figures), log);
  return {
    element: el("div", {}, el("div.title", {}, title, state), el("div.page", {}, shown, side)),
    leave() { strip?.leave(); },
    async update() {
      const page = await get(`/api/jobs/${id}`);
      const {status} = page.job;
      const is = stateOf(status);
      text(title, `${status.name} · job ${id}`);

      text(state, is);
      state.className = `state ${is}`;
      text(done, percent(is === "done" ? 1 : status.fraction));
      text(left, is === "done" ? `in ${duration(status.elapsed_s)}` :
        is === "running" && status.remaining_s >= 0 ? `${duration(status.remaining_s)} left` : "");
      bar.className = `bar ${is}`;
      bar.firstChild.style.width = `${100 * (is === "done" ? 1 : status.fraction)}%`;
      text(why, is === "done" ? "" : page.why.join(" · "));
      figures.replaceChildren(...Object.entries(figuresOf(status)).filter(([, value]) => value !== "")
        .flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)]));
      log.hidden = status.log.length === 0;
      text(log, `${status.log_of}:\n${status.log.join("\n")}`);
      orders.update(status);
      if (status.frames && !strip) {
        strip = frames(id);
        shown.replaceChildren(strip.element);
        curve.element.hidden = true;
      }
      if (strip) {
        await strip.update(status);
        return;
      }
      await single.update(page);
      const points = (status.curve ?? []).map((point) => ({t: point.elapsed_s, error: point.relative_rmse + point.margin}));
      curve.update(points, status.stop.error, isOver(status));
    },
  };
}
