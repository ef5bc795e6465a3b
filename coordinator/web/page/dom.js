// Functions of the dashboard's page that create elements and format values.

/// Returns a new element: el("p.soft", {title: "x", onclick: f}, "text", child, …) is a <p> of class "soft".
export function el(what, attributes = {}, ...children) {
  const [tag, ...classes] = what.split(".");
  const element = document.createElement(tag);
  element.className = classes.join(" ");
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "hidden") element.hidden = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

/// Sets the text only if it differs, so that nothing flickers and a selection is kept.
export function text(element, value) {
  if (element.textContent !== value) element.textContent = value;
}

/// Loads a picture from the address `source`, unless the element `img` shows it already. If the loading fails, the
/// next call loads the picture again.
export function load(img, source) {
  if (img.getAttribute("src") === source) return;
  img.onerror = () => img.removeAttribute("src");
  img.src = source;
}

/// Shows a list: `parent` has one part for each item, in the same order. `parts`: a Map from the keys of the
/// items to the parts of the last call. keyOf(item) returns the key of an item. For a new item, make(item)
/// returns its part, {element, update(item), leave?()}. Every part is updated with its item. If the list no
/// longer has an item, the part of this item is removed and its function leave() is called.
export function keyed(parent, parts, items, keyOf, make) {
  const seen = new Set();
  items.forEach((item, i) => {
    const key = keyOf(item);
    seen.add(key);
    if (!parts.has(key)) parts.set(key, make(item));
    const part = parts.get(key);
    part.update(item);
    if (parent.children[i] !== part.element) parent.insertBefore(part.element, parent.children[i] ?? null);
  });
  for (const [key, part] of parts) {
    if (!seen.has(key)) {
      part.element.remove();
      part.leave?.();
      parts.delete(key);
    }
  }
}

// Returns a number as text with n significant digits.
const digits = (value, n) => value.toLocaleString("en", {maximumSignificantDigits: n});

export const percent = (fraction) => `${digits(100 * fraction, 2)} %`;

/// Returns a number and the prefix of a unit: "1.23 M". The caller appends the unit.
export function count(value) {
  const units = [[1e12, " T"], [1e9, " G"], [1e6, " M"], [1e3, " k"]];
  const [by, unit] = units.find(([least]) => value >= least) ?? [1, " "];
  return digits(value / by, 3) + unit;
}

export const rate = (perSecond) => `${count(perSecond)}samples/s`;

/// Returns a time as text: "4.2 s", "3:05 min" or "1:02:03 h".
export function duration(seconds) {
  if (seconds < 60) return `${digits(seconds, 2)} s`;
  const whole = Math.round(seconds);
  const two = (value) => String(value).padStart(2, "0");
  const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  return h > 0 ? `${h}:${two(m)}:${two(s)} h` : `${m}:${two(s)} min`;
}

/// Returns the state of a job: "running", "paused", "finishing", "done", "failed" or "cancelled".
export const stateOf = (status) => status.state.replace("JOB_STATE_", "").toLowerCase();
export const isOver = (status) => ["done", "failed", "cancelled"].includes(stateOf(status));

/// Returns a stop rule as text: "until error ≤ 1 %".
export function goal(stop) {
  if (stop.error > 0) return `until error ≤ ${percent(stop.error)}`;
  if (stop.time_s > 0) return `for ${duration(stop.time_s)}`;
  return `${stop.samples} samples a pixel`;
}
