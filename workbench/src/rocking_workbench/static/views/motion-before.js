/** Motion before the start from an initial rotation, kept in this tab. */

const KEPT = "rocking.motion-before";
const USUAL = { pulse: "sine:amplitude=3,period=0.8" };

/** @param {App} app */
const keyOf = (app) => `${KEPT}.${app.project.here.value.id}`;

/** Keeps a motion to come back to, in its project. @param {App} app @param {Server.MotionInput | null} [motion] */
export const rememberMotion = (app, motion) => {
  if (!motion) return;
  try {
    sessionStorage.setItem(keyOf(app), JSON.stringify(motion));
  } catch {
    // a browser that keeps nothing comes back to the usual pulse
  }
};

/** Returns the motion to come back to: the last one, or a usual pulse. @param {App} app */
export const motionBefore = (app) => {
  try {
    return JSON.parse(sessionStorage.getItem(keyOf(app)) ?? "null") ?? USUAL;
  } catch {
    return USUAL;
  }
};
