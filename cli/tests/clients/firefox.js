// A page of `rungc serve --page --machine` in Firefox, driven over WebDriver BiDi.
const puppeteer = require("puppeteer-core");
const { slide } = require("./slide.js");

const [url, pictures] = process.argv.slice(2);

(async () => {
  const browser = await puppeteer.launch({ browser: "firefox", executablePath: process.env.RUNGC_FIREFOX, headless: true });
  const page = await browser.newPage();
  await page.setViewport({ width: 1280, height: 800 });
  // On a loaded machine.
  page.setDefaultTimeout(120_000);
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  await page.goto(url);
  const report = await slide({
    settle: (test, ...given) => page.waitForFunction(test, { polling: 100 }, ...given),
    read: (what) => page.evaluate(what),
    fill: (place, text) => page.locator(place).fill(text),
    press: (name) => page.locator(`::-p-aria([name="${name}"][role="button"])`).click(),
  });
  if (pictures) await page.screenshot({ path: `${pictures}/firefox.png` });
  const version = (await browser.version()).split("/")[0].toLowerCase();
  console.log(JSON.stringify({ browser: version, ...report, errors }));
  await browser.close();
})().catch((error) => {
  console.error(error);
  process.exit(1);
});
