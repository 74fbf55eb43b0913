// Uses a page of `rungc diff --format html`.
const { look, open, print } = require("./browser.js");

open(async (page) => {
  const report = { titles: await page.locator("main h2").allInnerTexts() };
  report.light = await look(page, "diff-light");

  // By the keyboard alone: over the link that skips the list, and through the list.
  await page.keyboard.press("Tab");
  report.skip = await page.evaluate(() => document.activeElement.innerText);
  await page.keyboard.press("Enter");
  report.skipped_to = await page.evaluate(() => location.hash);
  await page.locator("nav a").last().focus();
  await page.keyboard.press("Enter");
  report.network = await page.evaluate(() => location.hash);
  report.seen = await page.locator(`section${report.network} svg`).first().isVisible();

  await page.emulateMedia({ colorScheme: "dark" });
  report.paper = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  report.dark = await look(page, "diff-dark");

  await page.setViewportSize({ width: 400, height: 800 });
  report.narrow = await look(page, "diff-narrow");
  report.wider_than_screen = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);

  report.pages = await print(page, "diff");
  return report;
});
