// Runs of tests, proofs, and coverage.

import * as fs from "node:fs/promises";
import * as os from "node:os";
import * as path from "node:path";
import * as vscode from "vscode";
import { report as reportCoverage } from "./coverage";
import { type Decided, type Found, decided, named } from "./found";
import { type Coverage, add } from "./lcov";
import { Missing, type Output, reportMissing, rungc } from "./rungc";

/** Requested tests of a file. */
export interface File {
  uri: vscode.Uri;
  name: string;
  cwd: string;
  /** True if it has cases, false if it has properties. */
  hasCases: boolean;
  items: vscode.TestItem[];
  /** True if these are all of the file. */
  isWhole: boolean;
  /** All tests of the file. */
  found: Found[];
  of: (found: Found) => vscode.TestItem | undefined;
}

/** A run of tests. */
export interface Request {
  run: vscode.TestRun;
  token: vscode.CancellationToken;
  files: File[];
}

/** Runs requested tests. */
export type Job = (request: Request) => Promise<void>;

/** Result of a case, as `rungc test --format json` prints it. */
interface Result {
  name: string;
  engine: string;
  passed: boolean;
  seconds: number;
  failure?: {
    message: string;
    line?: number;
    values?: { name: string; expected: unknown; actual: unknown }[];
  };
}

/** Results of a test file. */
interface Results {
  cases?: Result[];
  mistakes?: { line: number; column: number; message: string }[];
}

/** Verdict of a property, as `rungc verify --format json` prints it. */
interface Verdict extends Decided {
  verdict: string;
  holds: boolean | null;
  reason?: string;
  run?: {
    start: Value[];
    changes: { scan: number; at_ms: number; set: Value[] }[];
    end: Value[];
  };
}

/** Value of a device. */
interface Value {
  device: string;
  value: unknown;
  comment?: string;
}

/** Verdicts of a program. */
interface Verdicts {
  diagnostics?: { message: string; severity: string }[];
  verification?: { properties: Verdict[] };
}

/** Runs the cases of test files, and decides the properties of settings. */
export const runAll: Job = async (request) => {
  request.files.flatMap(({ items }) => items).forEach((item) => request.run.enqueued(item));
  for (const file of request.files) {
    await guarded(request, file, file.hasCases ? runCases : prove);
  }
};

/** Runs the cases of a test file. */
async function runCases({ run, token }: Request, file: File): Promise<void> {
  const args = ["test", file.name, "--format", "json", ...filter(file)];
  const output = await rungc(args, { cwd: file.cwd, token });
  const { cases = [], mistakes = [] } = parsed<Results>(output);
  log(run, output.stderr);
  for (const item of file.items) {
    const own = cases.filter(({ name }) => {
      const found = named(file.found, name);
      return found !== undefined && file.of(found) === item;
    });
    if (mistakes.length > 0) {
      const texts = mistakes.map(({ message: text, line, column }) =>
        message(text, file.uri, new vscode.Position(line - 1, column - 1)),
      );
      run.errored(item, texts);
    } else {
      judge(run, item, own);
    }
  }
}

/** Runs the cases, and reports what they execute of their programs. */
export const runCoverage: Job = async (request) => {
  const { run, token } = request;
  // Properties have no coverage, and keep their verdicts.
  const files = request.files.filter(({ hasCases }) => hasCases);
  await runAll({ ...request, files });
  const coverage: Coverage = new Map();
  const folder = await fs.mkdtemp(path.join(os.tmpdir(), "rungc-"));
  try {
    for (const file of files) {
      if (token.isCancellationRequested) {
        return;
      }
      const info = path.join(folder, "coverage.info");
      const args = ["test", file.name, "--coverage", "lcov", "--output", info, ...filter(file)];
      const { stderr } = await rungc(args, { cwd: file.cwd, token });
      log(run, stderr);
      const text = await fs.readFile(info, "utf8").catch(() => "");
      add(coverage, text, (program) => path.resolve(file.cwd, program));
      await fs.rm(info, { force: true });
    }
    reportCoverage(run, coverage);
  } catch (error) {
    // A missing executable has been reported with the cases.
    if (!(error instanceof Missing)) {
      throw error;
    }
  } finally {
    await fs.rm(folder, { recursive: true, force: true });
  }
};

