// Cases in test files and properties in settings, as far as their names and places go. rungc reads the rest. Nothing
// here needs the editor.

/** A case or a property. */
export interface Found {
  /** Line that names it, from 0. */
  line: number;
  /** Name of a case; of a property its requirement, with its name, text or condition. */
  label: string;
  /** Names by which results may call it. */
  names: string[];
  /** Requirement of a property. */
  requirement: string;
}

/** The keys of a table, with the lines that they are in. */
interface Table {
  line: number;
  keys: Map<string, { line: number; value: string }>;
}

/** Keys that make a property one that can be decided. */
const CONDITIONS = ["never", "always", "reachable", "whenever", "stays", "use", "matrix"];

/** The cases of a test file. */
export function cases(text: string): Found[] {
  return tables(text, "case").flatMap(({ keys }) => {
    const name = keys.get("name");
    const label = name?.value ?? "";
    return name ? [{ line: name.line, label, names: [label], requirement: "" }] : [];
  });
}

/** The properties of settings. */
export function properties(text: string): Found[] {
  return tables(text, "property").flatMap(({ line, keys }) => {
    const value = (key: string) => keys.get(key)?.value ?? "";
    const kind = CONDITIONS.find((key) => keys.has(key));
    if (!kind) {
      return [];
    }
    const condition = `${kind} ${value(kind)}`;
    const [name, requirement] = [value("name"), value("id")];
    return [
      {
        line,
        label: [requirement, name || value("text") || condition].filter(Boolean).join(": "),
        names: name ? [`${name}: ${condition}`, name] : [condition],
        requirement,
      },
    ];
  });
}

/** The tables of an array `[[name]]`. */
function tables(text: string, name: string): Table[] {
  const found: Table[] = [];
  let table: Table | undefined;
  let until: string | undefined;
  for (const [line, content] of text.split("\n").entries()) {
    if (until !== undefined) {
      // Within a text of several lines.
      until = content.includes(until) ? undefined : until;
      continue;
    }
    const head = /^\s*\[\[?\s*([^\]]+?)\s*\]/.exec(content);
    if (head) {
      table = undefined;
      if (head[1] === name && content.trimStart().startsWith("[[")) {
        table = { line, keys: new Map() };
        found.push(table);
      }
      continue;
    }
    const pair = /^\s*([\w-]+)\s*=\s*(.*)$/.exec(content);
    if (pair?.[1] !== undefined && pair[2] !== undefined) {
      table?.keys.set(pair[1], { line, value: unquoted(pair[2]) });
      until = open(pair[2]);
    }
  }
  return found;
}

/** The end of a text of several lines that begins in a value and does not end there. */
function open(value: string): string | undefined {
  const quotes = /^("""|''')/.exec(value)?.[1];
  return quotes !== undefined && !value.slice(3).includes(quotes) ? quotes : undefined;
}

function unquoted(value: string): string {
  const basic = /^"((?:[^"\\]|\\.)*)"/.exec(value);
  if (basic?.[1] !== undefined) {
    return basic[1].replace(/\\(?:u([0-9a-fA-F]{4})|(.))/g, (_, code, character) =>
      code ? String.fromCharCode(parseInt(code, 16)) : character,
    );
  }
  return /^'([^']*)'/.exec(value)?.[1] ?? value.replace(/\s*#.*$/, "").trim();
}

/** The one that a result is about. A row of a case is called `name[row]`. */
export function named(all: Found[], name: string): Found | undefined {
  const row = name.replace(/\[[^\]]*\]$/, "");
  return all.find((one) => one.label === name) ?? all.find((one) => one.label === row);
}

/** The verdict of a property, as far as it identifies the property. */
export interface Decided {
  property: string;
  requirement?: string;
}

/** The verdicts of a property. A safety function or a matrix has several. */
export function decided<T extends Decided>(found: Found, all: Found[], verdicts: T[]): T[] {
  const ways = [
    (one: T) => found.names.includes(one.property),
    (one: T) => found.names.some((name) => one.property.startsWith(`${name}: `)),
    (one: T) => found.requirement !== "" && one.requirement === found.requirement,
    (one: T) => verdicts.length === all.length && verdicts.indexOf(one) === all.indexOf(found),
  ];
  for (const way of ways) {
    const matching = verdicts.filter(way);
    if (matching.length > 0) {
      return matching;
    }
  }
  return [];
}
