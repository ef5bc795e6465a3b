// The message line under the header, and actions whose errors it shows.

const notice = document.getElementById("notice");
let timer = 0;

/// Shows a message, which disappears after a while unless it `stays`.
export function say(words, {bad = false, stays = false} = {}) {
  clearTimeout(timer);
  notice.hidden = words === "";
  notice.className = bad ? "bad" : "";
  notice.textContent = words;
  if (!stays && words !== "") timer = setTimeout(() => say(""), 8000);
}

/// Runs an action of the user and returns its result, or shows its error and returns null. The window receives the event
/// `action-done`, or `login-needed` if the user has to log in.
export async function attempt(action) {
  try {
    const result = await action();
    window.dispatchEvent(new Event("action-done"));
    return result;
  } catch (error) {
    if (error.login) window.dispatchEvent(new Event("login-needed"));
    else say(error.message, {bad: true});
    return null;
  }
}
