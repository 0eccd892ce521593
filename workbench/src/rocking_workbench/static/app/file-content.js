/** Content of a file. */

import { t } from "/app/words.js";

/** Present bytes of a file, independent of later changes on the disk. @param {File} file */
export const contentOf = (file) => file.arrayBuffer().catch(() => {
  throw new Error(t("{name} is no longer readable. Choose the file again.", { name: file.name }));
});
