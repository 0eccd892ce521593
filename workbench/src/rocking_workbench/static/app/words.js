/** Translation of the page: scripts contain English texts; one catalogue contains all translations. */

import { fixed, number } from "/app/format.js";
import { KEY, NAMES, choose, language } from "/app/language.js";

const ATTRIBUTES = ["aria-label", "title", "placeholder", "alt", "aria-description", "aria-valuetext", "label"];
const UNTOUCHED = ["pre", "code", "textarea", "script", "style"]; // elements with unchanged text
const PLACE = /\{(\w+)(!r)?(?::\.?(\d*)(\w?))?\}/g; // fields: {name}, {name:.3g} for a number, {name!r:.40} for a name in quotes

/** @type {Map<string, string | string[]>} */
const catalogue = new Map(); // translations by their English texts; a list if a text has plural forms

const plurals = new Intl.PluralRules(language);
const lists = new Intl.ListFormat(language === "en" ? "en-GB" : language);

/** Translation of an English text with its values; for [singular, plural] the form for the value `count`.
 * @param {string | [string, string]} text @param {{ [name: string]: any }} [facts] @returns {string} */
export const t = (text, facts) => (facts ? filled(formOf(text, facts.count), facts) : translatedText(/** @type {string} */ (text)));

/** @typedef {{ text: string, facts: { [name: string]: any }, many?: string, context?: string }} Message */

/** A message of the server. @param {Message} message @param {(fact: any) => string} spelling */
export const messageText = ({ text, many, context, facts }, spelling) => filled(formOf(many ? [text, many] : text, facts.count, context), facts, spelling);

/** Translation of a text; its fields are not filled.
 * @param {string | [string, string]} text @param {number} [count] @param {string} [context] @returns {string} */
const formOf = (text, count = 1, context = "") => {
  const singular = typeof text === "string" ? text : text[0];
  const forms = catalogue.get(context ? `${context}\u0004${singular}` : singular) ?? text;
  return typeof forms === "string" ? forms : forms[plurals.select(count) === "one" ? 0 : forms.length - 1];
};

/** @param {string} form @param {{ [name: string]: any }} facts @param {(fact: any) => string} [spelling] */
const filled = (form, facts, spelling = spelled) => form.replace(PLACE, (match, name, quoted, digits, kind) => {
  if (!(name in facts)) return match;
  if (quoted) return `'${String(facts[name]).slice(0, digits || undefined)}'`;
  if (kind && typeof facts[name] === "number") return kind === "f" ? fixed(facts[name], Number(digits || 6)) : number(facts[name], Number(digits || 6));
  return spelling(facts[name]);
});

// A word in a field of a text is translated too.
/** @param {any} fact @returns {string} */
const spelled = (fact) => (typeof fact === "string" ? translatedText(fact) : String(fact));

/** Name of a user in a text: t() does not translate it. @param {string} name */
export const userText = (name) => new String(name);

/** Register the messages of a result, so that their sentences are translated.
 * @param {any} answer @param {(message: any) => string} spelling */
export const learnMessages = (answer, spelling) => {
  if (!catalogue.size) return;
  for (const [sentence, message] of Object.entries({ ...answer?.messages, ...answer?.answer?.messages })) catalogue.set(sentence, spelling(message));
};

const locale = navigator.languages.find((code) => code.slice(0, 2) === language) ?? language;

/** A date and its time of day. @param {string} time */
export const dateTime = (time) => new Date(time).toLocaleString(locale, { dateStyle: "medium", timeStyle: "short" });

/** Items as one list: a, b and c. @param {string[]} parts */
export const listed = (parts) => lists.format(parts);

/** Translation of a text of the page, with the surrounding spaces. @param {string} text */
const translatedText = (text) => {
  const bare = text.trim();
  const translated = bare && catalogue.get(bare.replace(/[ \n\t]+/g, " "));
  return typeof translated === "string" ? text.replace(bare, () => translated) : text;
};

/** Translate all texts of an element except those of users.
 * @type {<Of>(tag: unknown, attributes: any, children: readonly Of[]) => readonly Of[]} */
export const childrenInWords = (tag, attributes, children) => (!catalogue.size || stays(tag, attributes) ? children : children.map(inWords));

/** Translate the attributes of an element. @param {unknown} tag @param {any} attributes */
export const attributesInWords = (tag, attributes) => {
  if (!catalogue.size || !attributes || stays(tag, attributes)) return attributes;
  const texts = ATTRIBUTES.filter((name) => typeof attributes[name] === "string").map((name) => [name, translatedText(attributes[name])]);
  if (attributes.children !== undefined) texts.push(["children", inWords(attributes.children)]); // attributes that a component passes on
  return texts.length ? { ...attributes, ...Object.fromEntries(texts) } : attributes;
};

/** @param {any} child @returns {any} */
const inWords = (child) => (typeof child === "string" ? translatedText(child) : Array.isArray(child) ? child.map(inWords) : child);

/** @param {any} tag @param {any} attributes */
const stays = (tag, attributes) => UNTOUCHED.includes(tag) || [false, "no"].includes(attributes?.translate);

// Translates the static page, before any script draws.
/** @param {Element} element */
const translate = (element) => {
  if (stays(element.localName, { translate: element.getAttribute("translate") })) return;
  for (const name of ATTRIBUTES) if (element.hasAttribute(name)) element.setAttribute(name, translatedText(element.getAttribute(name) ?? ""));
  for (const node of element.childNodes) if (node instanceof Text) node.data = translatedText(node.data);
  for (const child of element.children) translate(child);
};

choose?.append(...Object.entries(NAMES).map(([code, name]) => new Option(name, code, false, code === language)));
choose?.addEventListener("change", () => {
  localStorage.setItem(KEY, choose?.value ?? language);
  location.reload();
});

if (language !== "en") {
  document.documentElement.lang = language;
  const answer = await fetch(`/words/${language}.json`).catch(() => null);
  if (answer?.ok) {
    for (const [text, translated] of Object.entries(await answer.json())) catalogue.set(text, translated);
    translate(document.documentElement);
    choose?.setAttribute("aria-label", t("Language"));
  }
}
