/** Which components of a record are horizontal and vertical. */
import { selectField } from "/app/fields.js";

const without = (given, key) => Object.fromEntries(Object.entries(given).filter(([name]) => name !== key));

/** Returns the fields that choose components; neither offers what the other has taken. */
export const componentFields = (names, motion, onChange) => {
  if (names.length < 2) return [];
  const main = motion.component ?? names.find((name) => name !== motion.vertical);
  const optionOf = (name) => ({ value: name, text: name });
  const optionsBut = (taken) => names.filter((name) => name !== taken).map(optionOf);
  // a link may say the same for both: both lists are whole then, so that one can change either
  const clash = motion.vertical === main;
  return [
    selectField({
      label: "Horizontal component",
      options: optionsBut(clash ? undefined : motion.vertical),
      value: main,
      onChange: (component) => onChange({ ...motion, component }),
    }),
    selectField({
      label: "Vertical component",
      options: [{ value: "", text: "none" }, ...optionsBut(clash ? undefined : main)],
      value: motion.vertical ?? "",
      onChange: (name) => onChange(name ? { ...motion, vertical: name } : without(motion, "vertical")),
    }),
  ];
};
