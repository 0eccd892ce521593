/** The list of studies as it is now: pushed by the server, asked for while there is no connection. */

const AGAIN = 2000;

/** Call `tell` with the list whenever it changes, between start() and stop(). */
export function liveStudies(app, tell) {
  let socket = null;
  let wanted = false;
  let timer = 0;

  const refresh = async () => {
    try {
      const answer = await app.call("/api/studies", { method: "GET" });
      tell(Array.isArray(answer) ? answer : answer.studies);
    } catch (error) {
      app.say(error.message, "error");
    }
  };

  const connect = () => {
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    socket = new WebSocket(`${scheme}//${location.host}/api/studies/live`);
    socket.addEventListener("message", (event) => {
      const told = JSON.parse(event.data);
      tell(Array.isArray(told) ? told : told.studies);
    });
    socket.addEventListener("close", () => {
      socket = null;
      if (!wanted) return;
      clearTimeout(timer);
      timer = setTimeout(() => wanted && (refresh(), connect()), AGAIN);
    });
  };

  return {
    refresh,
    start() {
      wanted = true;
      refresh();
      if (!socket) connect();
    },
    stop() {
      wanted = false;
      clearTimeout(timer);
      if (socket) socket.close();
    },
  };
}
