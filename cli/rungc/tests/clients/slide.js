// Uses a page of `rungc serve --page --machine` in any browser: lets a slide go to a hole, waits for power flow and forced
// devices, and stops the run. `settle` waits until a function of the page is true; `read` gives what one returns; `fill` and
// `press` are a person's hands.
async function slide({ settle, read, fill, press }) {
  // The whole text: "RUN" is also how that of a pause begins.
  const mode = (wanted) => settle((wanted) => document.getElementById("mode").textContent === wanted, wanted);
  const axes = () => read(() => [...document.querySelectorAll("#axes tbody tr")].map((row) => [row.dataset.name, row.cells[1].textContent]));
  const scan = () => read(() => Number(document.getElementById("clock").textContent.match(/scan (\d+)/)[1]));
  const enter = async (device, value, button) => {
    await fill("#device [name=device]", device);
    await fill("#device [name=value]", value);
    await press(button);
  };
  const report = {};

  await mode("RUN");
  report.begin = await axes();
  await enter("Y001", "1", "Break");
  await enter("X010", "1", "Force");
  await mode("RUN, paused: Y001 = 1");
  report.hole = await axes();
  report.marks = await read(() => document.querySelectorAll("g.forced .force-mark").length > 0);
  // A picture is brought up to date when it is painted.
  await settle(() => document.querySelectorAll("main [data-net].on").length > 0);
  await press("Release X010");
  await settle(() => document.querySelectorAll("#forces tbody tr").length === 0);
  const before = await scan();
  await press("Single scan");
  await settle((wanted) => document.getElementById("clock").textContent.endsWith(`scan ${wanted}`), before + 1);
  await press("STOP");
  await press("Continue");
  await mode("STOP");
  await settle(() => document.querySelectorAll("main [data-net].on").length === 0);
  report.stopped = await read(() => document.querySelectorAll("main [data-net].on").length);
  return report;
}

module.exports = { slide };
