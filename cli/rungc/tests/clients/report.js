// Looks at a page of `rungc verify --report`.
const { look, open, print } = require("./browser.js");

open(async (page) => {
  const report = { titles: await page.locator("main h2").allInnerTexts() };
  report.matrix = await page.locator("main section:first-of-type tbody tr").allInnerTexts();
  report.light = await look(page, "report-light");
  report.diagrams = await page.locator("figure.diagram svg").count();
  report.networks = await page.locator("figure:not(.diagram) figcaption").allInnerTexts();
  report.power = await page.evaluate(() => getComputedStyle(document.querySelector(".wire.lit")).stroke);
  report.followed = await page.locator("tbody a").nth(1).click().then(() => page.evaluate(() => location.hash));
  await page.emulateMedia({ colorScheme: "dark" });
  report.dark = await look(page, "report-dark");
  await page.setViewportSize({ width: 400, height: 800 });
  report.narrow = await look(page, "report-narrow");
  report.wider = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  report.pages = await print(page, "report");
  return report;
});
