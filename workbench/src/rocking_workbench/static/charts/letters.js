/** Widths of texts, and line breaks. */

const pen = /** @type {CanvasRenderingContext2D} */ (document.createElement("canvas").getContext("2d"));

/** @param {{ fontWeight: string, fontSize: string, fontFamily: string }} style */
export const fontOf = ({ fontWeight, fontSize, fontFamily }) => `${fontWeight} ${fontSize} ${fontFamily}`;

/** Size of a text in a font. @param {string} text @param {string} [font] */
export const measured = (text, font = "12px system-ui, sans-serif") => {
  pen.font = font;
  return pen.measureText(text);
};

/** Lines of a text with a maximum width. @param {string} text @param {number} width @param {string} font */
export const wrapped = (text, width, font) => {
  /** @type {string[]} */
  const lines = [];
  const pieces = text.match(/[\u2e80-\u9fff]|[^ \u2e80-\u9fff]+ ?/g) ?? [];
  for (const piece of pieces.flatMap((piece) => (measured(piece, font).width > width ? [...piece] : [piece]))) {
    const longer = `${lines.at(-1) ?? ""}${piece}`;
    if (lines.length && measured(longer.trimEnd(), font).width <= width) lines[lines.length - 1] = longer;
    else lines.push(piece);
  }
  return lines.map((line) => line.trimEnd());
};
