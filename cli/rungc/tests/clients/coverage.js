// Looks at a page of `rungc test --coverage html`.
const { look, open, print } = require("./browser.js");

open(async (page) => {
  const report = { titles: await page.locator("main h2").allInnerTexts() };
  report.sections = await page.locator("main section").count();
  report.light = await look(page, "coverage-light");
  report.missed = await page.locator("ul.missed li").allInnerTexts();
  const colour = (kind) => page.evaluate((kind) => {
    const wire = document.querySelector(`g.${kind} .wire`);
    return wire && getComputedStyle(wire).stroke;
  }, kind);
  report.colours = [await colour("all"), await colour("some"), await colour("none")];
  await page.emulateMedia({ colorScheme: "dark" });
  report.dark = await look(page, "coverage-dark");
  await page.setViewportSize({ width: 400, height: 800 });
  report.narrow = await look(page, "coverage-narrow");
  report.pages = await print(page, "coverage");
  return report;
});
