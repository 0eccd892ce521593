/** A canvas as a PNG on the page's background. */

import { colour } from "/charts/style.js";
import { saveBlob } from "/app/api.js";

/** Save a canvas as PNG; resolves to the blob. */
export const saveable = (canvas, title) =>
  new Promise((resolve) => {
    const sheet = Object.assign(
      document.createElement("canvas"), { width: canvas.width, height: canvas.height },
    );
    const paper = sheet.getContext("2d");
    paper.fillStyle = colour("--surface");
    paper.fillRect(0, 0, sheet.width, sheet.height);
    paper.drawImage(canvas, 0, 0);
    sheet.toBlob((blob) => {
      saveBlob(blob, `${slug(title)}.png`);
      resolve(blob);
    });
  });

const slug = (title) => title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "chart";
