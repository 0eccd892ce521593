/** All projects: open, create, rename, copy, export, delete and restore; history of the open project. */

import { html, signal, useRef } from "/parts/preact.js";
import { dateTime, t, userText } from "/app/words.js";
import { Button } from "/parts/fields.js";
import { PARTS } from "/project/saving.js";

const FEW = 12;

// Origin of a state: the changed parts, or a text.
/** @param {string} text */
const changed = (text) => {
  const parts = text.split(", ").map((key) => PARTS[key]);
  return parts.includes(undefined) ? t(text) : t("{parts} changed", { parts: parts.map((label) => t(String(label))).join(", ") });
};

/** The dialog; `handle.current.openIt()` opens it.
 * @param {{ projects: Projects, app: App, handle: { current: unknown } }} props */
export const ProjectDialog = ({ projects, app, handle }) => {
  const dialog = useRef(null);
  /** @type {Signal<Server.Projects & Server.History>} */
  const lists = useRef(signal({ projects: [], deleted: [], states: [] })).current;
  const all = useRef(signal(false)).current;
  const shown = useRef(signal(false)).current;
  const look = async () => {
    const [there, past] = await Promise.all([
      app.call("projects"), app.call(`projects/${projects.here.value.id}/history`),
    ]);
    lists.value = { ...there, ...past };
  };
  // Errors are shown; the lists contain the state of the server in any case.
  /** @param {() => unknown} work @param {boolean} [close] */
  const act = (work, close = false) => async () => {
    try {
      await work();
      if (close) dialog.current.close();
      else await look();
    } catch (error) {
      app.say(error.message, "error");
    }
  };
  handle.current = {
    openIt: act(async () => {
      await projects.save();
      await look();
      shown.value = true;
      if (!dialog.current.open) dialog.current.showModal();
    }),
  };
  const here = projects.here.value;
  /** @param {any} event */
  const named = async (event) => {
    event.preventDefault();
    const field = event.target.elements.name;
    const name = field.value.trim();
    if (!name) return;
    await act(() => (event.target.dataset.for === "rename" ? projects.rename(name) : projects.begin(name)))();
    if (event.target.dataset.for !== "rename") field.value = "";
  };
  /** @param {any} event */
  const bring = async (event) => {
    const [file] = event.target.files;
    event.target.value = "";
    if (file) await act(() => projects.bring(file))();
  };
  /** @param {Server.ProjectFacts} project */
  const take = (project) => act(() => app.download(`projects/${project.id}/file`, undefined, "project.zip"));
  /** @param {Server.ProjectFacts} project */
  const remove = (project) => act(async () => {
    await app.call(`projects/${project.id}`, { method: "DELETE" });
    app.say(t("{name} is deleted. You can restore it below.", { name: userText(project.name) }));
    if (project.id !== projects.here.value.id) return;
    const next = lists.value.projects.find((other) => other.id !== project.id);
    await (next ? projects.open(next.id) : projects.begin("New project"));
  });
  const states = all.value ? lists.value.states : lists.value.states.slice(0, FEW);
  return html`
    <dialog ref=${dialog} class="over projects" aria-labelledby="projects-title" data-testid="projects"
      onClose=${() => (shown.value = false)}>
      ${shown.value && html`<div class="card">
        <div class="project-head">
          <h1 id="projects-title">Projects</h1>
          <${Button} onClick=${() => dialog.current.close()}>Close<//>
        </div>
        <p>Projects are kept on this computer, with their history.</p>
        <${NameForm} for="rename" label="Name of the open project" value=${here.name} text="Rename" onSubmit=${named} />
        <ul class="project-list" aria-label="Projects">
          ${lists.value.projects.map((project) => html`
            <li key=${project.id} data-here=${project.id === here.id}>
              <p><strong translate=${false}>${project.name}</strong><span class="quiet">${dateTime(project.changed)}</span></p>
              <div class="toolbar">
                ${project.id === here.id
                  ? html`<span class="project-open">open</span>`
                  : html`<${Act} text="Open" project=${project} go=${act(() => projects.open(project.id), true)} />`}
                <${Act} text="Copy" project=${project} go=${act(() => projects.copy(project.id, t("{name} (copy)", { name: userText(project.name) }), project.name))} />
                <${Act} text="Export" project=${project} go=${take(project)} />
                <${Act} text="Delete" project=${project} go=${remove(project)} />
              </div>
            </li>`)}
        </ul>
        <${NameForm} for="begin" label="Name of a new project" value="" text="Create" onSubmit=${named} />
        <div class="field">
          <label for="project-file">Import a project file</label>
          <input id="project-file" type="file" accept=".zip" onChange=${bring} aria-describedby="project-file-about" />
          <p id="project-file-about" class="field-help">The studies of the project are computed again.</p>
        </div>
        <h2>${t("History of {name}", { name: userText(here.name) })}</h2>
        <ul class="project-list states" aria-label="History">
          ${states.map((state) => html`
            <li key=${state.number}>
              <p><span>${changed(state.description)}</span><span class="quiet">${dateTime(state.time)}</span></p>
              ${state.here
                ? html`<span class="project-open">now</span>`
                : html`<${Button} aria-label=${t("Restore state {number}: {change}", { number: state.number, change: changed(state.description) })}
                    onClick=${act(() => projects.restore(state.number))}>Restore<//>`}
            </li>`)}
        </ul>
        ${lists.value.states.length > FEW && !all.value && html`
          <${Button} onClick=${() => (all.value = true)}>
            ${t("All {count} states", { count: lists.value.states.length })}
          <//>`}
        ${lists.value.deleted.length > 0 && html`
          <h2>Deleted</h2>
          <ul class="project-list" aria-label="Deleted">
            ${lists.value.deleted.map((project) => html`
              <li key=${project.id}>
                <p><strong translate=${false}>${project.name}</strong><span class="quiet">${dateTime(project.deleted ?? "")}</span></p>
                <${Act} text="Restore" project=${project}
                  go=${act(() => app.call(`projects/${project.id}/back`, { method: "POST" }))} />
              </li>`)}
          </ul>`}
      </div>`}
    </dialog>`;
};

/** @param {{ text: string, project: Server.ProjectFacts, go: () => unknown }} props */
const Act = ({ text, project, go }) => html`
  <${Button} aria-label=${`${t(text)}: ${project.name}`} onClick=${go}>${text}<//>`;

/** @param {{ for: string, label: string, value: string, text: string, onSubmit: (event: any) => unknown }} props */
const NameForm = ({ for: purpose, label, value, text, onSubmit }) => html`
  <form class="project-form" data-for=${purpose} onSubmit=${onSubmit}>
    <div class="field">
      <label for=${`project-${purpose}`}>${label}</label>
      <input id=${`project-${purpose}`} name="name" type="text" maxlength="200" autocomplete="off" defaultValue=${value}
        key=${value} />
    </div>
    <${Button} type="submit">${text}<//>
  </form>`;
