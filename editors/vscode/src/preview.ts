// The ladder of the list in the active editor.

import { randomBytes } from "node:crypto";
import * as fs from "node:fs/promises";
import * as os from "node:os";
import * as path from "node:path";
import * as vscode from "vscode";
import { type Network, type Symbol, networkAt, networks, places } from "./networks";
import { report, rungc } from "./rungc";

/** A drawing follows the text when nothing has changed for this long, in milliseconds. */
const PAUSE = 250;

/** Messages of the page. */
type FromPage =
  | { type: "size"; width: number }
  | { type: "go"; network: number; device?: string; use?: number };

/** The panel with the ladder, which follows the active editor. */
export class Preview implements vscode.Disposable {
  private panel: vscode.WebviewPanel | undefined;
  private document: vscode.TextDocument | undefined;
  private found: { version: number; networks: Network[] } | undefined;
  private timer: NodeJS.Timeout | undefined;
  /** Characters on a line of the page, once it is ready. */
  private width: number | undefined;
  private readonly subscriptions: vscode.Disposable[] = [];

  constructor(private readonly media: vscode.Uri) {
    this.subscriptions.push(
      vscode.window.onDidChangeActiveTextEditor((editor) => this.follow(editor)),
      vscode.window.onDidChangeTextEditorSelection((event) => this.select(event.textEditor)),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (document === this.document) {
          clearTimeout(this.timer);
          this.timer = setTimeout(() => void this.draw(), PAUSE);
        }
      }),
    );
  }

  /** Opens the panel beside an editor. */
  show(editor: vscode.TextEditor | undefined): void {
    if (!this.panel) {
      const column = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
      this.panel = vscode.window.createWebviewPanel("rungc.ladder", "Ladder", column, {
        enableScripts: true,
        localResourceRoots: [this.media],
      });
      this.panel.iconPath = vscode.Uri.joinPath(this.media, "icon.png");
      this.panel.webview.onDidReceiveMessage((message: FromPage) => void this.take(message));
      this.panel.onDidDispose(() => {
        this.panel = undefined;
        this.document = undefined;
        this.width = undefined;
      });
      this.panel.webview.html = this.page(this.panel.webview);
    } else {
      this.panel.reveal(undefined, true);
    }
    this.follow(editor);
  }

  private page(webview: vscode.Webview): string {
    const file = (name: string) => webview.asWebviewUri(vscode.Uri.joinPath(this.media, name));
    const nonce = randomBytes(16).toString("base64");
    const policy = `default-src 'none'; style-src ${webview.cspSource}; script-src 'nonce-${nonce}'`;
    return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<title>Ladder</title>
<link rel="stylesheet" href="${file("preview.css")}">
</head>
<body>
<p id="message" role="status" hidden></p>
<main id="ladder"></main>
<script nonce="${nonce}" src="${file("preview.js")}"></script>
</body>
</html>`;
  }

  private post(message: object): void {
    void this.panel?.webview.postMessage(message);
  }

  private follow(editor: vscode.TextEditor | undefined): void {
    if (!this.panel || editor?.document.languageId !== "plc") {
      return;
    }
    if (editor.document !== this.document) {
      this.document = editor.document;
      this.found = undefined;
      this.panel.title = `Ladder of ${path.basename(editor.document.fileName)}`;
      void this.draw();
    } else {
      void this.select(editor);
    }
  }

  /** Draws the text as it is in the editor. */
  private async draw(): Promise<void> {
    const document = this.document;
    if (!document || !this.panel || this.width === undefined) {
      return;
    }
    try {
      const drawn = await draw(document, this.width);
      if (document !== this.document) {
        return;
      }
      this.post({ type: "draw", ...drawn });
      await this.select(vscode.window.visibleTextEditors.find((e) => e.document === document));
    } catch (error) {
      report(error);
    }
  }

  /** Shows the network and the device of the cursor. */
  private async select(editor: vscode.TextEditor | undefined): Promise<void> {
    if (!this.panel || !editor || editor.document !== this.document) {
      return;
    }
    const at = editor.selection.active;
    const network = networkAt(await this.networks(editor.document), at.line);
    const word = editor.document.getWordRangeAtPosition(at, /[A-Za-z]+\d+/);
    const device = word && editor.document.getText(word);
    this.post({ type: "select", network: network?.number, device });
  }

  private async networks(document: vscode.TextDocument): Promise<Network[]> {
    if (this.found?.version !== document.version) {
      const { version, uri } = document;
      const command = "vscode.executeDocumentSymbolProvider";
      const symbols = await vscode.commands.executeCommand<Symbol[] | undefined>(command, uri);
      const found = networks(symbols ?? []);
      // Before the server has started, there are none.
      if (found.length === 0) {
        return found;
      }
      this.found = { version, networks: found };
    }
    return this.found.networks;
  }

  private async take(message: FromPage): Promise<void> {
    if (message.type === "size") {
      if (this.width !== message.width) {
        this.width = message.width;
        await this.draw();
      }
    } else {
      await this.go(message.network, message.device, message.use ?? 0);
    }
  }

  /** Moves the cursor to a network, or to the n-th use of a device in it. */
  private async go(number: number, device: string | undefined, use: number): Promise<void> {
    const document = this.document;
    const all = document ? await this.networks(document) : [];
    const network = all.find((one) => one.number === number);
    if (!document || !network) {
      return;
    }
    const uses: vscode.Position[] = [];
    for (let line = network.first; device && line <= network.last; line++) {
      for (const column of places(document.lineAt(line).text, device)) {
        uses.push(new vscode.Position(line, column));
      }
    }
    const target = uses[use] ?? uses[0] ?? new vscode.Position(network.first, 0);
    const visible = vscode.window.visibleTextEditors.find((one) => one.document === document);
    await vscode.window.showTextDocument(document, {
      viewColumn: visible?.viewColumn ?? vscode.ViewColumn.One,
      selection: new vscode.Range(target, target),
    });
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.panel?.dispose();
    this.subscriptions.forEach((one) => one.dispose());
  }
}

/** A drawing as HTML, or why there is none. */
interface Drawn {
  html?: string;
  message?: string;
}

async function draw(document: vscode.TextDocument, width: number): Promise<Drawn> {
  const folder = await fs.mkdtemp(path.join(os.tmpdir(), "rungc-"));
  try {
    const file = path.join(folder, "ladder.html");
    const cwd = document.uri.scheme === "untitled" ? undefined : path.dirname(document.uri.fsPath);
    const args = ["view", "-", "--width", String(width), "--output", file, "--force", "--quiet"];
    const output = await rungc(args, { cwd, input: document.getText() });
    const page = await fs.readFile(file, "utf8").catch(() => "");
    const ladder = /<main id="ladder"[^>]*>([\s\S]*)<\/main>/.exec(page)?.[1];
    return ladder === undefined ? { message: output.stderr.trim() } : { html: ladder };
  } finally {
    await fs.rm(folder, { recursive: true, force: true });
  }
}
