// Starts the dashboard's page: shows the view that the address after the # names, and polls the coordinator for the data that the
// view shows.

import {get, post} from "./api.js";
import {count, text} from "./dom.js";
import {login} from "./login.js";
import {jobsView} from "./jobs.js";
import {jobView} from "./job.js";
import {workersView} from "./workers.js";
import {galleryView} from "./gallery.js";
import {takeDrops} from "./drop.js";
import {say} from "./notice.js";

const routes = [
  [/^#\/jobs$/, jobsView],
  [/^#\/jobs\/(\d+)$/, jobView],
  [/^#\/workers$/, workersView],
  [/^#\/gallery$/, galleryView],
];
const root = document.getElementById("view");
let view = null;  // {element, update(overview), leave?()}
let timer = 0;
let isLost = false;  // the last request failed

/// Replaces the present view by the view `next`.
function show(next) {
  view?.leave?.();
  view = next;
  root.replaceChildren(next.element);
  window.scrollTo(0, 0);
}

function showLogin() {
  clearTimeout(timer);
  document.querySelector("nav").hidden = true;
  show({element: login(start), update() {}});
  root.querySelector("input").focus();
}

/// Shows the view that the address after the # names. If the address names no view, shows the view of the jobs. Marks the view's
/// link in the header.
function route() {
  const hash = routes.some(([pattern]) => pattern.test(location.hash)) ? location.hash : "#/jobs";
  for (const [pattern, make] of routes) {
    const match = hash.match(pattern);
    if (match) {
      show(make(...match.slice(1)));
      break;
    }
  }
  for (const link of document.querySelectorAll("nav a")) {
    if (hash.startsWith(link.getAttribute("href"))) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
}

/// Shows in the header how many workers there are, and their speed.
function pulse(overview) {
  const there = overview.worker.filter((worker) => ["idle", "rendering", "draining"].includes(worker.state));
  const speed = overview.job.reduce((sum, job) => sum + job.status.samples_per_s, 0);
  const words = there.length === 1 ? "1 worker" : `${there.length} workers`;
  text(document.getElementById("pulse"), speed > 0 ? `${words} · ${count(speed)}samples/s` : words);
}

function lost(error) {
  isLost = true;
  say(`${error.message}; trying again`, {bad: true, stays: true});
}

/// Polls once a second while the page is visible, otherwise every ten seconds. After an error waits
/// three seconds. Polling is cheap, and works again after any interruption of the connection.
async function refresh() {
  clearTimeout(timer);
  let wait = document.hidden ? 10000 : 1000;
  try {
    const overview = await get("/api/farm");
    if (isLost) {
      isLost = false;
      say("");
    }
    pulse(overview);
    await view.update(overview);
  } catch (error) {
    if (error.login) return showLogin();
    lost(error);
    wait = 3000;
  }
  clearTimeout(timer);
  timer = setTimeout(refresh, wait);
}

function start() {
  document.querySelector("nav").hidden = false;
  route();
  refresh();
}

/// Logs in if the address has the users' secret. Then shows the page, or the login form if the user
/// is not logged in. The link that `bandsaw serve` writes has the secret after the #. Browsers do not
/// send this part of an address to a server.
async function enter() {
  const key = location.hash.match(/^#key=(.+)$/);
  if (key) {
    history.replaceState(null, "", location.pathname);
    await post("/api/login", {secret: decodeURIComponent(key[1])}).catch((error) => say(error.message, {bad: true}));
  }
  const state = await get("/api/login").catch((error) => ({error}));
  if (state.error) {
    lost(state.error);
    setTimeout(enter, 3000);
  } else if (state.logged_in) {
    start();
  } else {
    showLogin();
  }
}

window.addEventListener("hashchange", () => {
  if (location.hash.startsWith("#key=")) return enter();
  route();
  refresh();
  root.focus({preventScroll: true});
});
window.addEventListener("action-done", refresh);
window.addEventListener("login-needed", showLogin);
document.addEventListener("visibilitychange", () => { if (!document.hidden && view) refresh(); });
takeDrops();
enter();
