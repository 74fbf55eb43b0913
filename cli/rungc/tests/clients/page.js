// Uses a page of `rungc view`.
const { look, open, print } = require("./browser.js");

open(async (page) => {
  const report = { networks: await page.locator("main section").count() };
  report.light = await look(page, "light");

  await page.keyboard.press("/");
  await page.keyboard.type("conveyor");
  report.found = await page.locator("main section:visible").count();
  await page.keyboard.press("Escape");
  report.all = await page.locator("main section:visible").count();

  await page.locator("section g[data-device='M0']").first().click();
  report.marked = await page.locator("section g.chosen").count();
  report.row = await page.locator("tr.chosen").innerText();
  await page.locator("section g[data-device='Y000']").first().hover();
  report.hint = await page.locator("section g[data-device='Y000'] title").first().textContent();

  report.states = await page.locator("nav ul li").allInnerTexts();
  if (report.states.length > 0) {
    await page.locator("nav ul a").last().click();
    report.state = await page.evaluate(() => location.hash);
    await page.locator("#sfc a").first().focus();
    await page.keyboard.press("Enter");
    report.first_state = await page.evaluate(() => location.hash);
    await page.evaluate(() => scrollTo(0, 0));
  }

  await page.locator("#theme").click();
  report.theme = await page.evaluate(() => document.documentElement.dataset.theme);
  report.dark = await look(page, "dark");

  report.pages = await print(page, "page");
  report.printed_list = await page.locator("nav").isVisible();
  return report;
});
