// The page of the ladder: shows drawings, marks the network and the device of the cursor, reports clicks.

const vscode = acquireVsCodeApi();
const ladder = document.getElementById("ladder");
const message = document.getElementById("message");

/** A device as drawings write it, without leading zeros. */
const plain = (device) => device.toUpperCase().replace(/^([A-Z]+)0+(?=\d)/, "$1");

/** Sections by the number of their network. */
const section = (network) => document.getElementById(`n${network}`);

let selected = {};

function draw({ html, message: why }) {
  message.hidden = why === undefined;
  message.textContent = why ?? "";
  if (html === undefined) return;
  const { scrollX, scrollY } = window;
  ladder.innerHTML = html;
  for (const one of ladder.querySelectorAll("section")) one.tabIndex = 0;
  window.scrollTo(scrollX, scrollY);
  select(selected, false);
}

function select({ network, device }, follow = true) {
  const isNew = network !== selected.network;
  selected = { network, device };
  for (const one of ladder.querySelectorAll("[aria-current]")) one.removeAttribute("aria-current");
  for (const one of ladder.querySelectorAll(".chosen")) one.classList.remove("chosen");
  const current = section(network);
  current?.setAttribute("aria-current", "true");
  if (current && (follow && isNew || !isVisible(current))) current.scrollIntoView({ block: "nearest" });
  if (!device) return;
  for (const one of ladder.querySelectorAll("g[data-device]")) {
    one.classList.toggle("chosen", plain(one.dataset.device) === plain(device));
  }
}

function isVisible(element) {
  const { top, bottom } = element.getBoundingClientRect();
  return bottom > 0 && top < window.innerHeight;
}

/** The use of its device that a group draws: a network is read from left to right, and from top to bottom. */
function use(group, within) {
  const same = [...within.querySelectorAll("g[data-device]")]
    .filter((one) => one.dataset.device === group.dataset.device)
    .map((one) => [one, one.getBoundingClientRect()])
    .sort(([, a], [, b]) => a.left - b.left || a.top - b.top);
  return same.findIndex(([one]) => one === group);
}

function go(target) {
  const within = target.closest("section");
  if (!within) return;
  const group = target.closest("g[data-device]");
  const place = group ? { device: group.dataset.device, use: use(group, within) } : {};
  vscode.postMessage({ type: "go", network: Number(within.id.slice(1)), ...place });
}

document.addEventListener("click", (event) => {
  const link = event.target.closest("a[href^='#']");
  if (link) {
    event.preventDefault();
    document.getElementById(link.getAttribute("href").slice(1))?.scrollIntoView({ block: "nearest" });
  } else {
    go(event.target);
  }
});
document.addEventListener("keydown", (event) => {
  if (event.key === "Enter") go(event.target);
});
window.addEventListener("message", ({ data }) => {
  if (data.type === "draw") draw(data);
  else if (data.type === "select") select(data);
});

/** Pixels of a character of a drawing, and of what is beside it: its margin and that of the page. */
const CHARACTER = 7.3;
const BESIDE = 62 + 40;

/** Reports how many characters of a drawing fit on a line, as far as rungc draws such lines. */
function report() {
  const width = Math.floor((document.documentElement.clientWidth - BESIDE) / CHARACTER);
  vscode.postMessage({ type: "size", width: Math.min(Math.max(width, 40), 160) });
}

let resized;
window.addEventListener("resize", () => {
  clearTimeout(resized);
  resized = setTimeout(report, 200);
});
report();
