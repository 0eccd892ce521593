/** The language of the page. */

/** @type {{ [code: string]: string }} */
export const NAMES = { en: "English", de: "Deutsch", it: "Italiano", zh: "中文" };
export const KEY = "rocking.language";

export const choose = /** @type {HTMLSelectElement | null} */ (document.getElementById("language"));

/** Language of the page: the choice in this browser, else its first preferred language. */
const chosen = () => {
  if (!choose) return "en"; // a page in English alone
  try {
    const kept = localStorage.getItem(KEY);
    if (kept && kept in NAMES) return kept;
  } catch {
    // No choice is stored: the languages of the browser apply.
  }
  return navigator.languages.map((code) => code.slice(0, 2)).find((code) => code in NAMES) ?? "en";
};

export const language = chosen();
