// Entry point of the extension: what it starts, and its commands.

import * as vscode from "vscode";
import { Debug } from "./debug";
import { Preview } from "./preview";
import { Projects } from "./project";
import { executable } from "./rungc";
import { Server } from "./server";
import { Tests } from "./tests";

/** Starts the extension. */
export function activate(context: vscode.ExtensionContext): void {
  const server = new Server();
  const preview = new Preview(vscode.Uri.joinPath(context.extensionUri, "media"));
  const command = (name: string, run: () => unknown) =>
    vscode.commands.registerCommand(`rungc.${name}`, run);
  context.subscriptions.push(
    server,
    preview,
    new Tests(),
    new Projects(),
    new Debug(),
    command("preview", () => preview.show(vscode.window.activeTextEditor)),
    command("restart", () => server.restart()),
    command("showOutput", () => server.showOutput()),
    command("serve", serve),
    vscode.workspace.onDidChangeConfiguration((event) => {
      if (event.affectsConfiguration("rungc")) {
        void server.restart();
      }
    }),
  );
  void server.restart();
}

/** Runs the program of the active editor in a terminal, which shows the address of its page. */
async function serve(): Promise<void> {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.uri.scheme !== "file" || !vscode.workspace.isTrusted) {
    void vscode.window.showErrorMessage("rungc: open a saved program in a trusted workspace first.");
    return;
  }
  await document.save();
  const shellPath = executable();
  const shellArgs = ["serve", document.fileName, "--page"];
  const cwd = vscode.Uri.joinPath(document.uri, "..");
  vscode.window.createTerminal({ name: "rungc serve", shellPath, shellArgs, cwd }).show();
}
