/** The page in another language. Scripts say English; whatever appears is looked up in one catalogue, before it is
 * painted: whole sentences, and sentences with something in their places. What is not in it stays as it is. */

const NAMES = { en: "English", de: "Deutsch", it: "Italiano", zh: "中文" };
const KEY = "rocking.language";
const ATTRIBUTES = ["aria-label", "title", "placeholder", "alt", "aria-description", "aria-valuetext", "label"];
const MOST = 5000; // texts whose words are remembered

const exact = new Map();
const forms = [];
const found = new Map();
const written = new WeakMap();

/** The language of the page: the one that was chosen in this browser, or the first that it asks for. */
const chosen = () => {
  try {
    const kept = localStorage.getItem(KEY);
    if (kept in NAMES) return kept;
  } catch {
    // Nothing is kept: the browser's own languages decide.
  }
  return navigator.languages.map((each) => each.slice(0, 2)).find((each) => each in NAMES) ?? "en";
};

export const language = chosen();

/** What an English text is in the language of the page. */
export const words = (text) => {
  const bare = text.trim();
  if (!bare || exact.size === 0) return text;
  const inside = found.get(bare) ?? remember(bare, looked(bare.replace(/[ \n\t]+/g, " ")) ?? bare);
  return text.slice(0, text.indexOf(bare)) + inside + text.slice(text.indexOf(bare) + bare.length);
};

const remember = (text, inside) => {
  if (found.size > MOST) found.clear();
  found.set(text, inside);
  return inside;
};

const looked = (text) => {
  if (exact.has(text)) return exact.get(text);
  for (const { pattern, places, other, weak } of forms) {
    const match = pattern.exec(text);
    // "{0} to {1}" with words in its places is a sentence that somebody else has made
    if (!match || (weak && match.slice(1).some((part) => /[A-Za-z]{3}/.test(part)))) continue;
    const inside = new Map(places.map((place, k) => [place, words(match[k + 1])]));
    return other.replace(/\{\d+\}/g, (place) => inside.get(place));
  }
  return undefined;
};

const learn = (catalogue) => {
  for (const [english, other] of Object.entries(catalogue)) {
    const places = english.match(/\{\d+\}/g);
    if (!places) {
      exact.set(english, other);
      continue;
    }
    const said = english.split(/\{\d+\}/).map((part) => part.replace(/[.*+?^${}()|[\]\\]/g, "\\$&"));
    const weak = (english.match(/[A-Za-z]{3,}/g) ?? []).length < 2;
    forms.push({ pattern: new RegExp(`^${said.join("(.+?)")}$`, "s"), places, other, weak, length: english.length });
  }
  forms.sort((one, two) => two.length - one.length);
};

const stays = (element) => element?.closest("pre, code, textarea, [translate=no]") !== null;

const sayText = (node) => {
  if (written.get(node) === node.data || stays(node.parentElement)) return;
  const other = words(node.data);
  written.set(node, other);
  if (other !== node.data) node.data = other;
};

const sayAttribute = (element, name) => {
  const value = element.getAttribute(name);
  if (value === null || stays(element)) return;
  const other = words(value);
  if (other !== value) element.setAttribute(name, other);
};

const sayAll = (node) => {
  if (node.nodeType === Node.TEXT_NODE) return sayText(node);
  if (node.nodeType !== Node.ELEMENT_NODE) return undefined;
  for (const name of ATTRIBUTES) sayAttribute(node, name);
  return node.childNodes.forEach(sayAll);
};

const watch = () => {
  sayAll(document.documentElement);
  new MutationObserver((changes) => {
    for (const { type, target, addedNodes, attributeName } of changes) {
      if (type === "characterData") sayText(target);
      else if (type === "attributes") sayAttribute(target, attributeName);
      else addedNodes.forEach(sayAll);
    }
  }).observe(document.documentElement, {
    subtree: true, childList: true, characterData: true, attributes: true, attributeFilter: ATTRIBUTES,
  });
};

const choose = document.getElementById("language");
choose.append(...Object.entries(NAMES).map(([code, name]) => new Option(name, code, false, code === language)));
choose.addEventListener("change", () => {
  localStorage.setItem(KEY, choose.value);
  location.reload();
});

if (language !== "en") {
  document.documentElement.lang = language;
  const answer = await fetch(`/words/${language}.json`).catch(() => null);
  if (answer?.ok) {
    learn(await answer.json());
    watch();
  }
}
