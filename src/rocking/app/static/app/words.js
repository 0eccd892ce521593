/** The page in another language: scripts say English, and one catalogue has every text of theirs, looked up exactly. */

import { number } from "/app/format.js";

/** @type {{ [code: string]: string }} */
const NAMES = { en: "English", de: "Deutsch", it: "Italiano", zh: "中文" };
const KEY = "rocking.language";
const ATTRIBUTES = ["aria-label", "title", "placeholder", "alt", "aria-description", "aria-valuetext", "label"];
const UNTOUCHED = ["pre", "code", "textarea", "script", "style"]; // elements whose text stays as it is
const PLACE = /\{(\w+)(?::\.?(\d*)(\w))?\}/g; // {name}, or {name:.3g} of a number

/** @type {Map<string, string | string[]>} */
const catalogue = new Map(); // translations by their English texts; of a text with plural forms a list of them

const choose = /** @type {HTMLSelectElement | null} */ (document.getElementById("language"));

/** The language of the page: the one that was chosen in this browser, or the first that it asks for. */
const chosen = () => {
  if (!choose) return "en"; // a page in English alone
  try {
    const kept = localStorage.getItem(KEY);
    if (kept && kept in NAMES) return kept;
  } catch {
    // Nothing is kept: the browser's own languages decide.
  }
  return navigator.languages.map((code) => code.slice(0, 2)).find((code) => code in NAMES) ?? "en";
};

export const language = chosen();
const plurals = new Intl.PluralRules(language);
const lists = new Intl.ListFormat(language === "en" ? "en-GB" : language);

/** An English text in the language of the page, its places filled; of [one, other] the form for the fact `count`.
 * @param {string | [string, string]} text @param {{ [name: string]: any }} [facts] @returns {string} */
export const t = (text, facts) => (facts ? filled(formOf(text, facts.count), facts) : words(/** @type {string} */ (text)));

/** @typedef {{ text: string, facts: { [name: string]: any }, many?: string, context?: string }} Message */

/** A message of the server. @param {Message} message @param {(fact: any) => string} [spelling] */
export const told = ({ text, many, context, facts }, spelling = spelled) =>
  filled(formOf(context ? `${context}\u0004${text}` : many ? [text, many] : text, facts.count) ?? text, facts, spelling);

/** A text in the language of the page without its places filled. @param {string | [string, string]} text @param {number} [count] @returns {string} */
const formOf = (text, count = 1) => {
  const forms = catalogue.get(typeof text === "string" ? text : text[0]) ?? text;
  return typeof forms === "string" ? forms : forms[plurals.select(count) === "one" ? 0 : forms.length - 1];
};

/** @param {string} form @param {{ [name: string]: any }} facts @param {(fact: any) => string} [spelling] */
const filled = (form, facts, spelling = spelled) => form.replace(PLACE, (place, name, digits, kind) => {
  if (!(name in facts)) return place;
  if (kind) return kind === "f" ? facts[name].toFixed(digits || 6) : number(facts[name], Number(digits || 6));
  return spelling(facts[name]);
});

// A word in a place has its translation too.
/** @param {any} fact @returns {string} */
const spelled = (fact) => (typeof fact === "string" ? words(fact) : String(fact));

/** Some parts as one list: a, b and c. @param {string[]} parts */
export const listed = (parts) => lists.format(parts);

/** A text of the page in its language, with the spaces around it. @param {string} text */
const words = (text) => {
  const bare = text.trim();
  const translated = bare && catalogue.get(bare.replace(/\s+/g, " "));
  return typeof translated === "string" ? text.replace(bare, () => translated) : text;
};

/** What an element contains, in the language of the page: all texts but those of users.
 * @type {<Of>(tag: unknown, attributes: any, children: readonly Of[]) => readonly Of[]} */
export const childrenInWords = (tag, attributes, children) => (!catalogue.size || stays(tag, attributes) ? children : children.map(inWords));

/** The attributes of an element in the language of the page. @param {unknown} tag @param {any} attributes */
export const attributesInWords = (tag, attributes) => {
  if (!catalogue.size || !attributes || stays(tag, attributes)) return attributes;
  const texts = ATTRIBUTES.filter((name) => typeof attributes[name] === "string").map((name) => [name, words(attributes[name])]);
  return texts.length ? { ...attributes, ...Object.fromEntries(texts) } : attributes;
};

/** @param {any} child @returns {any} */
const inWords = (child) => (typeof child === "string" ? words(child) : Array.isArray(child) ? child.map(inWords) : child);

/** @param {any} tag @param {any} attributes */
const stays = (tag, attributes) => UNTOUCHED.includes(tag) || [false, "no"].includes(attributes?.translate);

