/** Ground motion: a record file, a pulse, or a synthetic motion. */
import { batch, computed, html, render, signal } from "/parts/preact.js";
import { createTime } from "/charts/figure.js";
import { dotsOf } from "/charts/zoom.js";
import { Button, Card, Note, Segmented, sentence } from "/parts/fields.js";
import { keyOf } from "/app/refusal.js";
import { createAnswer } from "/views/answer.js";
import { motionBefore, rememberMotion } from "/views/motion-before.js";
import { Pulse, forgetPulses, usualPulse } from "/views/motion-pulse.js";
import { Record, createRecord } from "/views/motion-record.js";
import { Result } from "/views/motion-result.js";
import { Scale } from "/views/motion-scale.js";
import { Synthetic, usualSynthetic } from "/views/motion-synthetic.js";
import { t } from "/app/words.js";

const WAYS = [["record", "Record file"], ["pulse", "Pulse"], ["synthetic", "Synthetic"]];
const EDITORS = { record: Record, pulse: Pulse, synthetic: Synthetic };
// No default record: the user must select a file.
const USUAL = { record: () => null, pulse: usualPulse, synthetic: usualSynthetic };

const LEAN = "No motion is selected. The body starts from an initial rotation. Choose a motion to shake the body.";

/** Source of a motion; none without a ground motion. @param {Server.MotionInput | null | undefined} motion @returns {"" | keyof typeof EDITORS} */
const wayOf = (motion) => /** @type {(keyof typeof EDITORS)[]} */ (Object.keys(EDITORS)).find((way) => motion?.[way] !== undefined) || "";

/** Shows the view of the motion in a section. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const { inputs } = app;
  const motion = signal(inputs.get().motion);
  const way = signal(wayOf(motion.value));
  const faulty = signal(false);
  /** @type {{ [way: string]: Server.MotionInput | undefined }} */
  let kept = {};
  const question = () => {
    const { motion: current, settings } = inputs.get();
    if (!current) return null;
    return { motion: current, settings, points: dotsOf(section.querySelector("[data-testid=motion-traces]") ?? section) };
  };
  const request = createAnswer(app, "motion", ["motion", "settings"], question, { path: "motion", detail: { spectrum: false } });
  inputs.subscribe((now, changed) => {
    if (!changed.has("motion")) return;
    rememberMotion(app, now.motion);
    batch(() => ([motion.value, way.value] = [now.motion, wayOf(now.motion)]));
  });
  app.faults.subscribe(() => (faulty.value = app.faults.any({ view: "motion" })));
  /** Sets the motion; a motion and a free start exclude each other. @param {Server.MotionInput} next */
  const set = (next) => {
    const { scale } = inputs.get().motion || {};
    inputs.set("response.initial_rotation", undefined);
    inputs.set("motion", scale === undefined || next.scale !== undefined ? next : { ...next, scale });
  };
  /** Shows the editor of a source, and sets its last choice as the motion.
   * @param {keyof typeof EDITORS} next */
  const choose = (next) => batch(() => {
    const { motion: now } = inputs.get();
    if (now) kept[wayOf(now)] = now;
    const before = now ? null : motionBefore(app);
    const chosen = kept[next] || (wayOf(before) === next ? before : null) || USUAL[next](app);
    if (chosen) set(chosen);
    way.value = next;
  });
  const record = createRecord(app, set);
  // Edited values and a pending file belong to one project.
  computed(() => app.project.here.value.id).subscribe(() => batch(() => {
    kept = {};
    forgetPulses();
    record.forget();
    way.value = wayOf(inputs.get().motion);
  }));
  render(html`<${Motion} app=${app} request=${request} motion=${motion} way=${way} faulty=${faulty} record=${record} set=${set}
    choose=${choose} time=${createTime(undefined, request.look)} />`, section);
  return request;
};

/** @param {any} props */
const Motion = ({ app, request, motion: { value: motion }, way, faulty, record, set, choose, time }) => {
  const { answer: { value: answer }, refused: { value: refused }, closeup } = request;
  const Editor = /** @type {any} */ (EDITORS)[way.value];
  const waits = way.value === "record" && record.waiting.value;
  // the measured motion differs from the form: another source, a pending file, an error
  const stale = motion && ((faulty.value && !refused) || waits || wayOf(motion) !== way.value);
  return html`
    <header class="view-head"><h1>Ground motion</h1>
      <p class="lead">Drop a record, choose a pulse or generate a synthetic motion. The results update at once.</p></header>
    <div class="columns narrow-wide">
      <div class="motion-left"><${Card} title="The motion">
        <${Segmented} label="Source of the motion" options=${WAYS} value=${way.value} on=${choose} />
        <div class="motion-editor">${Editor && html`<${Editor} app=${app} motion=${wayOf(motion) === way.value ? motion : null}
          record=${record} lost=${refused?.status === 404} blamed=${refused && blamedOf(refused)} onChange=${set} />`}</div>
        ${motion && html`<${Scale} value=${motion.scale ?? 1} on=${(scale) => app.inputs.set("motion", { ...motion, scale })} />`}<//></div>
      <div class="motion-right">
        <div aria-live="polite" data-testid="motion-refusal">
          ${!motion && html`<${Note} text=${LEAN} /><div class="toolbar">
            <${Button} onClick=${() => set(motionBefore(app))}>Restore the previous motion<//></div>`}
          ${refused && html`<${Note} kind="error" text=${refused.message} />`}
          ${(answer?.warnings ?? []).map((/** @type {string} */ warning) => html`<${Note} key=${warning} kind="warning" text=${warning} />`)}</div>
        <div aria-live="polite" data-testid="motion-pending">
          ${stale && html`<${Note} kind="warning" text=${pendingWords(motion, faulty.value, waits)} />`}</div>
        ${answer && html`<${Result} app=${app} answer=${answer} closeup=${closeup.value} time=${time} stale=${stale} />`}
      </div>
    </div>`;
};

// A motion without energy has a factor or a peak of 0, or an underflowing square.
/** @param {any} refused */
const blamedOf = (refused) => {
  const key = refused.parameter ? keyOf(refused) : undefined;
  return key === "energy" ? { key: "amplitude", text: "Enter a value other than 0." } : { key, text: sentence(refused.message) };
};

/** @param {Server.MotionInput} motion @param {boolean} faulty @param {boolean} waits */
const pendingWords = (motion, faulty, waits) => {
  const file = waits ? "The new file is not read yet" : "No file is selected";
  const reason = faulty && !waits ? "An input is invalid" : file;
  return t("{reason}. The results below and the response still use {motion}.", { reason, motion: motion.file_name ?? "the previous motion" });
};
