// Uses a page of `rungc serve --page`: watches, forces, stops and continues a run.
const { look, open } = require("./browser.js");

open(async (page) => {
  const press = (name) => page.getByRole("button", { name, exact: true }).click();
  const text = (selector) => page.locator(selector).innerText();
  const settle = (test, argument) => page.waitForFunction(test, argument, { timeout: 300_000 });
  // The whole text: "RUN" is also how that of a pause begins.
  const mode = (wanted) => settle((wanted) => document.getElementById("mode").textContent === wanted, wanted);
  const lit = (network) => page.locator(`#n${network} [data-net].on`).count();
  const enter = async (device, value, button) => {
    await page.getByLabel("Device", { exact: true }).fill(device);
    await page.getByLabel("Value", { exact: true }).fill(value);
    await press(button);
  };
  const report = {};

  await mode("RUN");
  await settle(() => document.querySelectorAll("#n1 [data-net].on").length > 0);
  report.before = await lit(1);
  // Time stands still while the page is used, however long that takes.
  await press("Pause");
  await mode("RUN, paused: by hand");
  await enter("x0", "1", "Force");
  await settle(() => document.querySelectorAll(".force-mark").length > 0);
  const scan = async () => Number((await text("#clock")).match(/scan (\d+)/)[1]);
  const paused = await scan();
  await press("Single scan");
  await settle((old) => document.getElementById("clock").textContent.endsWith(`scan ${old + 1}`), paused);
  await page.waitForTimeout(300);
  report.scanned = (await scan()) - paused;
  await settle(() => document.querySelectorAll("#n1 [data-net].on").length > 2);
  report.forced = await text("#forces tbody");
  report.marks = await page.locator("#n1 g.forced .force-mark").count();
  report.timer = (await page.locator("#n2 [data-value]").first().textContent()).trim().replace(/=\d+/, "=");

  await enter("D1", "7", "Set");
  await enter("D1", "", "Watch");
  await settle(() => document.querySelector('#watch tr[data-name="D1"] td')?.textContent === "7");
  report.set = await text("#watch tr[data-name='D1'] td >> nth=0");
  await enter("Q9", "", "Watch");
  await settle(() => document.getElementById("problem").textContent !== "");
  report.problem = await text("#problem");

  await enter("Y000", "1", "Break");
  await press("Release X000");
  await press("Continue");
  await mode("RUN, paused: Y000 = 1");
  report.broken = await text("#breaks");
  const broken = await scan();
  await press("Scan back");
  await settle((old) => document.getElementById("clock").textContent.endsWith(`scan ${old - 1}`), broken);
  report.back = await text("#watch tr[data-name='Y000'] td >> nth=0");
  await press("Single scan");
  await settle((old) => document.getElementById("clock").textContent.endsWith(`scan ${old}`), broken);
  await mode("RUN, paused: Y000 = 1");
  report.again = (await scan()) - broken;
  report.light = await look(page, "live-light");
  await page.locator("#theme").click();
  report.dark = await look(page, "live-dark");
  await press("Continue");
  await mode("RUN");
  await page.getByLabel("Slower").selectOption("10");
  await mode("RUN, 10 × slower");
  report.slower = await text("#mode");
  await page.getByLabel("Slower").selectOption("1");
  await mode("RUN");
  await page.getByRole("textbox", { name: "Network" }).fill("1");
  await press("Break when power reaches an output");
  await enter("X001", "1", "Force");
  await settle(() => document.querySelector('#watch tr[data-name="M0"] td').textContent === "0");
  await press("Release X001");
  await enter("X001", "0", "Set");
  await enter("X000", "1", "Force");
  await settle(() => document.getElementById("mode").textContent.startsWith("RUN, paused: "));
  await page.setViewportSize({ width: 420, height: 800 });
  report.paused_wider_than_screen = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  await page.setViewportSize({ width: 1280, height: 800 });
  report.network = await page.locator("section.stopped").evaluateAll((sections) => sections.map(({ id }) => id));
  report.reason = await text("#mode");
  await press("Release X000");
  await enter("X000", "0", "Set");
  await press("Continue");
  await mode("RUN");
  await press("STOP");
  await mode("STOP");
  await settle(() => document.querySelectorAll("main [data-net].on").length === 0);
  report.stopped = await lit(1);
  await press("RUN");
  await mode("RUN");
  // Whatever the run says, controls stay where they are, and ladder and panels are seen.
  const place = async () => {
    const { x, y } = await page.getByRole("button", { name: "STOP", exact: true }).boundingBox();
    return `${x} ${y}`;
  };
  report.moved = [];
  report.unseen = [];
  for (const width of [1440, 1270, 1100, 800, 420]) {
    await page.setViewportSize({ width, height: 800 });
    const before = await place();
    await press("Pause");
    await mode("RUN, paused: by hand");
    if ((await place()) !== before) report.moved.push(width);
    await press("Continue");
    await mode("RUN");
    const tops = await page.evaluate(() => ["main > section", "aside h2"].map((part) => document.querySelector(part).getBoundingClientRect().top / innerHeight));
    if (tops.some((top) => top < 0 || top > 0.9)) report.unseen.push(width);
  }
  await page.setViewportSize({ width: 1280, height: 800 });
  // Enter sets, or watches if there is no value.
  await page.getByLabel("Device", { exact: true }).fill("D1");
  await page.getByLabel("Value", { exact: true }).fill("9");
  await page.getByLabel("Value", { exact: true }).press("Enter");
  await settle(() => document.querySelector('#watch tr[data-name="D1"] td').textContent === "9");
  await page.getByLabel("Value", { exact: true }).fill("");
  await page.getByLabel("Device", { exact: true }).fill("D2");
  await page.getByLabel("Device", { exact: true }).press("Enter");
  await settle(() => document.querySelector('#watch tr[data-name="D2"]') !== null);
  report.networks = await page.locator("main > section:visible").count();
  await page.getByLabel("Search").fill("t0");
  report.found = await page.locator("main > section:visible").count();
  await page.getByLabel("Search").press("Escape");
  // The trend of D1 has more than the two ends that a constant has.
  const bent = () => document.querySelector('#watch tr[data-name="D1"] polyline')?.getAttribute("points")?.split(" ").length > 2;
  await settle(bent);
  await page.reload();
  await mode("RUN");
  await settle(bent);
  await page.setViewportSize({ width: 420, height: 800 });
  report.narrow = await look(page, "live-narrow");
  report.wider_than_screen = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  report.elsewhere = await page.evaluate(() => performance.getEntriesByType("resource").filter(({ name }) => !name.startsWith(location.href)).map(({ name }) => name));
  report.log = await page.locator("#log li").evaluateAll((rows) => rows.map((row) => row.textContent.replace(/^\S+ /, "").replace(/(?<=at scan) \d+/, "")));
  return report;
});
