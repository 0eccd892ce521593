/** All communication with the server: JSON calls, calls of which only the newest is sent, and downloads. */

import { spelt } from "/app/refusal.js";
import { learnMessages, t } from "/app/words.js";

/** Error of the server, with the text of the server. */
export class ApiError extends Error {
  /** @param {number} status @param {{ kind?: string, message?: string, needs?: string[], [more: string]: any }} [details] */
  constructor(
    status, { kind = "internal", message = "the server sent no response", needs = [], ...more } = {},
  ) {
    super(message);
    this.name = "ApiError";
    Object.assign(this, more, { status, kind, needs });
  }
}

/** Call the API; resolves to JSON, rejects with ApiError. @type {Call} */
export const call = async (path, options) => {
  const answer = await (await send(path, options)).json();
  learnMessages(answer, (message) => spelt(message));
  return answer;
};

/** A file of the server as a blob. @param {string} path */
export const fetchFile = async (path) => (await send(path)).blob();

/** Call by POST. If several calls with one key wait, only the newest call is sent.
 * @type {<const Path extends string>(key: string, path: Path, json: unknown) => Promise<Server.Answer<"POST", Path>>} */
export const latest = (key, path, json) =>
  new Promise((resolve, reject) => {
    /** @type {Line} */
    const line = lines.get(key) ?? { busy: false, next: null };
    lines.set(key, line);
    line.next?.reject(new DOMException("replaced by a newer call", "AbortError"));
    line.next = { path, json, resolve, reject };
    if (!line.busy) follow(line);
  });

/** True if a newer call caused the abort. @param {any} error */
export const superseded = (error) => error?.name === "AbortError";

/** Save the result as a file; the file name of the server has priority.
 * @param {string} path @param {unknown} [json] @param {string} [fallbackName] @param {AbortSignal} [signal] */
export const download = async (path, json, fallbackName, signal) => {
  const answer = await send(path, json === undefined ? { method: "GET", signal } : { json, signal });
  saveBlob(await answer.blob(), nameOf(answer) ?? fallbackName ?? "");
};

/** Save a blob under a name. @param {Blob} blob @param {string} name */
export const saveBlob = (blob, name) => {
  const address = URL.createObjectURL(blob);
  const anchor = Object.assign(document.createElement("a"), { href: address, download: name });
  document.body.append(anchor);
  anchor.click();
  anchor.remove();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
};

/** @typedef {{ path: string, json: unknown, resolve: (answer: any) => void, reject: (error: unknown) => void }} Waiting
 * @typedef {{ busy: boolean, next: Waiting | null }} Line */

/** @type {Map<string, Line>} */
const lines = new Map();

/** @param {Line} line */
const follow = async (line) => {
  if (!line.next) return;
  const { path, json, resolve, reject } = line.next;
  line.next = null;
  line.busy = true;
  try {
    resolve(await call(path, { json }));
  } catch (error) {
    reject(error);
  } finally {
    line.busy = false;
    if (line.next) follow(line);
  }
};

let signIns = 0;
document.addEventListener("rocking:signed-in", () => (signIns += 1));

/** @param {string} path @param {CallOptions} [options] @returns {Promise<Response>} */
const send = async (path, options = {}) => {
  const { method, json, body, query, signal, keepalive = false } = options;
  const before = signIns;
  const content = json === undefined ? body : JSON.stringify(json);
  const answer = await fetch(addressOf(path, query), {
    method: method ?? (content === undefined ? "GET" : "POST"),
    headers: content === undefined ? {} : { "Content-Type": typeOf(json) },
    body: content,
    signal,
    keepalive,
    credentials: "same-origin",
  }).catch((error) => {
    if (superseded(error)) throw error;
    document.dispatchEvent(new CustomEvent("rocking:offline"));
    throw new ApiError(
      0, { kind: "offline", message: "The server does not respond. Check that `rocking serve` is running." },
    );
  });
  if (answer.ok) return answer;
  const refusal = await refusalOf(answer);
  if (answer.status === 401) {
    if (signIns > before) return send(path, options); // the call began before the sign-in
    document.dispatchEvent(new CustomEvent("rocking:signed-out"));
  }
  throw new ApiError(answer.status, refusal);
};

/** @param {unknown} json */
const typeOf = (json) => (json === undefined ? "application/octet-stream" : "application/json");

/** @param {string} path @param {CallOptions["query"]} query */
const addressOf = (path, query) => {
  const address = path.startsWith("/") ? path : `/api/${path}`;
  const entries = Object.entries(query ?? {}).filter(([, value]) => value !== undefined && value !== null);
  return entries.length ? `${address}?${new URLSearchParams(entries)}` : address;
};

/** @param {Response} answer */
const refusalOf = async (answer) => {
  const content = await answer.json().catch(() => ({}));
  const error = { message: t("the server returned status {status}", { status: answer.status }), ...content.error };
  return answer.status === 401 && error.text ? { ...error, message: error.text, hint: null } : error; // the hint of the error is for scripts
};

/** @param {Response} answer */
const nameOf = (answer) => {
  const header = answer.headers.get("Content-Disposition") ?? "";
  return header.match(/filename="([^"]+)"/)?.[1];
};