/** Decides the properties of settings. */
async function prove({ run, token }: Request, file: File): Promise<void> {
  const output = await rungc(["verify", "--format", "json"], { cwd: file.cwd, token });
  const { diagnostics = [], verification } = parsed<Verdicts>(output);
  log(run, output.stderr);
  const errors = diagnostics.filter(({ severity }) => severity === "error");
  for (const item of file.items) {
    const at = item.range?.start;
    const found = file.found.find((one) => file.of(one) === item);
    const verdicts = found ? decided(found, file.found, verification?.properties ?? []) : [];
    const failed = verdicts.filter(({ holds }) => holds !== true);
    const texts = failed.map((verdict) => message(story(verdict), file.uri, at));
    if (verdicts.length === 0) {
      const why = errors.map((error) => error.message).join("\n") || "rungc has not decided it";
      run.errored(item, message(why, file.uri, at));
    } else if (failed.some(({ holds }) => holds === false)) {
      run.failed(item, texts);
    } else if (failed.length > 0) {
      run.errored(item, texts);
    } else {
      run.passed(item);
    }
  }
}

/** Runs the tests of a file; where that fails, they have an error. */
async function guarded(
  request: Request,
  file: File,
  job: (request: Request, file: File) => Promise<void>,
): Promise<void> {
  const { run, token } = request;
  const skip = () => file.items.forEach((item) => run.skipped(item));
  if (token.isCancellationRequested) {
    skip();
    return;
  }
  file.items.forEach((item) => run.started(item));
  try {
    await job(request, file);
  } catch (error) {
    if (token.isCancellationRequested) {
      skip();
      return;
    }
    if (error instanceof Missing) {
      void reportMissing(error.path);
    }
    const text = error instanceof Error ? error.message : String(error);
    file.items.forEach((item) => run.errored(item, new vscode.TestMessage(text)));
  }
}

/** Limits a command to a single case. Several are picked from the results of all. */
function filter({ name, items, isWhole }: File): string[] {
  const [item] = items;
  return !isWhole && items.length === 1 && item ? ["--filter", `${name}::${item.label}`] : [];
}

/** The object that a command prints. */
function parsed<T>({ code, stdout, stderr }: Output): T {
  try {
    return JSON.parse(stdout) as T;
  } catch {
    throw new Error(stderr.trim() || `rungc ended with code ${code}`);
  }
}

function log(run: vscode.TestRun, text: string): void {
  run.appendOutput(text.replace(/\r?\n/g, "\r\n"));
}

function message(text: string, uri: vscode.Uri, at = new vscode.Position(0, 0)) {
  const message = new vscode.TestMessage(text);
  message.location = new vscode.Location(uri, at);
  return message;
}

/** Reports the results of a case, of which each row and engine has one. */
function judge(run: vscode.TestRun, item: vscode.TestItem, results: Result[]): void {
  if (results.length === 0) {
    run.skipped(item);
    return;
  }
  const engines = new Set(results.map(({ engine }) => engine));
  const texts = results.flatMap(({ name, engine, failure }) => {
    if (!failure || !item.uri) {
      return [];
    }
    const row = name === item.label ? "" : name.slice(item.label.length);
    const lead = [row, engines.size > 1 ? engine : ""].filter(Boolean).join(" ");
    const at = failure.line === undefined ? item.range?.start : new vscode.Position(failure.line - 1, 0);
    const text = message(lead ? `${lead}: ${failure.message}` : failure.message, item.uri, at);
    const side = (key: "expected" | "actual") =>
      failure.values?.map((one) => `${one.name} = ${String(one[key])}`).join("\n");
    text.expectedOutput = side("expected");
    text.actualOutput = side("actual");
    return [text];
  });
  const milliseconds = results.reduce((sum, { seconds }) => sum + 1000 * seconds, 0);
  if (texts.length > 0) {
    run.failed(item, texts, milliseconds);
  } else {
    run.passed(item, milliseconds);
  }
}

/** A verdict with the run that shows it. */
function story({ property, verdict, reason, run }: Verdict): string {
  const values = (all: Value[]) =>
    all.map(({ device, value, comment }) => `${device} = ${String(value)}${comment ? ` (${comment})` : ""}`).join(", ");
  const lines = [`${property}: ${verdict}${reason ? `: ${reason}` : ""}`];
  if (run) {
    const start = run.start.length > 0 ? [`before: ${values(run.start)}`] : [];
    const changes = run.changes.map(
      ({ scan, at_ms, set }) => `scan ${scan}, ${at_ms} ms: ${values(set) || "nothing changes"}`,
    );
    lines.push(...start, ...changes, `then: ${values(run.end)}`);
  }
  return lines.join("\n");
}
