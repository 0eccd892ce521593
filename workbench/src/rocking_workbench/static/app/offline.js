/** If the server does not respond, calls are repeated at intervals. When it responds, all data are requested. */

import { call } from "/app/api.js";

const EVERY = 2_000;

/** Run a function when the server responds again. @param {() => unknown} again */
export const whenBack = (again) => {
  let looking = false;
  const look = async () => {
    const back = await call("session").then(() => true, (error) => error.kind !== "offline");
    if (!back) return setTimeout(look, EVERY);
    looking = false;
    return again();
  };
  document.addEventListener("rocking:offline", () => {
    if (looking) return;
    looking = true;
    setTimeout(look, EVERY);
  });
};
