// A page of `rungc serve --page --machine` in Firefox, driven over WebDriver BiDi.
const puppeteer = require("puppeteer-core");
const { slide } = require("./slide.js");

const [url, pictures] = process.argv.slice(2);

// The middle of the button of this name. Puppeteer could find it by the accessibility tree, which takes Firefox half a minute
// on a loaded machine.
function place(name) {
  const called = (button) => button.getAttribute("aria-label") ?? button.textContent.trim();
  const button = [...document.querySelectorAll("button")].find((button) => called(button) === name);
  button.scrollIntoView({ block: "nearest" });
  const { x, y, width, height } = button.getBoundingClientRect();
  return [x + width / 2, y + height / 2];
}

(async () => {
  const browser = await puppeteer.launch({ browser: "firefox", executablePath: process.env.RUNGC_FIREFOX, headless: true, timeout: 300_000 });
  const page = await browser.newPage();
  await page.setViewport({ width: 1280, height: 800 });
  // On a loaded machine.
  page.setDefaultTimeout(300_000);
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  await page.goto(url);
  const report = await slide({
    settle: (test, ...given) => page.waitForFunction(test, { polling: 100 }, ...given),
    read: (what) => page.evaluate(what),
    fill: (place, text) => page.locator(place).fill(text),
    press: async (name) => page.mouse.click(...(await page.evaluate(place, name))),
  });
  if (pictures) await page.screenshot({ path: `${pictures}/firefox.png` });
  const version = (await browser.version()).split("/")[0].toLowerCase();
  console.log(JSON.stringify({ browser: version, ...report, errors }));
  await browser.close();
})().catch((error) => {
  console.error(error);
  process.exit(1);
});
