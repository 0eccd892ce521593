/** The motion that shook the body before it was let go from a lean, kept in this tab. */

const KEPT = "rocking.motion-before";
const USUAL = { pulse: "sine:amplitude=3,period=0.8" };

/** Keeps a motion to come back to. @param {Server.MotionInput | null} [motion] */
export const rememberMotion = (motion) => {
  if (!motion) return;
  try {
    sessionStorage.setItem(KEPT, JSON.stringify(motion));
  } catch {
    // a browser that keeps nothing comes back to the usual pulse
  }
};

/** Returns the motion to come back to: the last one, or a usual pulse. */
export const motionBefore = () => {
  try {
    return JSON.parse(sessionStorage.getItem(KEPT) ?? "null") ?? USUAL;
  } catch {
    return USUAL;
  }
};
