// The line under the header, and actions whose failures it tells.

const notice = document.getElementById("notice");
let timer = 0;

/// Goes by itself unless it `stays`.
export function say(words, {bad = false, stays = false} = {}) {
  clearTimeout(timer);
  notice.hidden = words === "";
  notice.className = bad ? "bad" : "";
  notice.textContent = words;
  if (!stays && words !== "") timer = setTimeout(() => say(""), 8000);
}

/// Does what a person asked for and says what went wrong with it. The window hears `action-done`, or
/// `login-needed`.
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
