// The search page: sections and documented names that match the words of a query, the best match first.
const ASKING = new Set(
  ("a an and are as at be by can could did do does for from get give given gives how i if in into is it me my need of on or " +
    "should that the there this to use was what when where which who why will with you your").split(" "),
);
const SPELLED = new Map([["center", "centre"], ["centers", "centres"], ["meter", "metre"], ["meters", "metres"], ["color", "colour"]]);
const WEIGHTS = { how_to: 1.7, choose_a_tool: 1.5, commands: 1.3, terms: 1.3, reference: 0.5, changes: 0.3 };
const termOf = (term) => {
  const word = term.toLowerCase();
  if (ASKING.has(word)) return null;
  const spelled = SPELLED.get(word) ?? word;
  return spelled.length > 3 ? spelled.replace(/(?<=[^s])s$/, "") : spelled;
};

const index = new MiniSearch({
  fields: ["title", "terms", "page", "text"],
  storeFields: ["title", "page", "address", "text"],
  processTerm: termOf,
  searchOptions: {
    boost: { title: 5, terms: 4, page: 1.5 },
    fuzzy: (term) => (term.length > 5 ? 0.2 : false),
    prefix: (term) => term.length > 3,
    boostDocument: (id, term, section) => WEIGHTS[section.address.split(/[/.]/)[0]] ?? 1,
  },
});
index.addAll(sections);

const element = (name, properties, ...children) => {
  const node = Object.assign(document.createElement(name), properties);
  node.append(...children);
  return node;
};

// The segment of the text around the first term, with all terms marked.
function excerpt(text, terms) {
  const pattern = terms.map((term) => term.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")).join("|");
  const marks = new RegExp(`\\b(?:${pattern})`, "gi");
  const first = Math.max(0, text.search(marks) - 60);
  const begin = first === 0 ? 0 : text.indexOf(" ", first) + 1;
  const shown = text.slice(begin, begin + 220);
  const paragraph = element("p", {}, begin ? "… " : "");
  let last = 0;
  for (const hit of shown.matchAll(marks)) {
    paragraph.append(shown.slice(last, hit.index), element("mark", { textContent: hit[0] }));
    last = hit.index + hit[0].length;
  }
  paragraph.append(shown.slice(last), text.length > begin + 220 ? " …" : "");
  return paragraph;
}

const query = new URLSearchParams(location.search).get("q") ?? "";
const hits = index.search(query).slice(0, 30);
for (const box of document.querySelectorAll("input[name=q]")) box.value = query;
document.getElementById("search-summary").textContent = !query.trim()
  ? "Enter a question or a term."
  : hits.length
    ? `Results for “${query}”, the best match first.`
    : `No result for “${query}”. Use other words or fewer words.`;
document.getElementById("search-results").append(
  ...hits.map((hit) =>
    element(
      "li",
      {},
      element("a", { href: hit.address, textContent: hit.title }),
      hit.page === hit.title ? "" : element("small", { textContent: hit.page }),
      excerpt(hit.text, hit.terms),
    ),
  ),
);
