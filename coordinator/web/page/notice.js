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

/// Runs an action of the user. After a success, sends the event `action-done` to the window and returns the action's
/// result. After a failure, shows the error and returns null. If the user has to log in, sends the event `login-needed`
/// to the window instead of showing the error.
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
