/** Light or dark theme: the setting of the system, or of the user in this browser. */
// A classic script, loaded before the first paint, so that the page does not flash.

(() => {
  const KEY = "rocking.theme";
  const root = document.documentElement;
  const dark = matchMedia("(prefers-color-scheme: dark)");

  const kept = () => {
    try {
      return localStorage.getItem(KEY);
    } catch {
      return null;
    }
  };

  const apply = () => {
    root.dataset.theme = kept() ?? (dark.matches ? "dark" : "light");
    document.dispatchEvent(new CustomEvent("rocking:theme"));
  };

  const toggle = () => {
    try {
      localStorage.setItem(KEY, root.dataset.theme === "dark" ? "light" : "dark");
    } catch {
      // Without storage the choice applies to this page only.
    }
    apply();
  };

  dark.addEventListener("change", apply);
  document.addEventListener("rocking:toggle-theme", toggle);
  apply();
})();
