// The language server.

import * as vscode from "vscode";
import { LanguageClient, Trace, type DocumentSelector } from "vscode-languageclient/node";
import { Missing, executable, report, reportMissing, rungc } from "./rungc";

/** Texts that the server is asked about. */
const SELECTOR: DocumentSelector = [
  { language: "plc", scheme: "file" },
  { language: "plc", scheme: "untitled" },
  { language: "plc", scheme: "rungc" },
  { scheme: "file", pattern: "**/*.plctest.toml" },
  { scheme: "file", pattern: "**/rungc.toml" },
];

/** Keeps a language server running. */
export class Server implements vscode.Disposable {
  private client: LanguageClient | undefined;
  private readonly output = vscode.window.createOutputChannel("rungc", { log: true });
  private readonly status = vscode.languages.createLanguageStatusItem("rungc", { language: "plc" });
  /** The last start or stop: they come one after the other. */
  private last: Promise<void> = Promise.resolve();

  constructor() {
    this.status.name = "rungc";
    this.status.command = { command: "rungc.restart", title: "Restart" };
  }

  /** Starts it, or starts it again. */
  restart(): Promise<void> {
    this.last = this.last.then(async () => {
      await this.stop();
      await this.start();
    });
    return this.last;
  }

  showOutput(): void {
    this.output.show();
  }

  private async start(): Promise<void> {
    const command = executable();
    try {
      const { stdout } = await rungc(["--version"]);
      const version = stdout.trim() || "rungc";
      this.output.info(`${version}: ${command}`);
      this.status.text = version;
      this.status.severity = vscode.LanguageStatusSeverity.Information;
      const server = { command, args: ["lsp"] };
      const client = new LanguageClient("rungc", "rungc", server, {
        documentSelector: SELECTOR,
        outputChannel: this.output,
      });
      this.client = client;
      await client.start();
      const trace = vscode.workspace.getConfiguration("rungc").get("trace.server", "off");
      await client.setTrace(Trace.fromString(trace));
    } catch (error) {
      this.status.text = "rungc is not running";
      this.status.severity = vscode.LanguageStatusSeverity.Error;
      this.output.error(error instanceof Error ? error.message : String(error));
      if (error instanceof Missing) {
        void reportMissing(error.path);
      } else {
        report(error);
      }
    }
  }

  private async stop(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    try {
      await client?.dispose();
    } catch (error) {
      // It has ended by itself.
      this.output.warn(error instanceof Error ? error.message : String(error));
    }
  }

  async dispose(): Promise<void> {
    await this.last;
    await this.stop();
    this.status.dispose();
    this.output.dispose();
  }
}
