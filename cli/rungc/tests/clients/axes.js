// Uses a page of `rungc serve --page --machine`: lets a slide go from hole to hole, and reads where it is.
const { look, open } = require("./browser.js");

open(async (page) => {
  const press = (name) => page.getByRole("button", { name, exact: true }).click();
  const settle = (test, argument) => page.waitForFunction(test, argument, { timeout: 300_000 });
  // A pause after scan `after`: the page may still show an earlier one when a run has just been continued.
  const pause = (after) => settle((after) => {
    const scan = Number(document.getElementById("clock").textContent.match(/scan (\d+)/)?.[1]);
    return document.getElementById("mode").textContent === "RUN, paused: Y001 = 1" && scan > after;
  }, after);
  const scan = async () => Number((await page.locator("#clock").innerText()).match(/scan (\d+)/)[1]);
  const axes = () => page.locator("#axes tbody tr").evaluateAll((rows) => rows.map((row) => [row.dataset.name, row.cells[1].textContent]));
  const enter = async (device, value, button) => {
    await page.getByLabel("Device", { exact: true }).fill(device);
    await page.getByLabel("Value", { exact: true }).fill(value);
    await press(button);
  };
  const report = {};

  await settle(() => document.getElementById("mode").textContent === "RUN");
  report.begin = await axes();
  await enter("Y001", "1", "Break");
  await enter("X010", "1", "Force");
  report.holes = [];
  await pause(0);
  report.holes.push(await axes());
  const first = await scan();
  await press("Continue");
  await pause(first);
  report.holes.push(await axes());
  report.trend = await page.locator("#axes svg.trend polyline").first().evaluate((line) => line.getAttribute("points").split(" ").length > 10);
  // It came from the left: ten scans before the end of its way it was not there yet, and it comes back to the same place.
  const end = await scan();
  for (let n = 1; n <= 10; n++) {
    await press("Scan back");
    await settle((wanted) => document.getElementById("clock").textContent.endsWith(`scan ${wanted}`), end - n);
  }
  const before = await axes();
  report.before = Number.parseFloat(before[0][1]) < Number.parseFloat(report.holes[1][0][1]);
  await press("Continue");
  await pause(end - 10);
  report.again = (await scan()) - end;
  report.same = await axes();
  report.light = await look(page, "axes-light");
  return report;
});
