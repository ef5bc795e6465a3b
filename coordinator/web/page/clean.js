// The switch on the page of a finished job. It selects what is shown: the picture as rendered, the clean
// picture (denoised by the coordinator), or both side by side.

import {get, post} from "./api.js";
import {el, load, percent, stateOf, text} from "./dom.js";
import {attempt} from "./notice.js";

const modes = {raw: "As rendered", clean: "Clean", both: "Side by side"};

/// Returns true if the integrator computes light; other images have no noise to remove.
const hasLight = (status) =>
  [undefined, "INTEGRATOR_PATH", "INTEGRATOR_DIRECT", "INTEGRATOR_PATH_LIGHTS", "INTEGRATOR_PATH_SCATTERING", "INTEGRATOR_PATH_GUIDED",
    "INTEGRATOR_PATH_PLAIN"].includes(status.settings.integrator);

/// Returns a sentence for the user. `state`: a CleanPicture of proto/web.proto.
function words(state) {
  switch (state.state) {
    case "guides": return `The farm renders the images that the denoiser needs: ${percent(state.fraction)}`;
    case "filtering": return "The noise is being removed …";
    case "ready": return `Estimated error: ${percent(state.relative_rmse_raw)} as rendered, ${percent(state.relative_rmse_clean)} clean`;
    case "failed": return `The picture was not cleaned: ${state.reason}`;
    default: return "";
  }
}

/// Makes the parts of a job's page that show the clean picture. `raw`: the page's element that shows
/// the picture as rendered. Returns an object: `pictures` is an element with `raw` and the clean picture
/// in it, `frame` is the element that shows the clean picture, and `element` is the switch. The function
/// update(status) shows the state of the job.
export function cleaning(raw) {
  let mode = "raw";
  let job = 0;
  const img = el("img", {alt: "", hidden: true});
  img.addEventListener("load", () => { img.hidden = false; });
  img.addEventListener("error", () => { img.hidden = true; });
  const frame = el("div.picture", {hidden: true}, el("p.waiting", {}, "The clean picture is being made …"), img);
  const note = el("span.soft.small", {role: "status"});
  const png = el("a.button", {hidden: true}, "Clean PNG");
  const exr = el("a.button", {hidden: true, title: "The clean image; its layers are the image as rendered and the map of the error"}, "Clean EXR");
  const buttons = Object.entries(modes).map(([name, title]) =>
    el("button", {"data-mode": name, "aria-pressed": String(name === mode), onclick: () => choose(name)}, title));
  const element = el("div.row", {hidden: true, role: "group", "aria-label": "Picture as rendered or clean"}, ...buttons, png, exr, note);
  const pictures = el("div.pictures", {}, raw, frame);

  function choose(name) {
    mode = name;
    for (const button of buttons) button.setAttribute("aria-pressed", String(button.dataset.mode === mode));
    raw.hidden = mode === "clean";
    frame.hidden = mode === "raw";
    pictures.classList.toggle("both", mode === "both");
    if (mode !== "raw") request();
  }

  async function request() {
    if (await attempt(() => post(`/api/jobs/${job}/clean`)) === null) choose("raw");
  }

  return {
    pictures, frame, element,
    async update(status) {
      job = status.job;
      element.hidden = stateOf(status) !== "done" || status.samples_per_pixel < 2 || !hasLight(status);
      if (element.hidden || mode === "raw") return;
      const state = await get(`/api/jobs/${job}/clean`);
      // The picture was requested, but it is no longer kept, or the coordinator was restarted.
      if (state.state === "none") return request();
      text(note, words(state));
      png.hidden = exr.hidden = state.state !== "ready";
      if (state.state !== "ready") return;
      const side = Math.min(2048, Math.ceil(Math.max(frame.clientWidth, frame.clientHeight) * devicePixelRatio));
      load(img, `/api/jobs/${job}/clean.png?side=${side}`);
      img.alt = `${status.name}, its noise removed`;
      for (const [link, suffix] of [[png, "png"], [exr, "exr"]]) {
        link.href = `/api/jobs/${job}/clean.${suffix}`;
        link.download = `${status.name}-${job}-clean.${suffix}`;
      }
    },
  };
}
