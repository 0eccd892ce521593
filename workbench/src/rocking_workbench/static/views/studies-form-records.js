/** Uploaded records: selection for a study, missing data, deletion. */
import { html, useEffect, useLayoutEffect, useRef, useSignal } from "/parts/preact.js";
import { Button } from "/parts/fields.js";
import { quantity } from "/app/format.js";
import { Needs } from "/views/motion-record-needs.js";
import { forgetTold, rememberTold, toldOf } from "/views/motion-told.js";
import { t, userText } from "/app/words.js";

const EMPTY = "No record is uploaded. Add records in the step Motion.";

/** List of the records, read at every visit; `taken.current()` returns the selected records as motions of a job.
 * @param {{ app: App, taken: { current: any }, visits: number, hidden: boolean }} props */
export const RecordChoice = ({ app, taken, visits, hidden }) => {
  const [stored, looked, left, refused] = [useSignal([]), useSignal({}), useSignal(new Set()), useSignal("")];
  /** @param {string} record */
  const look = async (record) => {
    const options = toldOf(record);
    const { format, units, time_step } = options;
    const seen = await app.call(`records/${record}`, { query: { format, units, time_step } }).then(
      (facts) => ({ facts, stated: options, missing: facts.needs.filter((need) => options[need] === undefined) }),
      (error) => ({ refused: error.message }),
    );
    looked.value = { ...looked.value, [record]: seen };
  };
  const refresh = async () => {
    try {
      const answer = await app.call("records");
      stored.value = answer;
      refused.value = "";
      for (const { record } of stored.value) await look(record);
    } catch (error) {
      refused.value = error.message;
    }
  };
  useEffect(() => void (hidden || refresh()), [hidden, visits]);
  /** @param {{ record: string }} one */
  const isTicked = ({ record }) => looked.value[record]?.missing?.length === 0 && !left.value.has(record);
  const ticked = stored.value.filter(isTicked);
  taken.current = () => {
    if (!stored.value.length) throw new Error(EMPTY);
    if (!ticked.length) throw new Error("No record is selected. Select at least one record.");
    return together(ticked.map(({ record }) => ({ records: [record], ...toldOf(record) })));
  };
  /** @param {string} record @param {boolean} on */
  const tick = (record, on) => {
    const next = new Set(left.value);
    if (on) next.delete(record);
    else next.add(record);
    left.value = next;
  };
  /** @param {string} record */
  const gone = (record) => {
    forgetTold(record);
    stored.value = stored.value.filter((entry) => entry.record !== record);
  };
  return html`
    <div class="question" data-testid="record-choice" hidden=${hidden}>
      <p class="quiet" aria-live="polite">${refused.value
        || (stored.value.length ? t("{number} of {count} records are selected.", { number: ticked.length, count: stored.value.length }) : EMPTY)}</p>
      <ul class="record-list" aria-label="Uploaded records">${stored.value.map((entry) => html`
        <${Row} key=${entry.record} app=${app} record=${entry.record} name=${entry.file_name} seen=${looked.value[entry.record]}
          ticked=${isTicked(entry)} tick=${tick} look=${look} gone=${gone} />`)}</ul>
    </div>`;
};

/** Records with the same data have one table. @param {any[]} tables */
const together = (tables) => {
  const byOptions = new Map();
  for (const { records, ...options } of tables) {
    const key = JSON.stringify(options);
    byOptions.set(key, { records: [...(byOptions.get(key)?.records ?? []), ...records], ...options });
  }
  return [...byOptions.values()];
};

const NOT_SEEN = {};

/** @param {any} props */
const Row = ({ app, record, name, seen = NOT_SEEN, ticked, tick, look, gone }) => {
  const row = useRef(null);
  const answered = useRef(false);
  const { facts, stated, missing = [], refused } = seen;
  const open = missing.length > 0;
  useLayoutEffect(() => {
    if (answered.current) row.current.querySelector(open ? ".record-asked :is(input, select)" : "input:enabled")?.focus();
    answered.current = false;
  }, [seen]);
  /** @param {Told} statement */
  const take = (statement) => {
    rememberTold({ record, ...stated, ...statement });
    answered.current = true;
    look(record);
  };
  const remove = async () => {
    if (!window.confirm(t("Delete \u201c{name}\u201d from this server?", { name: userText(name) }))) return;
    try {
      await app.call(`records/${record}`, { method: "DELETE" });
      app.say(t("{name} is deleted.", { name: userText(name) }));
      (row.current.nextElementSibling ?? row.current.previousElementSibling)?.querySelector("button").focus();
      gone(record);
    } catch (error) {
      app.say(error.message, "error");
    }
  };
  return html`
    <li ref=${row} class="record-row">
      <label class="record-tick"><input type="checkbox" checked=${ticked} disabled=${!facts || open}
        onChange=${(event) => tick(record, event.target.checked)} /><span translate=${false}>${name}</span></label>
      <${Button} kind="quiet" aria-label=${t("Delete {name}", { name: userText(name) })} onClick=${remove}>Delete<//>
      <span class="quiet">${refused ?? (open ? "Missing input:" : facts && factsOf(facts, stated))}</span>
      ${open && html`<${Needs} key=${seen} class="record-asked" answer=${{ ...facts, needs: missing }} info=${app.info} initial=${stated}
        take=${take} button=${{ "aria-label": t("Apply to {name}", { name: userText(name) }) }} />`}
    </li>`;
};

/** @param {Server.RecordFacts} facts @param {Told} stated */
const factsOf = ({ components }, { units, component, vertical }) => {
  const chosen = components.find(({ name }) => name === component) ?? components[0];
  const step = chosen?.time_step;
  return [
    component,
    vertical && t("{component} vertical", { component: vertical }),
    units && t("in {unit}", { unit: units }),
    step ? t("time step {time}", { time: quantity(step, "s") }) : null,
  ]
    .filter(Boolean)
    .join(", ");
};