// The page as its file has it, before any script draws.
/** @param {Element} element */
const translate = (element) => {
  if (stays(element.localName, { translate: element.getAttribute("translate") })) return;
  for (const name of ATTRIBUTES) if (element.hasAttribute(name)) element.setAttribute(name, words(element.getAttribute(name) ?? ""));
  for (const node of element.childNodes) if (node instanceof Text) node.data = words(node.data);
  for (const child of element.children) translate(child);
};

// What the server still says in finished sentences is taken apart; what appears is looked at before it is painted.
const MOST = 5000; // texts whose words are remembered
const LONGEST = 4000; // of a text that is taken apart [characters]

const WORD = /[A-Za-z]{3}/;
const NAME = /^[\p{Lu}\d“"]|^\S+$/u; // "Delete Left wing": what somebody named
const SENTENCES = /[.;?] |[.;:?]$/;
const JOINTS = [/(?<=[.?]) /, /(?<=;) /, /(?<=^[^:]*:) /];
/** @param {string} part */
const isProse = (part) => (part.match(/[A-Za-z]{3,}/g)?.length ?? 0) > 1 && part.includes(" ");
/** @type {{ [mark: string]: string | undefined }} */
const WIDE = { ".": "。", ";": "；", ":": "：", "?": "？" };

/** @param {string} text @returns {string | undefined} */
const exactly = (text) => (typeof catalogue.get(text) === "string" ? /** @type {string} */ (catalogue.get(text)) : undefined);

/** @typedef {{ pattern: RegExp, places: string[], other: string, weak: boolean, names: boolean, own: string[], length: number, order: number }} Form */

/** @type {Map<string, Form[]>} */
const byWord = new Map(); // sentences with places by the rarest of their words; "" for those without
/** @type {Map<string, string | undefined>} */
const found = new Map();
/** @type {WeakMap<Node, string>} */
const written = new WeakMap();

/** What an English text is in the language of the page. @param {string} text */
export const wholeSentences = (text) => {
  const bare = text.trim();
  if (!bare || catalogue.size === 0) return text;
  const inside = known(bare.replace(/[ \n\t]+/g, " ")) ?? bare;
  return text.slice(0, text.indexOf(bare)) + inside + text.slice(text.indexOf(bare) + bare.length);
};

/** What a text is; undefined where the catalogue does not have it, nor all of its sentences. @param {string} text */
const known = (text) => {
  if (!found.has(text)) {
    if (found.size > MOST) found.clear();
    found.set(text, taken(text));
  }
  return found.get(text);
};

/** @param {string} text */
const taken = (text) => {
  if (exactly(text) !== undefined || text.length > LONGEST || !/[A-Za-z]{2}/.test(text)) return exactly(text);
  const near = formsOf(text);
  return said(text, near, true) ?? joined(text) ?? said(text, near, false);
};

// Overturned; 3 impacts: said by "overturned" and "{0} impacts", all of it or nothing.
/** @param {string} text */
const joined = (text) => {
  for (const joint of JOINTS) {
    const parts = text.split(joint);
    if (parts.length === 1) continue;
    const others = parts.map((part) => known(part) ?? (WORD.test(part) && !/^\S+:$/.test(part) ? undefined : part));
    if (!others.includes(undefined)) return others.join(" ").replace(/(?<=[。；：？]) /g, "");
  }
  return undefined;
};

// A sentence as it is, or with another mark at its end and, where all of it is known, another capital.
/** @param {string} text @param {Form[]} near @param {boolean} whole */
const said = (text, near, whole) => {
  const [, stem, end] = /** @type {RegExpMatchArray} */ (text.match(/^(.+?)([.;:?]?)$/s));
  const low = whole && /[ .]/.test(text) ? stem[0].toLowerCase() + stem.slice(1) : stem;
  for (const [form, mark] of [[text, ""], [low + end, ""], [stem, end], [low, end]]) {
    const other = exactly(form) ?? completed(form, near, whole);
    if (other === undefined) continue;
    const marked = other + (language === "zh" ? WIDE[mark] ?? "" : mark);
    return form.startsWith(stem) ? marked : marked[0].toUpperCase() + marked.slice(1);
  }
  return undefined;
};

// With `whole`, what stands in the places must be known too, or a name, and no sentence of its own.
/** @param {string} text @param {Form[]} near @param {boolean} whole */
const completed = (text, near, whole) => {
  for (const form of near) {
    const match = form.pattern.exec(text)?.slice(1);
    if (!match || (whole && match.some((part) => SENTENCES.test(part)))) continue;
    const inside = match.map((part) => known(part) ?? (WORD.test(part) ? undefined : part));
    if (!fits(form, match, inside, whole)) continue;
    const places = new Map(form.places.map((place, k) => [place, inside[k] ?? match[k]]));
    return form.other.replace(/\{[^}]+\}/g, (place) => places.get(place) ?? "");
  }
  return undefined;
};

