// Chromium for the scripts that use pages as a person would; they print what happened as JSON.
const { chromium } = require("playwright-core");
const axe = require("axe-core");

const [page_url, pictures] = process.argv.slice(2);

// What axe says against a page, and a picture of it for those who ask.
async function look(page, name) {
  await page.evaluate(axe.source);
  const { violations } = await page.evaluate(() => window.axe.run());
  if (pictures) await page.screenshot({ path: `${pictures}/${name}.png` });
  return violations.map(({ id, nodes }) => `${id}: ${nodes[0].html.slice(0, 200)}`);
}

// How many sheets of A4 it prints on.
async function print(page, name) {
  await page.emulateMedia({ media: "print" });
  const pdf = await page.pdf({ format: "A4" });
  if (pictures) require("fs").writeFileSync(`${pictures}/${name}.pdf`, pdf);
  return (pdf.toString("latin1").match(/\/Type \/Page\b/g) ?? []).length;
}

// Bounds a hang only.
const limit_ms = 300_000;

// Opens the page in light colours; `use` gives the report.
async function open(use) {
  const quiet = ["--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu", ...quiet], timeout: limit_ms });
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, colorScheme: "light" });
  page.setDefaultTimeout(limit_ms);
  const requests = [];
  const errors = [];
  page.on("request", (request) => request.url() === page_url || requests.push(request.url()));
  page.on("pageerror", (error) => errors.push(String(error)));
  const start = Date.now();
  await page.goto(page_url);
  const loaded_ms = Date.now() - start;
  const report = await use(page);
  console.log(JSON.stringify({ loaded_ms, ...report, requests, errors }));
  await browser.close();
}

module.exports = { look, open, print };
