// The form by which a user logs in to the dashboard.

import {post} from "./api.js";
import {el, text} from "./dom.js";

/// Returns the element of the form. `done`: called after a login.
export function login(done) {
  const input = el("input", {type: "password", autocomplete: "current-password", required: "", "aria-label": "Join string"});
  const wrong = el("p.bad-text", {role: "alert"});
  const submit = async (event) => {
    event.preventDefault();
    try {
      await post("/api/login", {secret: input.value});
      done();
    } catch (error) {
      text(wrong, error.message);
      input.select();
    }
  };
  return el("form.card.login", {onsubmit: submit},
    el("h1", {}, "Log in to the farm"),
    el("p.soft", {}, "Paste the line that is in the file ", el("code", {}, "farm"), " in the coordinator's data folder, or open the link in the file ",
      el("code", {}, "dashboard"), " beside it."),
    input, wrong, el("button.main", {type: "submit"}, "Log in"));
}
