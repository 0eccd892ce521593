/** The shapes that can be chosen, with their fields. */

const SIDES = { unit: "", min: 3, max: 10000, step: 1, integer: true };

/** Shapes with their fields; a field is a length by default. */
/** @type {{ [shape: string]: { label: string, fields: [string, string, any?][] } }} */
export const SHAPES = {
  block: { label: "Block", fields: [["width", "Width"], ["height", "Height"]] },
  trapezoid: {
    label: "Trapezoid",
    fields: [
      ["base", "Base"], ["top", "Top"], ["height", "Height"],
      ["lean", "Lean", { min: null, help: "Shift of the top to the right." }],
    ],
  },
  ellipse: {
    label: "Ellipse",
    fields: [
      ["width", "Width"], ["height", "Height"],
      ["sides", "Sides", SIDES],
    ],
  },
  regular_polygon: {
    label: "Regular polygon",
    fields: [["sides", "Sides", SIDES], ["radius", "Radius"]],
  },
  section: { label: "Polygon", fields: [] },
};
