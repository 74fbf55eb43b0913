// Calls of the executable.

import { spawn } from "node:child_process";
import * as os from "node:os";
import * as vscode from "vscode";

/** Output of a command. */
export interface Output {
  code: number;
  stdout: string;
  stderr: string;
}

/** The executable cannot be started. */
export class Missing extends Error {
  constructor(readonly path: string) {
    super(`\`${path}\` cannot be started`);
  }
}

/** The executable that the settings name. */
export function executable(): string {
  const path = vscode.workspace.getConfiguration("rungc").get("path", "").trim() || "rungc";
  const folder = vscode.workspace.workspaceFolders?.[0]?.uri.fsPath ?? "";
  return path.replace(/^~(?=[\\/])/, os.homedir()).replaceAll("${workspaceFolder}", folder);
}

/** Options of a command. */
export interface RunOptions {
  /** Working folder: the settings of the nearest `rungc.toml` apply. */
  cwd?: string;
  /** Standard input. */
  input?: string;
  /** Cancellation, which ends the command. */
  token?: vscode.CancellationToken;
}

/** Runs a command of rungc to its end. */
export function rungc(args: string[], options: RunOptions = {}): Promise<Output> {
  const path = executable();
  return new Promise((resolve, reject) => {
    const env = { ...process.env, NO_COLOR: "1" };
    const child = spawn(path, args, { cwd: options.cwd, env, windowsHide: true });
    const stdout: Buffer[] = [];
    const stderr: Buffer[] = [];
    const cancel = options.token?.onCancellationRequested(() => child.kill());
    child.stdout.on("data", (data: Buffer) => stdout.push(data));
    child.stderr.on("data", (data: Buffer) => stderr.push(data));
    // A command that reads no input closes it.
    child.stdin.on("error", () => undefined);
    child.on("error", () => {
      cancel?.dispose();
      reject(new Missing(path));
    });
    child.on("close", (code) => {
      cancel?.dispose();
      const text = (data: Buffer[]) => Buffer.concat(data).toString("utf8");
      resolve({ code: code ?? -1, stdout: text(stdout), stderr: text(stderr) });
    });
    child.stdin.end(options.input ?? "");
  });
}

/** Offers what helps where the executable is missing. */
export async function reportMissing(path: string): Promise<void> {
  const settings = "Open Settings";
  const install = "How to Install";
  const message =
    `rungc is missing: \`${path}\` cannot be started. Install it, or set its path (rungc.path).`;
  const choice = await vscode.window.showErrorMessage(message, settings, install);
  if (choice === settings) {
    // The setting belongs to the machine that the extension runs on.
    const name = vscode.env.remoteName === undefined ? "openSettings2" : "openRemoteSettings";
    await vscode.commands.executeCommand(`workbench.action.${name}`, { query: "rungc.path" });
  } else if (choice === install) {
    const page = "https://github.com/rungc/rungc/blob/main/docs/src/install.md";
    await vscode.env.openExternal(vscode.Uri.parse(page));
  }
}

/** Shows an error of a command. */
export function report(error: unknown): void {
  if (error instanceof Missing) {
    void reportMissing(error.path);
  } else {
    const message = error instanceof Error ? error.message : String(error);
    void vscode.window.showErrorMessage(`rungc: ${message}`);
  }
}
