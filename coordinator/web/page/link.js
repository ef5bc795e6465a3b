// The part of the view of workers that shows, makes and revokes the link by which browsers join as workers, with its QR code.

import {get, post} from "./api.js";
import {duration, el, text} from "./dom.js";
import {attempt} from "./notice.js";

/// Returns {element, refresh()}. The element shows a button; after a click it shows the link
/// instead. refresh() updates the link if the link is shown.
export function browserLink() {
  const code = el("img.code", {alt: "QR code of the link", width: 200, height: 200});
  const address = el("input", {readonly: "", "aria-label": "Link for browsers"});
  const note = el("p.soft.small");
  const panel = el("div.card.invite", {hidden: true}, code,
    el("div.stack", {}, el("p", {}, "A browser that opens this link renders for the farm. Nothing is installed."), address, note,
      el("div.row", {},
        el("button", {type: "button", onclick: () => copy()}, "Copy"),
        el("button.danger", {type: "button", onclick: () => revoke()}, "Take it back"))));
  const button = el("button", {type: "button", onclick: () => open()}, "Let browsers join");

  function show(link) {
    panel.hidden = link.url === "";
    button.hidden = link.url !== "";
    if (link.url === "") return;
    if (address.value !== link.url) {
      address.value = link.url;
      code.src = `/api/link.svg?of=${Date.now()}`;
    }
    const isLocal = /^http:\/\/(127\.|localhost|\[::1\])/.test(link.url);
    text(note, isLocal ? "This link works on this machine only. For other machines, " +
      "start the coordinator with `bandsaw serve --web 0.0.0.0:8787`."
      : `This link ends in ${duration(link.left_s)}.`);
  }
  const open = () => attempt(async () => {
    const link = await get("/api/link");
    show(link.url === "" ? await post("/api/link", {}) : link);
  });
  const revoke = () => attempt(async () => show(await post("/api/link/revoke", {})));
  const copy = () => attempt(async () => {
    address.select();
    await navigator.clipboard?.writeText(address.value);
  });
  return {element: el("div.joining", {}, button, panel), refresh: () => panel.hidden ? null : get("/api/link").then(show, () => {})};
}
