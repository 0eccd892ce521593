/** Elements of forms: fields with a label, a unit and an error text; buttons, cards, notes.
 * `value` is a signal, or a plain value with a callback `on` for changes. */

import { createContext, html, useContext, useLayoutEffect, useRef, useState } from "/parts/preact.js";
import { freshId } from "/app/dom.js";
import { faults } from "/app/faults.js";
import { editable, number, parseNumber, pretty, quantity, tidy } from "/app/format.js";
import { language } from "/app/language.js";
import { t } from "/app/words.js";

/** @param {string} stem */
const useId = (stem) => useRef(freshId(stem)).current;

/** @param {any} value @param {((value: any) => unknown)} [on] @returns {[any, (next: any) => unknown]} */
const bound = (value, on) => (value !== null && typeof value === "object"
  ? [value.value, (next) => (value.value = next)] : [value, (next) => on?.(next)]);

// Text of a box as typed, until `now` changes.
/** @param {any} now @param {(value: any) => string} written @param {(text: string, now: any) => boolean} says @returns {[{ text: string, fault: string, now: any }, (text: string, fault?: string) => void]} */
const useTyped = (now, written, says) => {
  const [, draw] = useState();
  const held = useRef({ text: written(now), now, fault: "" }).current;
  if (held.now !== now) Object.assign(held, { now, fault: "" }, says(held.text, now) ? {} : { text: written(now) });
  /** @param {string} text */
  const type = (text, fault = "") => {
    Object.assign(held, { text, fault });
    draw({});
  };
  return [held, type];
};

/** Rejection of a form: `key` of the field and `text`; `past` after a change of the field. */
export const Refused = createContext({});

/** Rejection of a field, until it changes. @param {string} [name] @returns {[string, () => void]} */
export const useRefused = (name) => {
  const refused = useContext(Refused);
  const stands = name && refused.key === name;
  return [stands && !refused.past ? refused.text : "", () => stands && (refused.past = true)];
};

/** An input element with the label and the help of a field.
 * @param {FieldProps<any> & { id: string, beside?: any, children?: any }} props */
export const Frame = ({ id, label, unit, beside, error, help, kind = "", hidden, children }) => html`
  <div class=${`field ${kind}`} hidden=${hidden}>
    <div class="field-head"><label for=${id}>${label}${unit && html`<span class="unit">${` ${pretty(unit)}`}</span>`}</label>${beside}</div>
    ${children}
    <p id=${`${id}-about`} class=${`field-help ${error ? "field-error" : ""}`}>${error || help}</p>
  </div>`;

// Attributes of every box: name, description, validity.
/** @param {string} id @param {string} [error] */
const saidOf = (id, error) => ({ id, "aria-describedby": `${id}-about`, "aria-invalid": error ? "true" : null });

/** @type {{ [key: string]: number | undefined }} */
const TURNS = { ArrowUp: 1, ArrowDown: -1 };

/** Number with its unit; decimal commas and arrow keys are allowed. `on` receives numbers within the limits only, and
 * null for an empty optional field. With `moves`, the number 0 is an error. With `aside`, an error of the field does not
 * count as an error of the inputs.
 * @param {NumberProps} props */
export const NumberField = ({
  label, unit = "", value, on, help, error = "", kind, hidden, min, above, max, step, integer, moves, optional, aside = false,
  ...more
}) => {
  const id = useId("number");
  const box = useRef(null);
  const [now, put] = bound(value, on);
  const [held, type] = useTyped(now ?? null, editable, saysNumber);
  const wrong = held.fault || error;
  useLayoutEffect(() => void (aside || faults.mark(box.current, label, wrong)), [label, wrong]);
  useLayoutEffect(() => faults.mark.bind(null, box.current, "", ""), []);
  /** @param {string} text */
  const take = (text) => {
    const { fault = "", parsed } = checked(text, { min, above, max, integer, moves, optional, unit });
    type(text, fault);
    if (!fault) put(parsed);
  };
  /** @param {KeyboardEvent} event */
  const turn = (event) => {
    const turns = (TURNS[event.key] ?? 0) * (event.shiftKey ? 10 : 1);
    if (!turns) return;
    event.preventDefault();
    take(editable(stepped(held.text, turns, { min: min ?? above, max, step })));
  };
  return html`<${Frame} id=${id} label=${label} unit=${unit} help=${decimalWords(held.text) || help} error=${wrong} kind=${kind} hidden=${hidden}>
    <input ...${saidOf(id, wrong)} ref=${box} type="text" inputmode="decimal" autocomplete="off" spellcheck=${false}
      value=${held.text} onInput=${({ target }) => take(target.value)} onKeyDown=${turn} ...${more} /><//>`;
};

/** Line of text, or a "textarea" according to `tag`; `type`: type of the box.
 * @param {FieldProps<any> & { id?: string, tag?: string, type?: string }} props */
