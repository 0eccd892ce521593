/** Content of a file. */

import { t } from "/app/words.js";

/** Bytes of a file at present, independent of later changes on the disk. @param {File} file */
export const contentOf = (file) => file.arrayBuffer().catch(() => {
  throw new Error(t("{name} is no longer readable. Choose the file again.", { name: file.name }));
});
