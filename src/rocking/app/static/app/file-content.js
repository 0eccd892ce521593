/** What a file holds. */

import { t } from "/app/words.js";

/** The bytes of a file as it is now; they are kept, whatever becomes of it on the disk. @param {File} file */
export const contentOf = (file) => file.arrayBuffer().catch(() => {
  throw new Error(t("{name} is no longer readable. Choose the file again.", { name: file.name }));
});
