// Connects the page to the run: what changes comes as events, what is asked for goes as commands.
import { showForces, showNetworks } from "./ladder.js";
import { showAxes, showBreaks, showForceTable, showLog, showState, showWatch, lose } from "./panels.js";
import "./controls.js";

const parts = {
  networks: showNetworks,
  state: showState,
  watch: showWatch,
  forces(forces) {
    showForces(forces);
    showForceTable(forces);
  },
  breaks: showBreaks,
  axes: showAxes,
  log: showLog,
};

const events = new EventSource("events");
events.addEventListener("message", ({ data }) => {
  for (const [name, value] of Object.entries(JSON.parse(data))) parts[name]?.(value);
});
let page;
events.addEventListener("page", ({ data }) => {
  // After a restart with another program, the page is a different one.
  if (page && page !== data) location.reload();
  page = data;
});
events.addEventListener("open", () => lose(false));
events.addEventListener("error", () => lose(true, events.readyState === EventSource.CLOSED));

document.getElementById("theme").addEventListener("click", () => {
  const root = document.documentElement;
  const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  root.dataset.theme = dark ? "light" : "dark";
});
