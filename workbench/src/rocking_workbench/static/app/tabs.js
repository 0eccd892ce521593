/** Steps as tabs. Arrow keys move between the tabs, as in the ARIA guidelines. */

/** Connect tabs and panels; calls onShow(name, before, quiet) after a change, and returns {show, current}.
 * @param {HTMLElement} list @param {(name: string, before: string | null, quiet: boolean) => unknown} onShow */
export const createTabs = (list, onShow) => {
  const tabs = /** @type {HTMLElement[]} */ ([...list.querySelectorAll("[role=tab]")]);
  /** @param {HTMLElement} tab */
  const nameOf = (tab) => tab.dataset.view ?? "";
  let current = "";
  /** @param {string} name @param {{ focus?: boolean, quiet?: boolean }} [how] */
  const show = (name, { focus = false, quiet = false } = {}) => {
    const chosen = tabs.find((tab) => nameOf(tab) === name) ?? tabs[0];
    if (nameOf(chosen) === current) return;
    const before = current;
    current = nameOf(chosen);
    for (const tab of tabs) {
      tab.setAttribute("aria-selected", String(tab === chosen));
      tab.tabIndex = tab === chosen ? 0 : -1;
      document.getElementById(`view-${nameOf(tab)}`).hidden = tab !== chosen;
    }
    if (focus) chosen.focus();
    onShow(current, before, quiet);
  };
  /** @param {Event} event */
  const tabOf = ({ target }) => /** @type {HTMLElement} */ (/** @type {Element} */ (target).closest("[role=tab]"));
  /** @param {KeyboardEvent} event */
  const move = (event) => {
    const at = tabs.indexOf(tabOf(event));
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (at < 0 || to === undefined) return;
    event.preventDefault();
    show(nameOf(tabs[(to + tabs.length) % tabs.length]), { focus: true });
  };
  list.addEventListener("click", (event) => {
    const tab = tabOf(event);
    if (tab) show(nameOf(tab));
  });
  list.addEventListener("keydown", move);
  return { show, current: () => current, names: tabs.map(nameOf) };
};
