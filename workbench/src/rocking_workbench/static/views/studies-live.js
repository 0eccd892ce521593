/** Current studies: pushed by the server, polled without a connection. */

import { signal } from "/parts/preact.js";

const AGAIN = 2000;

/** `all` is a signal of the studies, kept up to date between start() and stop(). @param {App} app */
export const liveStudies = (app) => {
  const all = signal([]);
  /** @type {WebSocket | null} */
  let socket = null;
  let isActive = false;
  let timer = 0;

  /** @param {Server.Studies} answer */
  const take = (answer) => (all.value = answer.studies);
  const refresh = () => app.call("studies").then(take, (error) => app.say(error.message, "error"));
  const connect = () => {
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    socket = new WebSocket(`${scheme}//${location.host}/api/studies/live`);
    socket.addEventListener("message", (event) => take(JSON.parse(event.data)));
    socket.addEventListener("close", () => {
      socket = null;
      clearTimeout(timer);
      if (isActive) timer = setTimeout(start, AGAIN);
    });
  };
  const start = () => {
    isActive = true;
    refresh();
    if (!socket) connect();
  };
  const stop = () => {
    isActive = false;
    clearTimeout(timer);
    socket?.close();
  };
  return { all, refresh, start, stop };
};
