// Uses a page of `rungc serve --page --machine` in Firefox, driven over WebDriver BiDi.
const puppeteer = require("puppeteer-core");

const [url, pictures] = process.argv.slice(2);

(async () => {
  const browser = await puppeteer.launch({ browser: "firefox", executablePath: process.env.RUNGC_FIREFOX, headless: true });
  const page = await browser.newPage();
  await page.setViewport({ width: 1280, height: 800 });
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  await page.goto(url);
  const settle = (test, ...given) => page.waitForFunction(test, { timeout: 60_000, polling: 100 }, ...given);
  const mode = (wanted) => settle((wanted) => document.getElementById("mode").textContent.startsWith(wanted), wanted);
  const press = (name) => page.locator(`::-p-aria([name="${name}"][role="button"])`).click();
  const axes = () => page.evaluate(() => [...document.querySelectorAll("#axes tbody tr")].map((row) => [row.dataset.name, row.cells[1].textContent]));
  const enter = async (device, value, button) => {
    await page.locator("#device [name=device]").fill(device);
    await page.locator("#device [name=value]").fill(value);
    await press(button);
  };
  const report = { browser: (await browser.version()).split("/")[0].toLowerCase() };

  await mode("RUN");
  report.begin = await axes();
  await enter("Y001", "1", "Break");
  await enter("X010", "1", "Force");
  await mode("RUN, paused: Y001 = 1");
  report.hole = await axes();
  report.marks = await page.evaluate(() => document.querySelectorAll("g.forced .force-mark").length > 0);
  report.powered = await page.evaluate(() => document.querySelectorAll("main [data-net].on").length > 0);
  await press("Release X010");
  await settle(() => document.querySelectorAll("#forces tbody tr").length === 0);
  await press("Single scan");
  await mode("RUN, paused");
  await press("STOP");
  await press("Continue");
  await mode("STOP");
  report.stopped = await page.evaluate(() => document.querySelectorAll("main [data-net].on").length);
  if (pictures) await page.screenshot({ path: `${pictures}/firefox.png` });
  console.log(JSON.stringify({ ...report, errors }));
  await browser.close();
})().catch((error) => {
  console.error(error);
  process.exit(1);
});
