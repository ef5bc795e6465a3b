// Shows a job's picture and updates it as samples arrive. A button shows and hides colours, which tell which worker rendered
// which rows.

import {cleaning} from "./clean.js";
import {el, isOver, load, stateOf, text} from "./dom.js";

/// Colours that are distinguishable with colour vision deficiencies (Okabe and Ito 2008).
const palette = ["#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#f0e442", "#0072b2", "#d55e00", "#999999"];

/// Returns true if the job has a preview or an image.
const there = (status) => stateOf(status) === "done" || (Number(status.samples_done) > 0 && !isOver(status));

/// Shows the newest preview. The old one remains until the new one is loaded. `side`: the wanted
/// length of the preview's longer side, in pixels.
export function preview(img, status, side) {
  if (!there(status)) return;
  load(img, `/api/jobs/${status.job}/preview.png?side=${side}&at=${stateOf(status) === "done" ? "end" : status.samples_done}`);
}

/// Returns an element that marks the rows [first, last). `now`: they are being rendered.
function band(first, last, height, colour, now) {
  const part = el(now ? "i.now" : "i");
  part.style.top = `${(100 * first) / height}%`;
  part.style.height = `${(100 * (last - first)) / height}%`;
  part.style.color = colour;
  return part;
}

/// Returns {element, update(page)}; `page`: a JobPage of proto/web.proto.
export function picture() {
  const img = el("img", {alt: "", hidden: true});
  img.addEventListener("load", () => { img.hidden = false; });
  img.addEventListener("error", () => { img.hidden = true; });
  const waiting = el("p.waiting", {}, "Nothing is rendered yet.");
  const owners = el("div.owners", {hidden: true, "aria-hidden": "true"});
  const frame = el("div.picture", {}, waiting, img, owners);
  const cleaned = cleaning(frame);
  const legend = el("ul.legend.small", {hidden: true, "aria-label": "Who rendered which rows"});
  const toggle = el("button", {"aria-pressed": "false", onclick: () => {
    owners.hidden = legend.hidden = !owners.hidden;
    toggle.setAttribute("aria-pressed", String(!owners.hidden));
  }}, "Who rendered what");
  const open = el("a.button", {target: "_blank", rel: "noopener", hidden: true}, "Open the image");
  const png = el("a.button", {hidden: true}, "PNG");
  const exr = el("a.button", {hidden: true}, "EXR");
  const report = el("a.button", {hidden: true, title: "What the image cost and how wrong it is, as JSON"}, "Report");
  return {
    element: el("div.stack", {}, cleaned.pictures, cleaned.element, el("div.row", {}, open, png, exr, report, toggle), legend),
    update(page) {
      const {status} = page.job;
      const {width, height} = status.settings;
      for (const one of [frame, cleaned.frame]) {
        one.style.aspectRatio = `${width} / ${height}`;
        one.style.maxWidth = `calc(74vh * ${width / height})`;
      }
      img.alt = `${status.name}, as far as it is rendered`;
      preview(img, status, Math.min(2048, Math.ceil(Math.max(frame.clientWidth, frame.clientHeight) * devicePixelRatio)));
      waiting.hidden = !img.hidden;
      text(waiting, there(status) ? "Loading the picture…" : isOver(status) ? "There is no image." : "Nothing is rendered yet.");

      const names = [...new Set([...page.rendered.map((rows) => rows.worker), ...status.worker.map((worker) => worker.name)])].sort();
      const colour = (name) => palette[names.indexOf(name) % palette.length];
      const rows = (name) => page.rendered.filter((one) => one.worker === name).reduce((sum, one) => sum + one.last_row - one.first_row, 0);
      owners.replaceChildren(
        ...page.rendered.map((one) => band(one.first_row, one.last_row, height, colour(one.worker), false)),
        ...status.worker.filter((one) => one.last_row > one.first_row).map((one) => band(one.first_row, one.last_row, height, colour(one.name), true)));
      legend.replaceChildren(...names.map((name) => {
        const swatch = el("i");
        swatch.style.background = colour(name);
        // The name is empty if the coordinator does not know it, as for rows that were rendered before its restart.
        return el("li", {}, swatch, `${name || "before the restart"} · ${rows(name)} rows`);
      }));
      toggle.hidden = names.length === 0;
      if (toggle.hidden) owners.hidden = legend.hidden = true;

      const done = stateOf(status) === "done";
      for (const link of [open, png, exr, report]) link.hidden = !done;
      open.href = png.href = `/api/jobs/${status.job}/image.png`;
      exr.href = `/api/jobs/${status.job}/image.exr`;
      report.href = `/api/jobs/${status.job}/report.json`;
      png.download = `${status.name}-${status.job}.png`;
      exr.download = `${status.name}-${status.job}.exr`;
      report.download = `${status.name}-${status.job}.json`;
      return cleaned.update(status);
    },
  };
}
