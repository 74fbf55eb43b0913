// Projects of vendors as lists that can only be read.

import * as path from "node:path";
import * as vscode from "vscode";
import { Missing, reportMissing, rungc } from "./rungc";

const SCHEME = "rungc";
const FILES = "**/*.{gxw,GXW,wpg,WPG,pmw,PMW}";

/** The address of the list of a project. */
function listOf(project: vscode.Uri): vscode.Uri {
  return project.with({ scheme: SCHEME, path: `${project.path}.il` });
}

function projectOf(list: vscode.Uri): vscode.Uri {
  return list.with({ scheme: "file", path: list.path.replace(/\.il$/, "") });
}

/** The list of a project. */
async function read(project: vscode.Uri): Promise<string> {
  const file = project.fsPath;
  const args = ["convert", path.basename(file), "--to", "il", "--quiet"];
  const { code, stdout, stderr } = await rungc(args, { cwd: path.dirname(file) });
  if (code !== 0) {
    throw new Error(stderr.trim() || `rungc ended with code ${code}`);
  }
  return stdout;
}

/** Shows projects as lists. */
export class Projects
  implements vscode.TextDocumentContentProvider, vscode.CustomReadonlyEditorProvider, vscode.Disposable
{
  private readonly changed = new vscode.EventEmitter<vscode.Uri>();
  private readonly subscriptions: vscode.Disposable[] = [this.changed];
  readonly onDidChange = this.changed.event;

  constructor() {
    const watcher = vscode.workspace.createFileSystemWatcher(FILES);
    watcher.onDidChange((uri) => this.changed.fire(listOf(uri)));
    this.subscriptions.push(
      watcher,
      vscode.workspace.registerTextDocumentContentProvider(SCHEME, this),
      vscode.window.registerCustomEditorProvider("rungc.project", this),
    );
  }

  async provideTextDocumentContent(list: vscode.Uri): Promise<string> {
    return read(projectOf(list));
  }

  openCustomDocument(uri: vscode.Uri): vscode.CustomDocument {
    return { uri, dispose: () => undefined };
  }

  /** Opens the list in place of the project, or shows why there is none. */
  async resolveCustomEditor(document: vscode.CustomDocument, panel: vscode.WebviewPanel): Promise<void> {
    try {
      await read(document.uri);
    } catch (error) {
      panel.webview.html = failure(error instanceof Error ? error.message : String(error));
      if (error instanceof Missing) {
        void reportMissing(error.path);
      }
      return;
    }
    const viewColumn = panel.viewColumn;
    const list = await vscode.workspace.openTextDocument(listOf(document.uri));
    await vscode.window.showTextDocument(list, { viewColumn, preview: false });
    panel.dispose();
  }

  dispose(): void {
    this.subscriptions.forEach((one) => one.dispose());
  }
}

/** A page that says why there is no list. */
function failure(message: string): string {
  const entities: Record<string, string> = { "&": "&amp;", "<": "&lt;", ">": "&gt;" };
  const text = message.replace(/[&<>]/g, (character) => entities[character] ?? "");
  const policy = "default-src 'none'; style-src 'unsafe-inline'";
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<title>rungc</title>
</head>
<body>
<h1 style="font-size: 1.2em">This project cannot be shown as a list</h1>
<pre style="white-space: pre-wrap">${text}</pre>
</body>
</html>`;
}
