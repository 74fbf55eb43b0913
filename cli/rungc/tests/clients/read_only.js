// Looks at a page of `rungc serve --page --read-only`: it moves, and offers nothing that it would not do.
const { look, open } = require("./browser.js");

open(async (page) => {
  const clock = () => page.locator("#clock").innerText();
  await page.waitForFunction(() => document.getElementById("mode").textContent === "RUN", undefined, { timeout: 300_000 });
  const before = await clock();
  await page.waitForFunction((before) => document.getElementById("clock").textContent !== before, before, { timeout: 300_000 });
  return {
    buttons: await page.locator("button:visible").evaluateAll((all) => all.map((one) => one.textContent)),
    // Searching changes nothing.
    inputs: await page.locator("input:visible:not(#search), select:visible").count(),
    watched: await page.locator("#watch tbody tr").count(),
    light: await look(page, "read-only"),
  };
});
