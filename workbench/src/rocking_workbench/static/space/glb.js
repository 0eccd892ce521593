/** Reads the binary glTF file that the commands write for a 3D body. */

/** @type {{ [kind: number]: any }} */
const ARRAYS = { 5126: Float32Array, 5125: Uint32Array, 5121: Uint8Array };
/** @type {{ [kind: string]: number }} */
const WIDTHS = { SCALAR: 1, VEC3: 3, VEC4: 4 };

/** Arrays of the file, and the values in `extras.rocking`. Coordinates are relative to the centre of mass, with z up.
 * @param {ArrayBuffer} buffer @returns {SpaceModel} */
export const readGlb = (buffer) => {
  const length = new DataView(buffer).getUint32(12, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 20, length)));
  /** @param {number} [number] @returns {any} */
  const array = (number) => {
    if (number === undefined) return null;
    const { bufferView, componentType, count, type } = header.accessors[number];
    const at = 28 + length + header.bufferViews[bufferView].byteOffset;
    return new ARRAYS[componentType](buffer, at, count * WIDTHS[type]);
  };
  const [{ attributes, indices }] = header.meshes[0].primitives;
  const [turns, centres] = header.animations?.[0].samplers ?? [];
  const { tilt, hull, mended, ...extras } = header.extras.rocking;
  return {
    ...extras,
    points: array(attributes.POSITION), faces: array(indices), colours: array(attributes.COLOR_0), hull: array(hull), mended: array(mended),
    motion: turns ? {
      time: array(turns.input), turn: array(turns.output), centre: array(centres.output), tilt: array(tilt),
    } : null,
  };
};
