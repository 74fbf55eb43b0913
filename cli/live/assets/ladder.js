// Shows in the pictures of the networks where power flows. Only pictures that are seen are brought up to date.
const sections = [...document.querySelectorAll("main > section")];
const states = new Map();
const seen = new Set();
const elements = new Map();

function partsOf(section) {
  if (!elements.has(section)) {
    const grouped = (name) => Map.groupBy(section.querySelectorAll(`[data-${name}]`), (element) => Number(element.dataset[name]));
    const texts = [...section.querySelectorAll("[data-value]")];
    elements.set(section, { nets: grouped("net"), links: grouped("link"), values: texts.map((element) => [element.dataset.value, element.firstElementChild]) });
  }
  return elements.get(section);
}

function light(groups, digits) {
  for (const [number, group] of groups) {
    const on = digits[number] === "1";
    for (const element of group) element.classList.toggle("on", on);
  }
}

function show(section) {
  const state = states.get(section.id);
  if (!state) return;
  const [nets, links, values] = state;
  const parts = partsOf(section);
  light(parts.nets, nets);
  light(parts.links, links);
  for (const [number, text] of parts.values) {
    const value = values[number] ?? "";
    if (text.textContent !== value) text.textContent = value;
  }
}

const observer = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    if (isIntersecting) {
      seen.add(target.id);
      show(target);
    } else seen.delete(target.id);
  }
}, { rootMargin: "50%" });
for (const section of sections) observer.observe(section);

export function showNetworks(changed) {
  for (const [number, state] of Object.entries(changed)) {
    const id = `n${number}`;
    states.set(id, state);
    if (seen.has(id)) show(document.getElementById(id));
  }
}

// Search hides the networks that do not match.
const search = document.getElementById("search");
const texts = sections.map((section) => {
  const devices = [...section.querySelectorAll("[data-device]")].map((group) => group.dataset.device);
  return `${section.textContent} ${devices.join(" ")}`.toLowerCase();
});
const entries = [...document.querySelectorAll("nav ol li")];

function find() {
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  sections.forEach((section, i) => {
    const hidden = !words.every((word) => texts[i].includes(word));
    section.hidden = hidden;
    if (entries[i]) entries[i].hidden = hidden;
  });
}
search.addEventListener("input", find);
document.addEventListener("keydown", (event) => {
  if (event.key === "/" && !event.target.matches("input, select")) {
    event.preventDefault();
    search.focus();
  } else if (event.key === "Escape" && search.value !== "") {
    search.value = "";
    find();
  }
});

// Marks forced devices with an F.
export function showForces(forces) {
  for (const mark of document.querySelectorAll(".force-mark")) mark.remove();
  for (const group of document.querySelectorAll("g.forced")) group.classList.remove("forced");
  for (const { device } of forces) {
    const name = CSS.escape(device.split(".")[0]);
    for (const group of document.querySelectorAll(`main g[data-device="${name}"]`)) {
      const area = group.querySelector(".area");
      const mark = document.createElementNS("http://www.w3.org/2000/svg", "text");
      mark.classList.add("force-mark");
      mark.setAttribute("x", Number(area.getAttribute("x")) + 3);
      mark.setAttribute("y", Number(area.getAttribute("y")) + 12);
      mark.textContent = "F";
      group.append(mark);
      group.classList.add("forced");
    }
  }
}
