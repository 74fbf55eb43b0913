// Opens a page of `rungc view` in Chromium, uses it as a person would, and prints what happened as JSON.
const { chromium } = require("playwright-core");
const axe = require("axe-core");

const [page_url, pictures] = process.argv.slice(2);

async function violations(page) {
  await page.evaluate(axe.source);
  const { violations } = await page.evaluate(() => window.axe.run());
  return violations.map(({ id, nodes }) => `${id}: ${nodes[0].html.slice(0, 200)}`);
}

(async () => {
  const quiet = ["--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu", ...quiet] });
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, colorScheme: "light" });
  const requests = [];
  const errors = [];
  page.on("request", (request) => request.url() === page_url || requests.push(request.url()));
  page.on("pageerror", (error) => errors.push(String(error)));
  const start = Date.now();
  await page.goto(page_url);
  const report = { loaded_ms: Date.now() - start, networks: await page.locator("main section").count() };
  report.light = await violations(page);
  if (pictures) await page.screenshot({ path: `${pictures}/light.png` });

  await page.keyboard.press("/");
  await page.keyboard.type("conveyor");
  report.found = await page.locator("main section:visible").count();
  await page.keyboard.press("Escape");
  report.all = await page.locator("main section:visible").count();

  await page.locator("g[data-device='M0']").first().click();
  report.marked = await page.locator("g.chosen").count();
  report.row = await page.locator("tr.chosen").innerText();
  await page.locator("g[data-device='Y000']").first().hover();
  report.hint = await page.locator("g[data-device='Y000'] title").first().textContent();

  await page.locator("#theme").click();
  report.theme = await page.evaluate(() => document.documentElement.dataset.theme);
  report.dark = await violations(page);
  if (pictures) await page.screenshot({ path: `${pictures}/dark.png` });

  await page.emulateMedia({ media: "print" });
  report.printed_list = await page.locator("nav").isVisible();
  const pdf = await page.pdf({ format: "A4" });
  report.pages = (pdf.toString("latin1").match(/\/Type \/Page\b/g) ?? []).length;
  if (pictures) require("fs").writeFileSync(`${pictures}/page.pdf`, pdf);
  console.log(JSON.stringify({ ...report, requests, errors }));
  await browser.close();
})();
