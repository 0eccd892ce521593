/** Light or dark: the system's choice, or the user's, kept in this browser. */
// A classic script, loaded before the first paint so that the page never flashes.

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
      // Nothing is kept; the choice lasts for nothing but this page.
    }
    apply();
  };

  dark.addEventListener("change", apply);
  document.addEventListener("rocking:toggle-theme", toggle);
  apply();
})();
