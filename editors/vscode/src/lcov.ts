// Tracefiles of lcov, as `rungc test --coverage lcov` writes them. Nothing here needs the editor.

/** A line of a program that was executed or not, with what could be reached in it. */
export interface Line {
  executed: boolean;
  branches: boolean[];
}

/** Coverage of programs: their paths, and their lines by number, from 1. */
export type Coverage = Map<string, Map<number, Line>>;

/** Adds a tracefile to what is known: what is reached in one of them is reached. */
export function add(coverage: Coverage, text: string, path: (file: string) => string): void {
  let lines = new Map<number, Line>();
  const at = (number: number) => {
    const line = lines.get(number) ?? { executed: false, branches: [] };
    lines.set(number, line);
    return line;
  };
  for (const record of text.split(/\r?\n/)) {
    const [, kind, value] = /^([A-Z]+):(.*)$/.exec(record) ?? [];
    if (kind === undefined || value === undefined) {
      continue;
    }
    const [number = 0, second = 0, branch = 0, taken = 0] = value.split(",").map(Number);
    if (kind === "SF") {
      lines = coverage.get(path(value)) ?? new Map();
      coverage.set(path(value), lines);
    } else if (kind === "DA") {
      at(number).executed ||= second > 0;
    } else if (kind === "BRDA") {
      const { branches } = at(number);
      branches[branch] = (branches[branch] ?? false) || taken > 0;
    }
  }
}
