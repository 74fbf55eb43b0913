// Coverage of programs, as the editor shows it.

import * as vscode from "vscode";
import type { Coverage, Line } from "./lcov";

/** Details of the last coverage. */
const known = new WeakMap<vscode.FileCoverage, vscode.FileCoverageDetail[]>();

/** Lines of a program that were executed, and what was reached in them. */
export function details(file: vscode.FileCoverage): vscode.FileCoverageDetail[] {
  return known.get(file) ?? [];
}

function statement(number: number, line: Line): vscode.StatementCoverage {
  const at = new vscode.Position(number - 1, 0);
  const branches = line.branches.map((taken) => new vscode.BranchCoverage(taken, at));
  return new vscode.StatementCoverage(line.executed, at, branches);
}

/** Reports the coverage of all programs of a run. */
export function report(run: vscode.TestRun, coverage: Coverage): void {
  for (const [path, lines] of coverage) {
    const all = [...lines].map(([number, line]) => statement(number, line));
    const file = vscode.FileCoverage.fromDetails(vscode.Uri.file(path), all);
    known.set(file, all);
    run.addCoverage(file);
  }
}
