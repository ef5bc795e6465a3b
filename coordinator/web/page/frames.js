// Shows the frames of a job that renders an animation: one frame large, and a strip of all frames
// with their states. The frames that are done can be played like a film.

import {get, post} from "./api.js";
import {el, load, text} from "./dom.js";
import {attempt} from "./notice.js";

/// Maximum number of frames in the strip. If the job has more frames, the strip shows only every
/// n-th frame.
const most = 600;
const stripSide = 128;   // pixels of a picture in the strip
const stageSide = 1024;  // pixels of the large picture

const stateOf = (frame) => frame.state.replace("FRAME_STATE_", "").toLowerCase();
const source = (frame, side) => `/api/jobs/${frame.job}/preview.png?side=${side}&at=end`;

/// Returns the part of the strip for one frame: {element, update(frame)}. A click on it calls
/// `choose` with the frame's number.
function cell(frame, choose) {
  const img = el("img", {alt: "", loading: "lazy", hidden: true});
  const element = el("button.frame", {onclick: () => choose(frame.frame), "aria-label": `Frame ${frame.frame}`},
    img, el("span", {}, String(frame.frame)));
  return {
    element,
    update(now) {
      const is = stateOf(now);
      element.dataset.state = is;
      element.title = `frame ${now.frame}: ${is}${now.reason ? `, ${now.reason}` : ""}`;
      if (is === "done") {
        load(img, source(now, stripSide));
        img.hidden = false;
      }
    },
  };
}

/// Returns {element, update(status), leave()} for the job `id`, which has frames.
export function frames(id) {
  let epoch = "";        // the run of the coordinator that answered last
  let after = "0";       // number of the newest change that was received; a text, because it has 64 bits
  let all = [];          // numbers, ascending
  const known = new Map();  // number -> frame
  const cells = new Map();  // number -> part of the strip
  const loaded = new Map();  // number -> image, for play
  let chosen = null;
  let timer = 0;

  const img = el("img", {alt: "", hidden: true});
  const waiting = el("p.waiting", {}, "No frame is done yet.");
  const stage = el("div.picture", {}, waiting, img);
  const strip = el("div.strip", {role: "group", "aria-label": "Frames"});
  const number = el("span.soft");
  const play = el("button.main", {"aria-pressed": "false", onclick: () => (timer ? stop() : start())}, "Play");
  const fps = el("input", {type: "number", min: "1", max: "60", step: "1", value: "24", id: "fps"});
  const retry = el("button", {hidden: true, onclick: () => attempt(() => post(`/api/jobs/${id}/retry`))}, "Retry what failed");
  const open = el("a.button", {hidden: true}, "This frame");

  // The numbers of the frames in the strip.
  const shown = () => all.filter((one, i) => i % Math.ceil(all.length / most) === 0);
  // The numbers of the frames in the strip that are done.
  const done = () => shown().filter((one) => stateOf(known.get(one)) === "done");

  /// Shows the frame with the number `one` large, if it is done.
  function show(one) {
    const frame = known.get(one);
    if (!frame || stateOf(frame) !== "done") return;
    if (chosen !== null) cells.get(chosen)?.element.removeAttribute("aria-current");
    chosen = one;
    cells.get(one)?.element.setAttribute("aria-current", "true");
    const ready = loaded.get(one);
    load(img, ready?.complete ? ready.src : source(frame, stageSide));
    img.hidden = false;
    waiting.hidden = true;
    text(number, `frame ${one}`);
    open.href = `#/jobs/${frame.job}`;
    open.hidden = false;
  }

  function choose(one) {
    stop();
    show(one);
  }

  /// Plays: shows the next frame that is done, and calls itself again after the time of a frame. If
  /// the image of the next frame is not loaded yet, the present frame stays, so that nothing
  /// flickers. The images of 12 frames are loaded ahead, and at most 300 are kept.
  function tick() {
    const numbers = done();
    const at = numbers.findIndex((one) => one > (chosen ?? -Infinity));
    const next = numbers[at === -1 ? 0 : at];
    for (const one of numbers.slice(Math.max(at, 0), Math.max(at, 0) + 12)) {
      if (!loaded.has(one)) {
        const image = new Image();
        image.src = source(known.get(one), stageSide);
        loaded.set(one, image);
        if (loaded.size > 300) loaded.delete(loaded.keys().next().value);
      }
    }
    if (next !== undefined && loaded.get(next)?.complete) show(next);
    timer = setTimeout(tick, 1000 / Math.min(60, Math.max(1, Number(fps.value) || 24)));
  }

  function start() {
    play.setAttribute("aria-pressed", "true");
    text(play, "Pause");
    tick();
  }

  function stop() {
    clearTimeout(timer);
    timer = 0;
    play.setAttribute("aria-pressed", "false");
    text(play, "Play");
  }

  return {
    element: el("div.stack", {}, stage,
      el("div.row", {}, play, el("label.row.soft", {for: "fps"}, "Frames a second", fps), number, open, retry), strip),
    async update(status) {
      const {width, height} = status.settings;
      stage.style.aspectRatio = `${width} / ${height}`;
      stage.style.maxWidth = `calc(60vh * ${width / height})`;
      strip.style.setProperty("--aspect", `${width} / ${height}`);
      // Each run of the coordinator numbers the changes from 1. So after a restart, all frames are
      // requested again.
      let reply = await get(`/api/jobs/${id}/frames?after=${after}`);
      if (reply.epoch !== epoch) {
        if (after !== "0") reply = await get(`/api/jobs/${id}/frames?after=0`);
        epoch = reply.epoch;
        after = "0";
        all = reply.frame.map((frame) => Number(frame.frame));
      }
      for (const frame of reply.frame) {
        frame.frame = Number(frame.frame);
        known.set(frame.frame, frame);
        if (BigInt(frame.changed) > BigInt(after)) after = frame.changed;
      }
      const show_cells = shown();
      if (cells.size === 0) {
        for (const one of show_cells) {
          cells.set(one, cell(known.get(one), choose));
          strip.append(cells.get(one).element);
        }
      }
      for (const one of show_cells) cells.get(one)?.update(known.get(one));
      // Shows a frame that is done if no large picture was loaded yet, or if its loading has
      // failed.
      if (!img.hasAttribute("src") && done().length > 0) show(chosen ?? done()[0]);
      play.disabled = done().length < 2;
      retry.hidden = (status.frames?.failed ?? 0) === 0;
    },
    leave: stop,
  };
}
