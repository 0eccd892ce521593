/** When the server stops answering: look for it now and then, and ask again once it is back. */

import { call } from "/app/api.js";

const EVERY = 2_000;

/** Run a function whenever the server answers again after it did not. @param {() => unknown} again */
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
