// The view of the gallery, the installed scenes. A click on a scene renders it. Then the scene's card shows the render
// time.

import {get, post} from "./api.js";
import {el, isOver, keyed, percent, stateOf, text} from "./dom.js";
import {attempt} from "./notice.js";
import {preview} from "./picture.js";

/// Returns the width of images for this screen, in pixels: the largest of some usual widths that is
/// not larger than the screen's width, at least 320. So a phone does not load a large image.
function screenWidth() {
  const wanted = Math.min(screen.width, window.innerWidth) * devicePixelRatio;
  return [320, 480, 640, 800, 1024, 1280, 1600, 1920].findLast((width) => width <= wanted) ?? 320;
}

let width = screenWidth();
let samples = "16";
// The titles of the gallery's subfolders; "": scenes in no subfolder. `books` has scenes of the books "Ray Tracing in One
// Weekend" and its sequels. `study` has scenes of another author's study of ray tracing on phones.
const groups = {"": "Scenes", books: "The books", hard_light: "Hard light", study: "The phone study"};
const groupOf = (name) => (name.includes("/") ? name.split("/")[0] : "");

/// Returns the title of a scene: "Final scene" for the name "books/final_scene".
function titleOf(name) {
  const words = name.split("/").pop().replaceAll("_", " ");
  return words[0].toUpperCase() + words.slice(1);
}

/// Returns the card of a scene, {element, update(scene)}. `first`: the scene when the card is made.
function sceneCard(first) {
  const img = el("img", {alt: "", loading: "lazy"});
  const call = el("span.call", {}, "Render");
  img.addEventListener("load", () => { call.hidden = true; });
  const face = el("button.face", {type: "button"}, call, img);
  const bar = el("div.bar", {hidden: true}, el("i"));
  const took = el("span.took");
  const open = el("a", {hidden: true}, "Open");
  const again = el("button", {type: "button", hidden: true, title: "Render again"}, "Again");
  let job = null;
  let requested = false;
  const render = async () => {
    if (requested) return;
    requested = true;
    foot.hidden = false;
    text(took, "reading the scene…");
    await attempt(() => post("/api/gallery/render", {scene: first.name, width, samples}));
    requested = false;
  };
  face.addEventListener("click", () => {
    if (job === null || ["failed", "cancelled"].includes(stateOf(job))) render();
    else location.hash = `#/jobs/${job.job}`;
  });
  again.addEventListener("click", render);
  const title = titleOf(first.name);
  const foot = el("div.foot", {hidden: true}, took, el("span.row", {}, open, again));
  return {
    element: el("li.card.scene", {"data-scene": first.name}, face, bar,
      el("div.text", {}, el("h2", {}, title), el("p.soft.small.about", {title: first.about}, first.about), foot)),
    update(scene) {
      job = scene.job?.status ?? null;
      const is = job === null ? "" : stateOf(job);
      face.setAttribute("aria-label", ["", "failed", "cancelled"].includes(is) ? `Render ${title}` : `Open ${title}`);
      again.hidden = open.hidden = job === null || !isOver(job);
      bar.hidden = job === null || isOver(job);
      foot.hidden = job === null && !requested;
      if (job === null) return;
      open.href = is === "done" ? `/api/jobs/${job.job}/image.png` : `#/jobs/${job.job}`;
      open.target = is === "done" ? "_blank" : "";
      bar.firstChild.style.width = `${100 * job.fraction}%`;
      preview(img, job, 512);
      if (!requested) text(took, is === "done" ? `${Math.round(1000 * job.elapsed_s).toLocaleString("en")} ms` :
        is === "running" ? percent(job.fraction) : is);
      took.title = is === "done" ? `${job.settings.width} × ${job.settings.height}, ${job.samples_per_pixel} samples a pixel, ${job.workers_used} workers` : "";
    },
  };
}

/// Returns an element in which the user chooses the width and the samples of the next render.
function controls() {
  const size = el("select", {"aria-label": "Size"},
    el("option", {value: String(screenWidth())}, `This screen: ${screenWidth()} wide`),
    ...[320, 640, 1280, 1920].filter((one) => one !== screenWidth()).map((one) => el("option", {value: String(one)}, `${one} wide`)),
    el("option", {value: "0"}, "As the scene says"));
  size.value = String(width);
  size.addEventListener("change", () => { width = Number(size.value); });
  const quality = el("select", {"aria-label": "How well"},
    ...["4", "16", "64", "256"].map((one) => el("option", {value: one}, `${one} samples`)));
  quality.value = samples;
  quality.addEventListener("change", () => { samples = quality.value; });
  return el("div.row", {}, size, quality);
}

/// Returns the view of the gallery: {element, update()}.
export function galleryView() {
  const body = el("div");
  const lists = new Map();
  const none = el("p.empty", {hidden: true}, "The gallery's files are not installed beside this coordinator.");
  const listOf = (group) => {
    if (!lists.has(group)) {
      const list = el("ul.gallery");
      body.append(el("section", {}, el("h2", {}, groups[group] ?? group), list));
      lists.set(group, {list, parts: new Map()});
    }
    return lists.get(group);
  };
  return {
    element: el("div", {}, el("div.title", {}, el("h1", {}, "Gallery"), controls()), none, body),
    async update() {
      const {scene: scenes} = await get("/api/gallery");
      none.hidden = scenes.length > 0;
      for (const group of new Set(scenes.map((scene) => groupOf(scene.name)))) {
        const {list, parts} = listOf(group);
        keyed(list, parts, scenes.filter((scene) => groupOf(scene.name) === group), (scene) => scene.name, sceneCard);
      }
    },
  };
}
