// Uses a page of `rungc serve --page --machine`: lets a slide go from hole to hole, and reads where it is.
const { look, open } = require("./browser.js");

open(async (page) => {
  const press = (name) => page.getByRole("button", { name, exact: true }).click();
  const mode = (wanted) => page.waitForFunction((wanted) => document.getElementById("mode").textContent.startsWith(wanted), wanted, { timeout: 30_000 });
  const scan = async () => Number((await page.locator("#clock").innerText()).match(/scan (\d+)/)[1]);
  const axes = () => page.locator("#axes tbody tr").evaluateAll((rows) => rows.map((row) => [row.dataset.name, row.cells[1].textContent]));
  const enter = async (device, value, button) => {
    await page.getByLabel("Device", { exact: true }).fill(device);
    await page.getByLabel("Value", { exact: true }).fill(value);
    await press(button);
  };
  const report = {};

  await mode("RUN");
  report.begin = await axes();
  await enter("Y001", "1", "Break");
  await enter("X010", "1", "Force");
  report.holes = [];
  for (let hole = 0; hole < 2; hole++) {
    await mode("RUN, paused: Y001 = 1");
    report.holes.push(await axes());
    if (hole === 0) {
      await press("Continue");
      await mode("RUN");
    }
  }
  report.trend = await page.locator("#axes svg.trend polyline").first().evaluate((line) => line.getAttribute("points").split(" ").length > 10);
  // It came from the left: ten scans before the end of its way it was not there yet, and it comes back to the same place.
  const end = await scan();
  for (let n = 1; n <= 10; n++) {
    await press("Scan back");
    await page.waitForFunction((wanted) => document.getElementById("clock").textContent.endsWith(`scan ${wanted}`), end - n, { timeout: 30_000 });
  }
  const before = await axes();
  report.before = Number.parseFloat(before[0][1]) < Number.parseFloat(report.holes[1][0][1]);
  await press("Continue");
  await mode("RUN, paused: Y001 = 1");
  report.again = (await scan()) - end;
  report.same = await axes();
  report.light = await look(page, "axes-light");
  return report;
});
