// The dashboard's HTTP requests to the coordinator. If a request fails, an Error is thrown, whose
// message is a sentence. If a login is needed, the property `login` of the Error is true.

/// Returns a successful response. For any other response, throws the error that the coordinator
/// reports.
async function answer(response) {
  if (response.ok) return response;
  const problem = await response.json().catch(() => ({}));
  const error = new Error(problem.error || `the coordinator answered ${response.status}`);
  error.login = response.status === 401;
  throw error;
}

/// Sends a request and returns the successful response. `options`: as for fetch().
async function call(path, options) {
  let response;
  try {
    response = await fetch(path, {credentials: "same-origin", cache: "no-store", ...options});
  } catch {
    throw new Error("the coordinator cannot be reached");
  }
  return answer(response);
}

/// Returns the JSON of the answer to a GET request.
export const get = async (path) => (await call(path)).json();

/// Returns the JSON of the answer to a POST request. `body`: a File, or an object that is sent as
/// JSON.
export async function post(path, body = {}) {
  const isFile = body instanceof Blob;
  const options = {method: "POST", headers: {"X-Bandsaw": "1"}, body: isFile ? body : JSON.stringify(body)};
  return (await call(path, options)).json();
}
