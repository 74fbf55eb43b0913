// Shows what is beside the ladder: state, watch list, forced devices, breakpoints, the machine, the log.
import { send } from "./controls.js";

const find = (id) => document.getElementById(id);
const MINUTE = 60_000;
const ENTRIES = 500;

function element(name, text, attributes = {}) {
  const made = document.createElement(name);
  made.textContent = text;
  for (const [attribute, value] of Object.entries(attributes)) made.setAttribute(attribute, value);
  return made;
}

function button(text, label, command) {
  const made = element("button", text, { type: "button", "aria-label": label });
  made.addEventListener("click", () => send(command));
  return made;
}

function row(cells) {
  const made = document.createElement("tr");
  cells.forEach((cell, i) => {
    const place = element(i === 0 ? "th" : "td", typeof cell === "string" ? cell : "");
    if (i === 0) place.scope = "row";
    if (typeof cell !== "string") place.append(cell);
    made.append(place);
  });
  return made;
}

let now = 0;

// Points of the last minute of each name, and lines through them.
const trends = new Map();

// They survive that the page is loaded again, as long as it is the same run.
const KEPT = "trends";
let run;

function restore() {
  let kept;
  try {
    kept = JSON.parse(sessionStorage.getItem(KEPT));
  } catch {
    return;
  }
  if (kept?.run !== run) return;
  for (const [name, points] of kept.trends) {
    const { points: own } = trend(name);
    own.unshift(...points.filter(([at]) => at < (own[0]?.[0] ?? now)));
  }
}

addEventListener("pagehide", () => {
  const kept = [...trends].map(([name, { points }]) => [name, points]);
  try {
    sessionStorage.setItem(KEPT, JSON.stringify({ run, trends: kept }));
  } catch {
    // Without storage, trends begin anew.
  }
});

export function showState(state) {
  now = state.ms;
  if (run !== state.run) {
    run = state.run;
    restore();
  }
  const mode = find("mode");
  const text = [state.running ? "RUN" : "STOP", state.paused ? `paused: ${state.paused}` : "", state.slower > 1 ? `${state.slower} × slower` : ""];
  const shown = text.filter(Boolean).join(", ");
  if (mode.textContent !== shown) mode.title = mode.textContent = shown;
  mode.dataset.mode = state.running ? "run" : "stop";
  find("clock").textContent = `${(now / 1000).toFixed(3)} s, scan ${state.scans}`;
  const able = { run: !state.running, stop: state.running, pause: !state.paused, continue: state.paused, back: state.back > 0 };
  for (const [name, is] of Object.entries(able)) {
    for (const control of document.querySelectorAll(`[data-do=${name}]`)) control.disabled = !is;
  }
  find("pace").value = state.slower;
  for (const [name, { points }] of trends) if (points.length > 0) addPoint(name, points.at(-1)[1]);
  for (const section of document.querySelectorAll("section.stopped")) section.classList.remove("stopped");
  if (state.network) find(`n${state.network}`)?.classList.add("stopped");
}


function trend(name) {
  if (!trends.has(name)) {
    const picture = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    picture.setAttribute("class", "trend");
    picture.setAttribute("viewBox", "0 0 100 20");
    picture.setAttribute("preserveAspectRatio", "none");
    picture.setAttribute("role", "img");
    picture.append(document.createElementNS("http://www.w3.org/2000/svg", "polyline"));
    trends.set(name, { points: [], picture });
  }
  return trends.get(name);
}

function addPoint(name, value) {
  const { points, picture } = trend(name);
  while (points.length > 0 && points.at(-1)[0] > now) points.pop();
  const last = points.at(-1)?.[1];
  if (last === value && points.at(-2)?.[1] === value) points.pop();
  else if (last !== undefined && last !== value) points.push([now, last]);
  points.push([now, value]);
  while (points.length > 2 && points[1][0] < now - MINUTE) points.shift();
  const values = points.map(([, value]) => value);
  const [least, most] = [Math.min(...values), Math.max(...values)];
  const place = ([at, value]) => `${(100 - (100 * (now - at)) / MINUTE).toFixed(1)},${most === least ? 10 : (19 - (18 * (value - least)) / (most - least)).toFixed(1)}`;
  picture.firstChild.setAttribute("points", points.map(place).join(" "));
  picture.setAttribute("aria-label", `${name} between ${least} and ${most}`);
}

// Rows are kept, so that a button that is pressed is not replaced under the pointer.
function table(id, items, name, cells) {
  const body = find(id).tBodies[0];
  const rows = new Map([...body.rows].map((row) => [row.dataset.name, row]));
  const wanted = items.map((item) => {
    const kept = rows.get(name(item)) ?? row(cells(item));
    kept.dataset.name = name(item);
    kept.cells[1].textContent = item.value;
    return kept;
  });
  if (wanted.length !== body.rows.length || wanted.some((row, i) => row !== body.rows[i])) body.replaceChildren(...wanted);
}

export function showWatch(items) {
  for (const { device, number } of items) if (number !== null) addPoint(device, number);
  table("watch", items, (item) => item.device, ({ device }) => [device, "", trend(device).picture, button("×", `Remove ${device}`, { do: "unwatch", device })]);
}

export function showForceTable(items) {
  table("forces", items, (item) => item.device, ({ device }) => [device, "", button("Release", `Release ${device}`, { do: "release", device })]);
  for (const control of document.querySelectorAll("[data-do=release-all]")) control.disabled = items.length === 0;
}

export function showAxes(items) {
  find("machine").hidden = items.length === 0;
  for (const { name, number } of items) addPoint(name, number);
  table("axes", items, (item) => item.name, ({ name }) => [name, "", trend(name).picture]);
}

export function showBreaks(items) {
  const rows = items.map(({ text }, index) => {
    const made = element("li", `${text} `);
    made.append(button("×", `Remove ${text}`, { do: "unbreak", index }));
    return made;
  });
  find("breaks").replaceChildren(...rows);
  for (const section of document.querySelectorAll("section.break")) section.classList.remove("break");
  for (const { network } of items) if (network) find(`n${network}`)?.classList.add("break");
}

export function showLog(entries) {
  const log = find("log");
  const atEnd = log.scrollHeight - log.scrollTop - log.clientHeight < 8;
  for (const { ms, kind, text } of entries) log.append(element("li", `${(ms / 1000).toFixed(3)} ${text}`, { class: kind }));
  while (log.children.length > ENTRIES) log.firstChild.remove();
  if (atEnd) log.scrollTop = log.scrollHeight;
}

export function lose(lost, forGood = false) {
  document.body.classList.toggle("lost", lost);
  find("lost").hidden = !lost || forGood;
  find("refused").hidden = !forGood;
  if (lost) {
    find("mode").textContent = "not connected";
    find("mode").dataset.mode = "lost";
  }
}
