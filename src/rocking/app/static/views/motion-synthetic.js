/** A synthetic motion: a family, a seed and a member, scaled to a level if one likes. */
import { el, fill } from "/app/dom.js";
import { button, numberField, segmented, selectField } from "/app/fields.js";

const USUAL = "pulse-like";
const LEVELS = [
  { value: "", text: "As drawn" },
  { value: "pga", text: "To a PGA" },
  { value: "pgv", text: "To a PGV" },
];
const LEVEL = {
  pga: { label: "Peak ground acceleration", unit: "m/s2", usual: 3 },
  pgv: { label: "Peak ground velocity", unit: "m/s", usual: 0.5 },
};

/** Returns the editor of a synthetic motion. */
export const syntheticEditor = (app, onChange) => new SyntheticEditor(app, onChange);

class SyntheticEditor {
  constructor(app, onChange) {
    this.onChange = onChange;
    this.families = app.info.families;
    this.motion = this.usual();
    this.about = el("p", { class: "field-help" });
    this.family = selectField({
      label: "Family",
      options: this.families.map(({ name }) => ({ value: name, text: name.replaceAll("-", " ") })),
      value: USUAL,
      onChange: (synthetic) => this.change({ synthetic }),
    });
    this.seed = this.whole("Seed", "seed", "The same seed draws the same motions, everywhere.");
    this.member = this.whole("Member", "member", "Which motion of the family: 0, 1, 2, ...");
    const toLevel = (kind) => this.setLevel(kind);
    this.level = segmented({ label: "Level", options: LEVELS, value: "", onChange: toLevel });
    this.target = el("div", {});
    const another = () => this.change({ member: (this.motion.member || 0) + 1 });
    const next = button({ text: "Another one", onClick: another });
    const numbers = el("div", { class: "fields" }, this.seed, this.member);
    this.element = el("div", { class: "synthetic-editor" },
      this.family, this.about, numbers, next, this.level, this.target);
  }

  whole(label, key, help) {
    const field = numberField({
      label,
      value: 0,
      min: 0,
      step: 1,
      help,
      onChange: (value) => {
        if (!Number.isInteger(value)) return field.setError("A whole number.");
        return this.change({ [key]: value });
      },
    });
    return field;
  }

  change(changes) {
    this.motion = { ...this.motion, ...changes };
    this.onChange(this.motion);
  }

  setLevel(kind) {
    const { pga: _, pgv: __, ...rest } = this.motion;
    this.motion = rest;
    this.change(kind ? { [kind]: LEVEL[kind].usual } : {});
  }

  /** Shows a motion that was chosen, here or by a link. */
  show(motion) {
    this.motion = motion;
    this.family.value = motion.synthetic;
    fill(this.about, this.families.find(({ name }) => name === motion.synthetic)?.summary ?? "");
    this.seed.value = motion.seed ?? 0;
    this.member.value = motion.member ?? 0;
    const kind = Object.keys(LEVEL).find((key) => motion[key] !== undefined) ?? "";
    this.level.value = kind;
    this.showTarget(kind, motion[kind]);
  }

  showTarget(kind, value) {
    if (kind !== this.kind) {
      const { label, unit } = LEVEL[kind] ?? {};
      const onChange = (given) => this.change({ [kind]: given });
      this.field = kind ? numberField({ label, unit, value, min: 1e-6, step: 0.1, onChange }) : null;
      fill(this.target, this.field);
      this.kind = kind;
    } else if (kind) this.field.value = value;
  }

  /** The motion to begin with. */
  usual() {
    return { synthetic: USUAL, seed: 0, member: 0 };
  }
}
