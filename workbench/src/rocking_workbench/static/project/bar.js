/** Line of the open project: name, saving state, undo and redo. */

import { html, render, useEffect, useRef } from "/parts/preact.js";
import { Button } from "/parts/fields.js";
import { ProjectDialog } from "/project/dialog.js";
import { t, userText } from "/app/words.js";

/** @type {{ [state: string]: string }} */
const SAVED = { saved: "saved", saving: "saving \u2026", unsaved: "not saved" };

/** Show the line, and keep it up to date. @param {HTMLElement} holder @param {Projects} projects @param {App} app */
export const mountProject = (holder, projects, app) => {
  render(html`<${Bar} projects=${projects} app=${app} />`, holder);
  document.addEventListener("keydown", (event) => {
    const way = wayOf(event);
    const elsewhere = event.defaultPrevented || isTyping(event.target) || document.querySelector("dialog[open]");
    if (!way || elsewhere) return;
    event.preventDefault();
    projects[way]();
  });
};

/** @param {KeyboardEvent} event @returns {"undo" | "redo" | null} */
const wayOf = ({ key, ctrlKey, metaKey, shiftKey, altKey }) => {
  if (!(ctrlKey || metaKey) || altKey) return null;
  if (key.toLowerCase() === "z") return shiftKey ? "redo" : "undo";
  return key.toLowerCase() === "y" ? "redo" : null;
};

/** @param {EventTarget | null} target */
const isTyping = (target) => /** @type {HTMLElement | null} */ (target)?.matches?.("input:not([type=range], [type=checkbox], [type=radio]), textarea, select");

/** @param {{ projects: Projects, app: App }} props */
const Bar = ({ projects, app }) => {
  const dialog = useRef(null);
  const { here, saving, clash } = projects;
  const facts = here.value;
  if (!facts) return null;
  return html`
    <button type="button" class="button quiet project-name" aria-haspopup="dialog" data-testid="project"
      aria-label=${t("Project: {name}", { name: userText(facts.name) })} onClick=${() => dialog.current.openIt()}>
      <span class="project-title" translate=${false}>${facts.name}</span>
    </button>
    <span class="project-saved" role="status" data-state=${saving.value} data-testid="project-saved">
      ${SAVED[saving.value]}
    </span>
    ${saving.value === "unsaved" && !clash.value
      && html`<${Button} onClick=${projects.again}>Retry saving<//>`}
    <${Step} sign="\u21b6" label="Previous state of the project" on=${facts.can_undo || saving.value === "unsaved"} go=${projects.undo} />
    <${Step} sign="\u21b7" label="Next state of the project" on=${facts.can_redo} go=${projects.redo} />
    <${ProjectDialog} projects=${projects} app=${app} handle=${dialog} />
    ${clash.value && html`<${Clash} projects=${projects} />`}`;
};

/** @param {{ sign: string, label: string, on: boolean, go: () => unknown }} props */
const Step = ({ sign, label, on, go }) => html`
  <button type="button" class="button quiet icon" aria-label=${label} title=${label} aria-disabled=${!on}
    onClick=${() => on && go()}><span aria-hidden="true">${sign}</span></button>`;

/** @param {{ projects: Projects }} props */
const Clash = ({ projects }) => {
  const dialog = useRef(null);
  useEffect(() => dialog.current.showModal(), []);
  // Browsers close the dialog at a second Escape. It is opened again until the user makes a choice.
  const stay = () => projects.clash.value && dialog.current?.showModal();
  /** @param {boolean} mine */
  const settle = (mine) => () => projects.settle(mine);
  return html`
    <dialog ref=${dialog} class="over" aria-labelledby="clash-title" data-testid="clash"
      onCancel=${(event) => event.preventDefault()} onClose=${stay}>
      <div class="card door">
        <h1 id="clash-title">This project was changed elsewhere</h1>
        <p>Another tab or browser has changed this project. Nothing is lost. Choose the version to continue with.</p>
        <div class="toolbar">
          <${Button} kind="primary" onClick=${settle(false)}>Open the other version<//>
          <${Button} onClick=${settle(true)}>Save my version as a copy<//>
        </div>
      </div>
    </dialog>`;
};
