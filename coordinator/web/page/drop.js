// Uploads of scene files that are dropped anywhere on the page, or chosen in a dialog.

import {post} from "./api.js";
import {el} from "./dom.js";
import {attempt, say} from "./notice.js";

let quality = "samples=64";  // the part of the request that sets when the render stops

/// Sends a scene file to the coordinator, which renders it, and shows the page of the new job.
async function render(file) {
  say(`Reading ${file.name}…`, {stays: true});
  const submitted = await attempt(() => post(`/api/scenes?name=${encodeURIComponent(file.name)}&${quality}`, file));
  if (submitted === null) return;
  say(submitted.warning.join(" "));
  location.hash = `#/jobs/${submitted.job}`;
}

/// Returns an element with a button that opens a file, and the choice of the quality of its image.
export function chooser() {
  const input = el("input", {type: "file", accept: ".zip,.glb,.textproto,.pbrt,.xml", hidden: true, "aria-label": "Scene file"});
  input.addEventListener("change", () => {
    const [file] = input.files;
    input.value = "";  // otherwise there is no event if the same file is chosen again
    if (file) render(file);
  });
  const select = el("select", {"aria-label": "How well"},
    el("option", {value: "samples=16"}, "16 samples, a draft"),
    el("option", {value: "samples=64"}, "64 samples"),
    el("option", {value: "samples=256"}, "256 samples"),
    el("option", {value: "error=0.02"}, "until error ≤ 2 %"),
    el("option", {value: "error=0.01"}, "until error ≤ 1 %"));
  select.value = quality;
  select.addEventListener("change", () => { quality = select.value; });
  return el("div.row", {}, select, input,
    el("button.main", {type: "button", onclick: () => input.click()}, "Render a scene…"));
}

/// Renders files that are dropped on the window, and shows a hint while one is dragged over it.
export function takeDrops() {
  const veil = el("div", {id: "drop", hidden: true}, el("p", {}, "Drop a scene to render it: a .zip with its files, .glb, .textproto, .pbrt or .xml"));
  document.body.append(veil);
  const hasFiles = (event) => event.dataTransfer?.types.includes("Files") && !document.querySelector("nav").hidden;
  // Number of elements that the dragged file has entered and not left. The number is above 0 as long as the
  // file is over the window, because the file enters the next element before it leaves the present one.
  let depth = 0;
  const on = (name, action) => window.addEventListener(name, (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    action(event);
    veil.hidden = depth === 0;
  });
  on("dragenter", () => { ++depth; });
  on("dragleave", () => { depth = Math.max(0, depth - 1); });
  on("dragover", () => {});
  on("drop", (event) => {
    depth = 0;
    if (event.dataTransfer.files.length > 0) render(event.dataTransfer.files[0]);
  });
}
