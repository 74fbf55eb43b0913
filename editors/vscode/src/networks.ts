// Places of networks in a list, and of devices in a network. Nothing here needs the editor.

/** Lines of a network, from 0, both included. */
export interface Network {
  number: number;
  first: number;
  last: number;
}

/** A symbol of the language server, as far as it is needed here. */
export interface Symbol {
  name: string;
  range: { start: { line: number }; end: { line: number } };
  children?: Symbol[];
}

/** The networks among the symbols of a program, in the order of the text. */
export function networks(symbols: Symbol[]): Network[] {
  const found: Network[] = [];
  const open = [...symbols];
  for (let symbol = open.pop(); symbol; symbol = open.pop()) {
    // `12: OUT Y000`; routines and states have other names.
    const number = /^(\d+): /.exec(symbol.name);
    if (number) {
      const { start, end } = symbol.range;
      found.push({ number: Number(number[1]), first: start.line, last: end.line });
    }
    open.push(...(symbol.children ?? []));
  }
  return found.sort((a, b) => a.first - b.first || a.number - b.number);
}

/** The network that holds a line, or else the next one: a line between two comments on what follows. */
export function networkAt(networks: Network[], line: number): Network | undefined {
  return networks.find((network) => line <= network.last) ?? networks.at(-1);
}

/** A device as drawings write it, without leading zeros: `X000` and `x0` are `X0`. */
export function plain(device: string): string {
  return device.toUpperCase().replace(/^([A-Z]+)0+(?=\d)/, "$1");
}

/** Places of a device in a line: columns at which words begin that name it. */
export function places(line: string, device: string): number[] {
  const comment = line.search(/;|\/\//);
  const code = comment < 0 ? line : line.slice(0, comment);
  const words = code.matchAll(/(?<![A-Za-z0-9_])(?:K[1-8](?=[XYMSxyms]))?([A-Za-z]+\d+)/g);
  return [...words]
    .filter((word) => plain(word[1] ?? "") === plain(device))
    .map((word) => word.index);
}