export const Field = ({
  label, id: givenId, name, unit, value, on, help, error: message = "", kind, hidden, tag = "input", type = "text", ...more
}) => {
  const own = useId("field");
  const id = givenId ?? own;
  const [now, put] = bound(value, on);
  const [refused, changed] = useRefused(name);
  const error = message || refused;
  const [held, typed] = useTyped(now ?? "", String, saysText);
  /** @param {any} event */
  const take = ({ target }) => {
    changed();
    typed(target.value);
    put(target.value);
  };
  return html`<${Frame} id=${id} label=${label} unit=${unit} help=${help} error=${error} kind=${kind} hidden=${hidden}>
    <${tag} ...${saidOf(id, error)} type=${tag === "input" ? type : null} autocomplete="off" value=${held.text} onInput=${take} ...${more} /><//>`;
};

/** Choice from a list of [value, label]; `chosen` is the initial value, `own` are options named by users.
 * @param {FieldProps<any> & { chosen?: unknown, own?: boolean, options: [any, string][] }} props */
export const Choice = ({ label, name, value, on, chosen, options, own = false, help, error: message = "", hidden, ...more }) => {
  const id = useId("choice");
  const [refused, changed] = useRefused(name);
  const error = message || refused;
  const [now, put] = bound(value, on);
  const shown = String(chosen ?? now ?? "");
  /** @param {any} event */
  const take = ({ target }) => {
    changed();
    put(options[target.selectedIndex][0]);
    target.value = shown; // the old choice remains visible until the form accepts the new choice
  };
  return html`<${Frame} id=${id} label=${label} help=${help} error=${error} hidden=${hidden}>
    <select ...${saidOf(id, error)} value=${shown} onChange=${take} ...${more}>
      ${options.map(([key, text]) => html`<option key=${key} value=${String(key)} translate=${own ? "no" : null}>${text}</option>`)}</select><//>`;
};

/** Choice of one value from [value, label], all visible.
 * @param {FieldProps<any> & { options: [any, string][] }} props */
export const Segmented = ({ label, value, on, options, hidden }) => {
  const name = useId("choice");
  const [now, put] = bound(value, on);
  return html`<fieldset class="segmented" hidden=${hidden}><legend>${label}</legend><div class="segments">
    ${options.map(([key, text]) => html`<label class="segment" key=${key}>
      <input type="radio" name=${name} value=${String(key)} checked=${key === now} onChange=${() => put(key)} /><span>${text}</span></label>`)}
  </div></fieldset>`;
};

/** Yes or no. @param {FieldProps<boolean>} props */
export const Switch = ({ label, value, on, help, hidden }) => {
  const id = useId("switch");
  const [now, put] = bound(value, on);
  return html`<div class="field field-switch" hidden=${hidden}>
    <label for=${id}><input id=${id} type="checkbox" checked=${now} aria-describedby=${`${id}-about`}
      onChange=${({ target }) => put(target.checked)} /><span>${label}</span></label>
    <p id=${`${id}-about`} class="field-help">${help}</p></div>`;
};

/** Slider with its value next to the label, logarithmic on request.
 * @param {FieldProps<number> & { min: number, max: number, step?: number, log?: boolean }} props */
export const Slider = ({ label, unit = "", value, on, min, max, step, log = false, help, hidden }) => {
  const id = useId("slider");
  const [now, put] = bound(value, on);
  const scale = log ? logarithmic(min, max) : { low: min, high: max, step: step ?? "any", from: (/** @type {number} */ value) => value, to: tidy };
  const text = quantity(now, unit);
  const beside = html`<output for=${id} class="slider-value">${text}</output>`;
  return html`<${Frame} id=${id} label=${label} beside=${beside} help=${help} kind="field-slider" hidden=${hidden}>
    <input ...${saidOf(id)} type="range" min=${scale.low} max=${scale.high} step=${scale.step} value=${scale.from(now)}
      aria-valuetext=${text} onInput=${({ target }) => put(scale.to(Number(target.value)))} /><//>`;
};

/** @type {{ [word: string]: string | undefined }} */
const YES = { true: "yes", false: "no" };

/** Field of a key, with its unit, description and allowed values.
 * @param {FieldProps<string> & { name: string, facts: Server.KeyFacts }} props */
export const KeyField = ({ name, facts, ...more }) => {
  const label = name.replaceAll("_", " ");
  if (!facts.choices.length) {
    return html`<${Field} name=${name} label=${label} unit=${facts.unit.replace(/^-$/, "")} help=${sentence(facts.description)}
      placeholder=${facts.usual} ...${more} />`;
  }
  const others = facts.choices.filter((word) => word !== facts.usual).map((word) => [word, YES[word] ?? word]);
  return html`<${Choice} name=${name} label=${label} help=${sentence(facts.description)} ...${more}
    options=${[["", YES[facts.usual] ?? (facts.usual || "\u2013")], ...others]} />`;
};

/** A text with a capital letter at its start. @param {string} text */
const capital = (text) => text.slice(0, 1).toUpperCase() + text.slice(1);

