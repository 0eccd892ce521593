/** Studies: many histories at once, launched as campaigns; their progress, and their results. */
import { computed, html, render, signal, useLayoutEffect, useRef } from "/parts/preact.js";
import { unpacked } from "/app/packed.js";
import { t } from "/app/words.js";
import { Switch } from "/parts/fields.js";
import { StudyForm } from "/views/studies-form.js";
import { StudyList, actsOf, stateWords } from "/views/studies-list.js";
import { liveStudies } from "/views/studies-live.js";
import { OverturningMap } from "/views/studies-map.js";
import { Fragility } from "/views/studies-fragility.js";
import { Spectrum } from "/views/studies-spectrum.js";
import { Counts } from "/views/studies-counts.js";
import { Exports } from "/views/studies-exports.js";

/** Build the view inside its section. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const [every, open, visits] = [signal(false), signal(null), signal(0)];
  const live = liveStudies(app);
  // Studies launched outside a project belong to all projects.
  /** @param {Server.StudyFacts} study */
  const mine = ({ project }) => every.value || !project || project === app.project.here.value.id;
  const studies = computed(() => live.all.value.filter(mine));
  const states = new Map();
  /** @type {string | null} */
  let expected = null;

  // `from`: control that opened the result; undefined if it opened automatically.
  /** @param {Server.StudyFacts} study @param {Element | null} [from] */
  const show = async (study, from) => {
    /** @param {object} more */
    const update = (more) => open.value?.shown === study && (open.value = { shown: study, from, ...more });
    open.value = { shown: study, from };
    await app.call(`studies/${study.id}/result`).then(
      (result) => update({ result: unpacked(result), chosen: { restitution: 0 } }), (error) => update({ refused: error.message }),
    );
  };
  studies.subscribe((now) => {
    for (const study of now) {
      const before = states.get(study.id);
      if (before && before !== study.state) app.say(`${study.name}: ${t(stateWords(study))}`);
      states.set(study.id, study.state);
    }
    const done = now.find(({ id, state }) => id === expected && state === "done");
    if (done) {
      expected = null;
      show(done);
    }
    if (open.value && !now.some(({ id }) => id === open.value.shown.id)) open.value = null;
  });
  /** @param {string} id */
  const launched = (id) => {
    app.say("Study started.");
    expected = id;
    live.refresh();
  };
  render(html`<${Studies} app=${app} studies=${studies} every=${every} open=${open} visits=${visits}
    show=${show} acts=${actsOf(app, live.refresh)} launched=${launched} />`, section);
  return {
    shown: () => {
      live.start();
      visits.value += 1;
    },
    hidden: live.stop,
  };
};

/** @param {any} props */
const Studies = ({ app, studies, every, open, visits, show, acts, launched }) => html`
  <header class="view-head"><h1>Studies</h1>
    <p class="lead">Many simulations at once: maps, spectra and fragility. Studies run in the background.</p></header>
  <div class="studies">
    <div class="studies-left">
      <section class="card" aria-labelledby="studies-new"><h2 id="studies-new">New study</h2>
        <${StudyForm} app=${app} visits=${visits.value} onLaunched=${launched}
          taken=${() => new Set(studies.value.map((/** @type {Server.StudyFacts} */ { name }) => name))} /></section>
      <section class="card" aria-labelledby="studies-there"><h2 id="studies-there">Studies</h2>
        <${Switch} label="Studies of all projects" value=${every} />
        <${StudyList} studies=${studies.value} onShow=${(/** @type {Server.StudyFacts} */ study) => show(study, document.activeElement)} acts=${acts} /></section>
    </div>
    ${open.value && html`<${Outcome} app=${app} ...${open.value} />`}
  </div>`;

/** @param {{ app: App, shown: Server.StudyFacts, from?: Element | null, result: any, refused?: string, chosen: { restitution: number } }} props */
const Outcome = ({ app, shown, from, result, refused, chosen }) => {
  const heading = useRef(null);
  const focused = document.activeElement;
  useLayoutEffect(() => { // the focus moves here from the pressed or a removed control, not from a field in use
    if (focused && ((result && focused === from) || !focused.isConnected)) heading.current.focus();
  }, [shown, result]);
  const Found = SHOW[shown.kind] ?? Counts;
  return html`
    <section class="card study-outcome">
      <h2 ref=${heading} class="study-result-title" tabindex="-1" translate=${false}>${shown.name}</h2>
      <div class="study-result" data-testid="study-result" data-own=${shown.name}>
        ${refused ? html`<p class="error-text">${refused}</p>` : !result ? html`<p class="quiet">Reading the result \u2026</p>` : html`
          ${result.contact && html`<p class="note" data-testid="study-contact">${result.contact}</p>`}
          <${Found} key=${shown.id} app=${app} study=${shown} result=${result} chosen=${chosen} />
          <${Exports} app=${app} study=${shown} result=${result} chosen=${chosen} />`}
      </div>
    </section>`;
};

/** @type {{ [kind: string]: ((props: any) => VNode) | undefined }} */
const SHOW = {
  "overturning-map": OverturningMap,
  "rocking-spectrum": Spectrum,
  stripes: Fragility,
  incremental: Fragility,
  cloud: Fragility,
};