// "{0} to {1}" with words in its places is a sentence that somebody else has made; "Delete {0}" takes any name.
/** @param {Form} form @param {string[]} match @param {(string | undefined)[]} inside @param {boolean} whole */
const fits = ({ weak, names }, match, inside, whole) => {
  const strange = match.filter((_, k) => inside[k] === undefined);
  if (weak) return names ? strange.every((part) => NAME.test(part)) : !match.some((part) => WORD.test(part));
  return !whole || !strange.some(isProse);
};

/** The sentences with places that share their rarest word with a text, the longest first. @param {string} text */
const formsOf = (text) => {
  const near = new Set(byWord.get(""));
  for (const word of wordsOf(text)) for (const form of byWord.get(word) ?? []) near.add(form);
  return [...near].sort((one, two) => one.order - two.order);
};

/** @param {string} text */
const wordsOf = (text) => new Set(text.toLowerCase().match(/[a-z]+/g));

/** @param {{ [english: string]: string | string[] }} messages */
const learn = (messages) => {
  /** @type {Omit<Form, "order">[]} */
  const forms = [];
  /** @type {Map<string, number>} */
  const times = new Map();
  for (const [english, other] of Object.entries(messages)) {
    const places = english.match(/\{[^}]+\}/g);
    if (!places || typeof other !== "string") continue;
    const parts = english.split(/\{[^}]+\}/).map((part) => part.replace(/[.*+?^${}()|[\]\\]/g, "\\$&"));
    const pattern = new RegExp(`^${parts.join("(.+?)")}$`, "s");
    const [short, long] = [/[A-Za-z]{2,}/g, /[A-Za-z]{3,}/g].map((word) => english.match(word)?.length ?? 0);
    // A word that touches a place may be but a part of one.
    const own = [...wordsOf(english.replace(/[A-Za-z]*\{\d+\}[A-Za-z]*/g, " "))];
    for (const word of own) times.set(word, (times.get(word) ?? 0) + 1);
    const weak = long < 2 && short < 3;
    forms.push({ pattern, places, other, weak, names: /^[A-Z]/.test(english), own, length: english.length });
  }
  forms.sort((one, two) => two.length - one.length);
  for (const [order, form] of forms.entries()) {
    const [rarest = ""] = form.own.sort((one, two) => (times.get(one) ?? 0) - (times.get(two) ?? 0));
    byWord.set(rarest, [...(byWord.get(rarest) ?? []), { ...form, order }]);
  }
};

/** @param {Element | null} [element] */
const kept = (element) => element?.closest("pre, code, textarea, [translate=no]") !== null;

/** @param {Text} node */
const sayText = (node) => {
  if (written.get(node) === node.data || kept(node.parentElement)) return;
  const other = wholeSentences(node.data);
  written.set(node, other);
  if (other !== node.data) node.data = other;
};

/** @param {Element} element @param {string} name */
const sayAttribute = (element, name) => {
  const value = element.getAttribute(name);
  if (value === null || kept(element)) return;
  const other = wholeSentences(value);
  if (other !== value) element.setAttribute(name, other);
};

/** Say a part of the page, or a picture that is not in it, in the language of the page.
 * @param {Node} node @returns {void} */
const sayAll = (node) => {
  if (catalogue.size === 0) return undefined;
  if (node.nodeType === Node.TEXT_NODE) return sayText(/** @type {Text} */ (node));
  if (node.nodeType !== Node.ELEMENT_NODE) return undefined;
  for (const name of ATTRIBUTES) sayAttribute(/** @type {Element} */ (node), name);
  return node.childNodes.forEach(sayAll);
};

const watch = () => {
  sayAll(document.documentElement);
  new MutationObserver((changes) => {
    for (const { type, target, addedNodes, attributeName } of changes) {
      if (type === "characterData") sayText(/** @type {Text} */ (target));
      else if (type === "attributes") sayAttribute(/** @type {Element} */ (target), attributeName ?? "");
      else addedNodes.forEach(sayAll);
    }
  }).observe(document.documentElement, {
    subtree: true, childList: true, characterData: true, attributes: true, attributeFilter: ATTRIBUTES,
  });
};

choose?.append(...Object.entries(NAMES).map(([code, name]) => new Option(name, code, false, code === language)));
choose?.addEventListener("change", () => {
  localStorage.setItem(KEY, choose.value);
  location.reload();
});

if (language !== "en") {
  document.documentElement.lang = language;
  const answer = await fetch(`/words/${language}.json`).catch(() => null);
  if (answer?.ok) {
    for (const [text, translated] of Object.entries(await answer.json())) catalogue.set(text, translated);
    translate(document.documentElement);
    learn(Object.fromEntries(catalogue));
    watch();
  }
}
