// The debugger.

import * as vscode from "vscode";
import { executable } from "./rungc";

/** Starts `rungc dap`, and completes configurations. */
export class Debug
  implements vscode.Disposable, vscode.DebugAdapterDescriptorFactory, vscode.DebugConfigurationProvider
{
  private readonly registered = [
    vscode.debug.registerDebugAdapterDescriptorFactory("rungc", this),
    vscode.debug.registerDebugConfigurationProvider("rungc", this),
  ];

  createDebugAdapterDescriptor(): vscode.DebugAdapterDescriptor {
    return new vscode.DebugAdapterExecutable(executable(), ["dap"]);
  }

  resolveDebugConfiguration(
    _folder: vscode.WorkspaceFolder | undefined,
    configuration: vscode.DebugConfiguration,
  ): vscode.DebugConfiguration | undefined {
    if (!vscode.workspace.isTrusted) {
      void vscode.window.showErrorMessage("rungc: programs run in trusted workspaces only.");
      return undefined;
    }
    // F5 without a launch.json debugs the program of the active editor.
    const document = vscode.window.activeTextEditor?.document;
    if (!configuration.type && document?.languageId === "plc") {
      return { type: "rungc", request: "launch", name: "Debug this program", program: document.fileName };
    }
    if (configuration.type && !configuration["program"] && document !== undefined) {
      return { ...configuration, program: document.fileName };
    }
    return configuration;
  }

  dispose(): void {
    this.registered.forEach((one) => one.dispose());
  }
}
