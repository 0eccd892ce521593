/** Motion before the start from an initial rotation, kept in this tab. */

const KEPT = "rocking.motion-before";
const USUAL = { pulse: "sine:amplitude=3,period=0.8" };

/** @param {App} app */
const keyOf = (app) => `${KEPT}.${app.project.here.value.id}`;

/** Stores the motion of the project for the return from a free start. @param {App} app @param {Server.MotionInput | null} [motion] */
export const rememberMotion = (app, motion) => {
  if (!motion) return;
  try {
    sessionStorage.setItem(keyOf(app), JSON.stringify(motion));
  } catch {
    // browsers without storage return to the default pulse
  }
};

/** Returns the stored motion, or a default pulse. @param {App} app */
export const motionBefore = (app) => {
  try {
    return JSON.parse(sessionStorage.getItem(keyOf(app)) ?? "null") ?? USUAL;
  } catch {
    return USUAL;
  }
};
