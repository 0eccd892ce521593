/** Buttons, choices and cards. */

import { el, fill, freshId, set } from "/app/dom.js";

/** A button; kind is "primary", "quiet", "danger" or nothing. */
export const button = ({ text, onClick, kind = "plain", label, disabled, testid }) =>
  el("button", {
    type: "button", class: `button ${kind}`, "aria-label": label, disabled: Boolean(disabled),
    onclick: onClick, ...(testid ? { "data-testid": testid } : {}),
  }, text);

/** A small button that shows a sign and says its words to screen readers and on hover. */
export const iconButton = ({ sign, label, onClick, disabled }) =>
  el("button", {
    type: "button", class: "button icon", "aria-label": label, title: label, disabled: Boolean(disabled),
    onclick: onClick,
  }, el("span", { "aria-hidden": "true" }, sign));

/** A choice of one from a list. An element with `value`. */
export const selectField = ({ label, options: first, value, onChange, help }) => {
  let options = first;
  const id = freshId("select");
  const select = el("select", {
    id, "aria-describedby": `${id}-about`, onchange: () => onChange?.(valueOf(options, select.value)),
  });
  const setOptions = (next) => {
    options = next;
    fill(select, next.map((each) => el("option", { value: String(each.value) }, each.text)));
  };
  const setValue = (next) => {
    select.value = String(next);
  };
  setOptions(options);
  if (value !== undefined && value !== null) setValue(value);
  const about = el("p", { id: `${id}-about`, class: "field-help" }, help);
  const setError = (text) => {
    set(select, { "aria-invalid": text ? "true" : null });
    about.classList.toggle("field-error", Boolean(text));
    fill(about, text || help || "");
  };
  const head = el("div", { class: "field-head" }, el("label", { for: id }, label));
  const field = el("div", { class: "field" }, head, select, about);
  Object.defineProperty(field, "value", { get: () => valueOf(options, select.value), set: setValue });
  return Object.assign(field, { input: select, setValue, setOptions, setError });
};

/** A choice of one from a few, all in sight. An element with `value`. */
export const segmented = ({ label, options, value, onChange }) => {
  const name = freshId("choice");
  const inputs = options.map((each) => el("input", {
    type: "radio", name, value: String(each.value), checked: each.value === value,
    onchange: () => onChange?.(each.value),
  }));
  const choices = options.map(
    (each, index) => el("label", { class: "segment" }, inputs[index], el("span", {}, each.text))
  );
  const field = el(
    "fieldset", { class: "segmented" }, el("legend", {}, label), el("div", { class: "segments" }, choices),
  );
  const setValue = (next) => inputs.forEach((each) => (each.checked = each.value === String(next)));
  const get = () => valueOf(options, inputs.find((each) => each.checked)?.value);
  Object.defineProperty(field, "value", { get, set: setValue });
  return Object.assign(field, { setValue });
};

/** Yes or no. An element with `value`. */
export const switchField = ({ label, value = false, onChange, help }) => {
  const id = freshId("switch");
  const input = el("input", {
    id, type: "checkbox", checked: value, "aria-describedby": `${id}-about`,
    onchange: () => onChange?.(input.checked),
  });
  const field = el("div", { class: "field field-switch" },
    el("label", { for: id }, input, el("span", {}, label)),
    el("p", { id: `${id}-about`, class: "field-help" }, help));
  const setValue = (next) => (input.checked = next);
  Object.defineProperty(field, "value", { get: () => input.checked, set: setValue });
  return Object.assign(field, { input, setValue });
};

/** A titled part of a view. */
export const card = (title, ...children) => {
  const id = freshId("card");
  return el("section", { class: "card", "aria-labelledby": id }, el("h2", { id }, title), ...children);
};

/** Buttons that belong together. */
export const toolbar = (...children) => el("div", { class: "toolbar" }, ...children);

/** A sentence with a sign: kind is "info", "warning", "error" or "good". */
export const note = (text, kind = "info") =>
  el("p", { class: `note ${kind}` },
    el(
      "span", { class: "sign", "aria-hidden": "true" },
      { info: "i", warning: "!", error: "\u2715", good: "\u2713" }[kind],
    ),
    el("span", {}, text));

const valueOf = (options, text) => options.find((each) => String(each.value) === text)?.value;
