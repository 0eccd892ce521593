/** Large tables of results, received as bytes. */

/** @type {{ [kind: string]: any }} */
const KINDS = {
  uint8: Uint8Array, int8: Int8Array, uint16: Uint16Array, int16: Int16Array, int32: Int32Array, float32: Float32Array,
};

/** Result with unpacked tables: nested arrays of rows.
 * @param {any} answer @returns {any} */
export const unpacked = (answer) => Object.fromEntries(Object.entries(answer).map(
  ([name, value]) => [name, value?.base64 === undefined ? value : rowsOf(value)],
));

/** @param {Server.Packed} packed */
const rowsOf = ({ kind, shape: [layers, rows, columns], base64 }) => {
  const values = new KINDS[kind](bytesOf(base64).buffer);
  /** @param {number} k */
  const row = (k) => values.subarray(k * columns, (k + 1) * columns);
  return Array.from({ length: layers }, (_, layer) => Array.from({ length: rows }, (__, k) => row(layer * rows + k)));
};

/** @param {string} base64 */
const bytesOf = (base64) => {
  const raw = atob(base64);
  const bytes = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k += 1) bytes[k] = raw.charCodeAt(k);
  return bytes;
};
