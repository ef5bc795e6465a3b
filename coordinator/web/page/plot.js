// A plot of a job's error over time. Both axes are logarithmic, so that the error of random samples falls along a straight line
// of slope -1/2.

import {duration, el, percent} from "./dom.js";

const space = "http://www.w3.org/2000/svg";
const box = {width: 480, height: 220, left: 56, right: 12, top: 10, bottom: 26};

/// Returns a new SVG element with these attributes and the text `words`.
function draw(tag, attributes, words = "") {
  const element = document.createElementNS(space, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.textContent = words;
  return element;
}

/// Returns the marks of an axis within [low, high]: 1, 2 and 5 times the powers of ten. If [low, high] has more than six such
/// marks, returns only the powers of ten.
function ticks(low, high) {
  const out = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power) {
    for (const digit of [1, 2, 5]) out.push(digit * 10 ** power);
  }
  const inside = out.filter((value) => value >= low && value <= high);
  return inside.length <= 6 ? inside : inside.filter((value) => Math.log10(value) % 1 === 0);
}

/// Returns {element, update(points, goal, over)}. `points`: an array of {t, error}, where t is in
/// seconds and the error is a fraction. `goal`: the error at which the job stops; 0: it does not
/// stop at an error. `over`: there will be no more points.
export function plot() {
  const svg = draw("svg", {class: "plot", viewBox: `0 0 ${box.width} ${box.height}`, role: "img"});
  // A pass renders a range of samples of the whole image.
  const none = el("p.soft.small", {}, "The error is known after the second pass.");
  const element = el("section.card", {}, el("h2", {}, "Error over time"), none, svg);
  return {
    element,
    update(points, goal, over) {
      const known = points.filter((point) => point.error > 0 && point.t > 0);
      element.hidden = over && known.length === 0;
      none.hidden = known.length > 0;
      svg.toggleAttribute("hidden", known.length === 0);
      if (known.length === 0) return;
      const errors = known.map((point) => point.error).concat(goal > 0 ? [goal] : []);
      const times = known.map((point) => point.t);
      const [tLow, tHigh] = [Math.min(...times) / 1.2, Math.max(...times) * 1.2];
      const [eLow, eHigh] = [Math.min(...errors) / 1.3, Math.max(...errors) * 1.3];
      const x = (t) => box.left + (box.width - box.left - box.right) * Math.log(t / tLow) / Math.log(tHigh / tLow);
      const y = (error) => box.top + (box.height - box.top - box.bottom) * Math.log(eHigh / error) / Math.log(eHigh / eLow);
      const last = known[known.length - 1];
      svg.setAttribute("aria-label", `Error ${percent(last.error)} after ${duration(last.t)}`);
      svg.replaceChildren(
        ...ticks(eLow, eHigh).flatMap((error) => [
          draw("line", {class: "grid", x1: box.left, x2: box.width - box.right, y1: y(error), y2: y(error)}),
          draw("text", {x: box.left - 6, y: y(error) + 4, "text-anchor": "end"}, percent(error))]),
        ...ticks(tLow, tHigh).flatMap((t) => [
          draw("line", {class: "grid", x1: x(t), x2: x(t), y1: box.top, y2: box.height - box.bottom}),
          draw("text", {x: x(t), y: box.height - 8, "text-anchor": "middle"}, duration(t))]),
        ...(goal > 0 ? [draw("line", {class: "goal", x1: box.left, x2: box.width - box.right, y1: y(goal), y2: y(goal)})] : []),
        draw("polyline", {class: "curve", points: known.map((point) => `${x(point.t)},${y(point.error)}`).join(" ")}),
        draw("circle", {cx: x(last.t), cy: y(last.error), r: 4}));
    },
  };
}
