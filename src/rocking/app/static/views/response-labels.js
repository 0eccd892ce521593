/** Names and marks of the restitutions; every coefficient that was typed looks the same, whatever it is. */
import { dashKey, modelStyle, modelWords } from "/app/palette.js";

const TYPED = "fixed";

/** Returns the key under which a restitution keeps its curve: its label, or one key for typed numbers. */
export const curveKey = (label) => (/^([0-9.]+(e-?[0-9]+)?$|left )/.test(label) ? TYPED : label);

/** Returns colour and dash of a restitution. */
export const styleOf = (label) => modelStyle(curveKey(label));

/** Returns a restitution in words. */
export const wordsOf = (label) => modelWords(curveKey(label));

/** Returns a short line in the colour and the true dash of a restitution. */
export const swatch = (label) => dashKey(styleOf(label));
