/** 3D body on the page: picture, rotation controls and description. */

import { html, useEffect, useMemo, useRef, useSignal } from "/parts/preact.js";
import { Button, Note } from "/parts/fields.js";
import { fetchFile } from "/app/api.js";
import { freshId } from "/app/dom.js";
import { Pictured } from "/charts/pictured.js";
import { onTheme } from "/charts/style.js";
import { Made } from "/parts/made.js";
import { readGlb } from "/space/glb.js";
import { Stage } from "/space/stage.js";
import { markKey, riseKey } from "/space/textures.js";
import { t } from "/app/words.js";

const LIBRARY = "/vendor/three/three.module.min.js"; // loaded for this view only, when it shows a body
const [BY_KEY, BY_PIXEL, CLOSER] = [0.15, 0.008, 0.85];
/** @type {[string, Aim | null, number?][]} */
const VIEWS = [
  ["From the front", { turned: -Math.PI / 2, raised: 0.15 }], ["From the side", { turned: 0, raised: 0.15 }],
  ["From above", { turned: -Math.PI / 2, raised: 1.5 }], ["Zoom in", null, CLOSER], ["Zoom out", null, 1 / CLOSER],
];

/** @param {{ kind: string }} props */
const Key = ({ kind }) => html`<${Made} node=${useMemo(() => (kind === "rise" ? riseKey() : markKey(kind)), [kind])} />`;

/** Picture of the body of a run, with the `title` of its file; `onStage` receives the stage, `onSpace` handles the space bar.
 * @param {{ question: Server.WholeQuestion, description: string, title: string, label: string, onStage: (stage: Stage) => unknown, onSpace: () => unknown, legend: string[][] }} props */
export const Scene = ({ question, description, title, label, onStage, onSpace, legend }) => {
  const canvas = useRef(null);
  const stage = useSignal(null);
  const trouble = useSignal("");
  const about = useRef(freshId("scene")).current;
  useEffect(() => {
    /** @type {Stage | null} */
    let built = null;
    let gone = false;
    const watcher = new ResizeObserver(() => built?.resize());
    const forget = onTheme(() => built?.repaint());
    const sent = async () => (await fetchFile(`questions/${question.id}/space.glb`)).arrayBuffer();
    const build = async () => {
      const [file, three] = await Promise.all([sent(), import(LIBRARY)]);
      if (gone) return;
      built = new Stage(three, canvas.current, readGlb(file));
      stage.value = built;
      watcher.observe(canvas.current);
      onStage(built);
      canvas.current.dataset.drawn = "true";
    };
    build().catch((error) => (trouble.value = t("No picture: {reason}. The text below describes the body.", { reason: error.message })));
    return () => {
      gone = true;
      watcher.disconnect();
      forget();
      built?.dispose();
    };
  }, []);
  /** @param {Aim} to */
  const look = (to) => {
    stage.value?.look(to);
    stage.value?.draw();
  };
  /** @param {number} across @param {number} up */
  const turn = (across, up) => stage.value
    && look({ turned: stage.value.turned + across, raised: stage.value.raised + up });
  /** @param {number} times */
  const nearer = (times) => stage.value && look({ near: stage.value.near * times });
  const photograph = () => {
    if (!stage.value) throw new Error("The drawing of the body is not ready.");
    return stage.value.photograph();
  };
  /** @param {KeyboardEvent} event */
  const keys = (event) => {
    const does = {
      ArrowLeft: () => turn(-BY_KEY, 0), ArrowRight: () => turn(BY_KEY, 0),
      ArrowUp: () => turn(0, BY_KEY), ArrowDown: () => turn(0, -BY_KEY),
      "+": () => nearer(CLOSER), "-": () => nearer(1 / CLOSER), " ": onSpace,
    }[event.key];
    if (!does || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    does();
  };
  return html`
    ${trouble.value && html`<${Note} kind="warning" text=${trouble.value} />`}
    <div class="space-picture" hidden=${Boolean(trouble.value)} data-own=${question.name} data-about=${description}>
      <${Pictured} title=${title} canvasOf=${photograph}><canvas ref=${canvas} class="space-stage" role="img" tabindex="0" aria-label=${label} aria-describedby=${about}
        data-testid="space-stage" onKeyDown=${keys}
        onPointerDown=${(event) => event.currentTarget.setPointerCapture(event.pointerId)}
        onPointerMove=${(event) => event.buttons && turn(-BY_PIXEL * event.movementX, BY_PIXEL * event.movementY)}
        onWheel=${(event) => {
          if (document.activeElement !== canvas.current) return; // otherwise the page could not be scrolled
          event.preventDefault();
          nearer(event.deltaY < 0 ? CLOSER : 1 / CLOSER);
        }}></canvas>
        <ul class="space-legend" aria-label="Legend">
          ${[...(stage.value?.model.mended ? [["mended", "closed by repair"]] : []), ...legend].map(([kind, text]) => html`
            <li key=${kind}><${Key} kind=${kind} />${text}</li>`)}
        </ul><//>
      <div class="toolbar" role="group" aria-label="View">
        ${VIEWS.map(([name, to, times]) => html`<${Button} kind="quiet" key=${name}
          onClick=${() => (to ? look({ ...to, near: 1 }) : nearer(times ?? 1))}>${name}<//>`)}
      </div>
    </div>
    <p id=${about} class="space-words" data-testid="space-words">${description}</p>`;
};
