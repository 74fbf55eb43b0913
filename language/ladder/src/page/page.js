const all = (selector) => document.querySelectorAll(selector);
const devices = document.getElementById("devices");

// A click on a device marks all its uses and shows where they are.
let chosen = null;
function choose(device) {
  chosen = device === chosen ? null : device;
  for (const element of all(".chosen")) element.classList.remove("chosen");
  if (chosen === null) return;
  for (const element of all(`[data-device="${CSS.escape(chosen)}"]`)) element.classList.add("chosen");
  devices.open = true;
  devices.querySelector("tr.chosen")?.scrollIntoView({ block: "nearest" });
}
document.addEventListener("click", (event) => {
  const element = event.target.closest("[data-device]");
  if (element && !event.target.closest("a")) choose(element.dataset.device);
});

// Comments of devices, by hovering.
const comments = new Map([...all("tr[data-comment]")].map((row) => [row.dataset.device, row.dataset.comment]));
document.addEventListener("mouseover", (event) => {
  const group = event.target.closest("g[data-device]");
  if (!group || group.querySelector("title")) return;
  const title = document.createElementNS("http://www.w3.org/2000/svg", "title");
  const comment = comments.get(group.dataset.device);
  title.textContent = comment ? `${group.dataset.device}: ${comment}` : group.dataset.device;
  group.append(title);
});

// Search hides the networks that do not match.
const search = document.getElementById("search");
const networks = [...all("main section")].map((section) => {
  const label = section.querySelector("svg").getAttribute("aria-label");
  const named = [...section.querySelectorAll("[data-device]")].map((group) => comments.get(group.dataset.device) ?? "");
  return [section, `${label} ${section.textContent} ${named.join(" ")}`.toLowerCase()];
});
const entries = [...all("nav ol li")];
search.addEventListener("input", () => {
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  networks.forEach(([section, text], i) => {
    const hidden = !words.every((word) => text.includes(word));
    section.hidden = hidden;
    entries[i].hidden = hidden;
  });
});
document.addEventListener("keydown", (event) => {
  if (event.key === "/" && event.target !== search) {
    event.preventDefault();
    search.focus();
  } else if (event.key === "Escape") {
    search.value = "";
    search.dispatchEvent(new Event("input"));
    if (chosen !== null) choose(chosen);
  }
});

document.getElementById("theme").addEventListener("click", () => {
  const root = document.documentElement;
  const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  root.dataset.theme = dark ? "light" : "dark";
});
