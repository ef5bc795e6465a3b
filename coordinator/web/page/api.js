// The dashboard's HTTP requests to the coordinator. A failure is thrown as an Error whose message is a
// sentence; if a login is needed, its property `login` is true.

async function answer(response) {
  if (response.ok) return response;
  const problem = await response.json().catch(() => ({}));
  const error = new Error(problem.error || `the coordinator answered ${response.status}`);
  error.login = response.status === 401;
  throw error;
}

async function call(path, options) {
  let response;
  try {
    response = await fetch(path, {credentials: "same-origin", cache: "no-store", ...options});
  } catch {
    throw new Error("the coordinator cannot be reached");
  }
  return answer(response);
}

export const get = async (path) => (await call(path)).json();

/// Returns the JSON of the answer. `body`: a File, or an object that is sent as JSON.
export async function post(path, body = {}) {
  const isFile = body instanceof Blob;
  const options = {method: "POST", headers: {"X-Bandsaw": "1"}, body: isFile ? body : JSON.stringify(body)};
  return (await call(path, options)).json();
}
