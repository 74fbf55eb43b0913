// Test files and properties in the Test Explorer.

import * as path from "node:path";
import * as vscode from "vscode";
import { type Found, cases, properties } from "./found";
import { details } from "./coverage";
import { type File, type Job, runAll, runCoverage } from "./jobs";

/** Files with cases or properties, without those of tools. */
const FILES = "**/{*.plctest.toml,rungc.toml}";
const LEFT_OUT = "**/{node_modules,target}/**";

/** Tests of the workspace. */
export class Tests implements vscode.Disposable {
  private readonly controller = vscode.tests.createTestController("rungc", "rungc");
  private readonly found = new WeakMap<vscode.TestItem, Found>();
  private readonly subscriptions: vscode.Disposable[] = [this.controller];

  constructor() {
    const { Run, Coverage } = vscode.TestRunProfileKind;
    const add = (label: string, kind: vscode.TestRunProfileKind, job: Job) =>
      this.controller.createRunProfile(
        label,
        kind,
        (request, token) => this.run(request, token, job),
        true,
      );
    add("Run", Run, runAll);
    const coverage = add("Run with Coverage", Coverage, runCoverage);
    coverage.loadDetailedCoverage = async (_run, file) => details(file);
    this.controller.resolveHandler = (item) => (item ? this.read(item) : this.discover());
    this.controller.refreshHandler = () => this.discover();

    const watcher = vscode.workspace.createFileSystemWatcher(FILES);
    watcher.onDidCreate((uri) => this.update(uri));
    watcher.onDidChange((uri) => this.update(uri));
    watcher.onDidDelete((uri) => this.controller.items.delete(uri.toString()));
    this.subscriptions.push(
      watcher,
      vscode.workspace.onDidOpenTextDocument((document) => this.show(document)),
      vscode.workspace.onDidChangeTextDocument(({ document }) => this.show(document)),
    );
    void this.discover();
  }

  private async discover(): Promise<void> {
    const files = await vscode.workspace.findFiles(FILES, LEFT_OUT);
    const known = new Set(files.map(String));
    this.controller.items.forEach((item) => {
      if (!known.has(item.id)) {
        this.controller.items.delete(item.id);
      }
    });
    await Promise.all(files.map((uri) => this.update(uri)));
  }

  private async update(uri: vscode.Uri): Promise<void> {
    if (/\/(node_modules|target)\//.test(uri.path)) {
      return;
    }
    try {
      const content = await vscode.workspace.fs.readFile(uri);
      this.put(uri, new TextDecoder().decode(content));
    } catch {
      // It has just been removed, or cannot be read.
      this.controller.items.delete(uri.toString());
    }
  }

  private async read(item: vscode.TestItem): Promise<void> {
    if (item.uri && !item.parent) {
      await this.update(item.uri);
    }
  }

  /** Takes a text of the editor, saved or not. */
  private show(document: vscode.TextDocument): void {
    const isTest = /(\.plctest|[\\/]rungc)\.toml$/.test(document.fileName);
    if (document.uri.scheme === "file" && isTest) {
      this.put(document.uri, document.getText());
    }
  }

  /** Puts the tests of a file into the tree. */
  private put(uri: vscode.Uri, text: string): void {
    const isTestFile = uri.path.endsWith(".plctest.toml");
    const all = isTestFile ? cases(text) : properties(text);
    const id = uri.toString();
    if (all.length === 0) {
      this.controller.items.delete(id);
      return;
    }
    const label = vscode.workspace.asRelativePath(uri);
    const file = this.controller.items.get(id) ?? this.controller.createTestItem(id, label, uri);
    const items = all.map((one, i) => {
      const isTwice = all.findIndex((other) => other.label === one.label) !== i;
      const ofTest = `${id}::${one.label}${isTwice ? ` ${i}` : ""}`;
      const item =
        file.children.get(ofTest) ?? this.controller.createTestItem(ofTest, one.label, uri);
      item.range = new vscode.Range(one.line, 0, one.line, 0);
      this.found.set(item, one);
      return item;
    });
    file.children.replace(items);
    this.controller.items.add(file);
  }

  /** Runs the requested tests, file by file. */
  private async run(
    request: vscode.TestRunRequest,
    token: vscode.CancellationToken,
    job: Job,
  ): Promise<void> {
    const run = this.controller.createTestRun(request);
    try {
      if (!vscode.workspace.isTrusted) {
        run.appendOutput("Tests run only in a trusted workspace.\r\n");
        return;
      }
      await job({ run, token, files: this.requested(request) });
    } finally {
      run.end();
    }
  }

  /** The requested tests, by file. */
  private requested(request: vscode.TestRunRequest): File[] {
    const top: vscode.TestItem[] = [];
    this.controller.items.forEach((item) => top.push(item));
    const isIn = (list: readonly vscode.TestItem[] | undefined, item: vscode.TestItem) =>
      list?.some((one) => one === item || one === item.parent) ?? false;
    const isWanted = (item: vscode.TestItem) =>
      !isIn(request.exclude, item) &&
      (request.include === undefined || isIn(request.include, item));
    return top.flatMap((file) => {
      const items: vscode.TestItem[] = [];
      file.children.forEach((item) => items.push(item));
      const wanted = items.filter(isWanted);
      if (wanted.length === 0 || !file.uri) {
        return [];
      }
      const found = items.flatMap((item) => this.found.get(item) ?? []);
      const name = path.basename(file.uri.fsPath);
      return {
        uri: file.uri,
        name,
        cwd: path.dirname(file.uri.fsPath),
        hasCases: name !== "rungc.toml",
        items: wanted,
        isWhole: wanted.length === items.length,
        found,
        of: (one: Found) => items.find((item) => this.found.get(item) === one),
      };
    });
  }

  dispose(): void {
    this.subscriptions.forEach((one) => one.dispose());
  }
}
