// The search of the guide: sections that hold all words, those with them in their heading first.
const box = document.getElementById("search");
const found = document.getElementById("found");
const most = 30;
let sections;

/** The sections of the guide; loaded when the box is first used. */
async function load() {
  sections ??= fetch("search.json").then((answer) => answer.json());
  return sections;
}

function escaped(text) {
  return text.replace(/[&<>"]/g, (letter) => `&#${letter.charCodeAt(0)};`);
}

/** A part of a text round the first word, with all words marked. */
function excerpt(text, words) {
  const at = Math.max(0, text.toLowerCase().indexOf(words[0]) - 60);
  const part = (at ? "… " : "") + text.slice(at, at + 180) + (at + 180 < text.length ? " …" : "");
  const pattern = words.map((word) => escaped(word).replace(/[.*+?^${}()|[\]\\]/g, "\\$&")).join("|");
  return escaped(part).replace(new RegExp(pattern, "gi"), "<mark>$&</mark>");
}

/** How well a section fits: 0 where a word is missing. */
function rank({ page, heading, text }, words) {
  let sum = 0;
  for (const word of words) {
    const [inPage, inHeading, inText] = [page, heading, text].map((part) => part.toLowerCase().includes(word));
    if (!inPage && !inHeading && !inText) return 0;
    sum += 10 * inHeading + 4 * inPage + inText;
  }
  return sum;
}

async function search() {
  const words = box.value.toLowerCase().split(/\s+/).filter(Boolean);
  if (words.length === 0) return found.replaceChildren();
  const all = await load();
  const hits = all.map((section) => [rank(section, words), section]).filter(([fits]) => fits > 0);
  hits.sort(([one], [other]) => other - one);
  const shown = hits.slice(0, most).map(([, { link, page, heading, text }]) => {
    const title = heading === page ? escaped(page) : `${escaped(page)}: ${escaped(heading)}`;
    return `<li><a href="${link}">${title}</a><span>${excerpt(text, words)}</span></li>`;
  });
  const places = hits.length === 1 ? "1 place" : `${hits.length} places`;
  const told = hits.length > most ? `The first ${most} of ${places}` : hits.length ? places : "Nothing found: try fewer or other words";
  found.innerHTML = `<p>${told}</p><ul>${shown.join("")}</ul>`;
}

box.addEventListener("input", search);
box.addEventListener("focus", load);
box.addEventListener("keydown", ({ key }) => {
  if (key === "Enter") found.querySelector("a")?.click();
  if (key === "Escape") [box.value, found.innerHTML] = ["", ""];
});
document.addEventListener("keydown", (event) => {
  if (event.key !== "/" || event.target.closest("input, textarea")) return;
  event.preventDefault();
  box.focus();
});