/** Translated text with a full stop; the catalogue may contain it as a sentence. @param {string} text */
export const stopped = (text) => {
  const sentenceText = [`${text}.`, `${capital(text)}.`].find((form) => t(form) !== form);
  if (sentenceText) return t(sentenceText);
  return `${t(text)}${/[.!?\u3002\uff1f]$/.test(t(text)) ? "" : language === "zh" ? "\u3002" : "."}`;
};

/** Text as a sentence; a file name at its beginning is unchanged. @param {string} text */
export const sentence = (text) => (/^\S*\.\w/.test(text) ? stopped(text) : capital(stopped(text)));

/** The first visible field of a form with an error. @param {Element} form */
export const wrongIn = (form) => /** @type {HTMLElement[]} */ ([...form.querySelectorAll("[aria-invalid=true], .drop.wrong .button")]).find((box) => box.offsetParent !== null);

/** Focus the first invalid field after drawing. @param {Element} form */
export const toWrong = (form) => setTimeout(() => {
  for (const box of form.querySelectorAll("details [aria-invalid=true]")) /** @type {HTMLDetailsElement} */ (box.closest("details")).open = true; // otherwise the field is not visible
  wrongIn(form)?.focus();
});

/** A button; kind is "primary", "quiet", "danger", "icon" or nothing. */
export const Button = ({ kind = "", ...more }) => html`<button type="button" class=${`button ${kind}`} ...${more} />`;

/** Section of a view with a title. @param {{ title: string, kind?: string, children?: any, [more: string]: any }} props */
export const Card = ({ title, kind = "", children, ...more }) => {
  const id = useId("card");
  return html`<section class=${`card ${kind}`} aria-labelledby=${id} ...${more}><h2 id=${id}>${title}</h2>${children}</section>`;
};

/** @type {{ [kind: string]: string }} */
const SIGNS = { info: "i", warning: "!", error: "\u2715", good: "\u2713" };

/** A sentence with a sign: kind is "info", "warning", "error" or "good".
 * @param {{ text: string, kind?: string, [more: string]: any }} props */
export const Note = ({ text, kind = "info", ...more }) => html`
  <p class=${`note ${kind}`} ...${more}><span class="sign" aria-hidden="true">${SIGNS[kind]}</span><span>${text}</span></p>`;

/** @param {string} text @param {number | null} now */
const saysNumber = (text, now) => (text.trim() ? now !== null && parseNumber(text) === now : now === null);
/** @param {string} text @param {unknown} now */
const saysText = (text, now) => text.trim() === now;

/** @param {string} text @param {Limits & { unit: string }} limits @returns {{ parsed?: number | null, fault?: string }} */
const checked = (text, { min, above, max, integer, moves, optional, unit }) => {
  if (!text.trim()) return optional ? { parsed: null } : { fault: "Enter a number." };
  const parsed = parseNumber(text);
  if (parsed === null) return { fault: "This is not a number." };
  if (moves && parsed === 0) return { fault: "Enter a value other than 0." };
  const wrong = /** @type {[boolean, string, number | undefined][]} */ ([
    [above !== undefined && parsed <= above, "More than {limit}.", above],
    [min !== undefined && min !== null && parsed < min, "At least {limit}.", min],
    [max !== undefined && max !== null && parsed > max, "At most {limit}.", max],
  ]).find(([fails]) => fails);
  if (integer && Math.abs(parsed) > Number.MAX_SAFE_INTEGER) return { fault: t("At most {limit}.", { limit: Number.MAX_SAFE_INTEGER }) };
  if (wrong) return { fault: t(wrong[1], { limit: quantity(wrong[2], unit) }) };
  return integer && !Number.isInteger(parsed) ? { fault: "Enter a whole number." } : { parsed };
};

// "1,000" is 1 in this notation and 1000 in others: show the interpreted value.
/** @param {string} text */
const decimalWords = (text) => /^\s*[+-]?\d{1,3},\d{3}\s*$/.test(text)
  && t("Read as {number}: the comma is the decimal sign. Enter thousands without a comma.", { number: number(parseNumber(text), 6) });

/** @param {string} text @param {number} turns @param {{ min?: number, max?: number, step?: number }} limits */
const stepped = (text, turns, { min, max, step }) => {
  const value = parseNumber(text) ?? min ?? 0;
  const by = step ?? 10 ** Math.floor(Math.log10(Math.abs(value) || 1) - 1);
  return tidy(Math.min(max ?? Infinity, Math.max(min ?? -Infinity, value + turns * by)));
};

/** @param {number} min @param {number} max @returns {Scale} */
const logarithmic = (min, max) => ({
  low: 0, high: 1000, step: 1,
  /** @param {number} value */
  from: (value) => (1000 * Math.log(value / min)) / Math.log(max / min),
  to: (position) => tidy(min * (max / min) ** (position / 1000), 4),
});
