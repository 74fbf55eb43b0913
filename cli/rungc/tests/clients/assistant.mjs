// Works with `rungc mcp` by the official client for TypeScript: node assistant.mjs RUNGC FOLDER. NODE_PATH has the package.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';

const require = createRequire(process.env.NODE_PATH + '/');
const { Client } = require('@modelcontextprotocol/sdk/client/index.js');
const { StdioClientTransport } = require('@modelcontextprotocol/sdk/client/stdio.js');

const [rungc, cwd] = process.argv.slice(2);
const client = new Client({ name: 'test', version: '1.0.0' });
await client.connect(new StdioClientTransport({ command: rungc, args: ['mcp'], cwd }));
assert.equal(client.getServerVersion().name, 'rungc');
assert.match(client.getInstructions(), /rungc:\/\/guide/);
await client.ping();

// The client holds structured answers to the schemas of the tools.
const { tools } = await client.listTools();
assert.equal(tools.length, 11);
const call = async (name, args) => {
  const result = await client.callTool({ name, arguments: args });
  assert.ok(!result.isError, JSON.stringify(result));
  return result.structuredContent;
};

const list = 'LD X000\nANI Y001\nOUT Y000\nLD X001\nANI Y000\nOUT Y001\nEND\n';
assert.equal((await call('check', { list })).errors, 0);
assert.equal((await call('open', { path: 'a.il' })).networks, 2);
assert.equal((await call('view', { list })).networks, 3);
assert.equal((await call('xref', { list, devices: ['Y000'] })).devices.length, 1);
assert.equal((await call('verify', { list, never: ['Y000 & Y001'] })).results[0].verdict, 'proved');
const run = await call('run', { list, inputs: [{ at_ms: 50, set: { X000: true } }], watch: ['Y000'], for_ms: 200 });
assert.deepEqual(run.rows.map((row) => row.values.Y000), [false, true]);
assert.match((await call('explain', { topic: 'MOV' })).text, /MOV/);
assert.equal((await call('why', { list, device: 'Y000' })).device, 'Y000');
assert.equal((await call('diff', { old: 'a.il', new: 'a.il' })).differs, false);
assert.match((await call('convert', { list, to: 'ladder' })).text, /Y000/);

const failed = await client.callTool({ name: 'check', arguments: { path: '../x.il' } });
assert.ok(failed.isError && /outside/.test(failed.content[0].text), JSON.stringify(failed));
await assert.rejects(client.callTool({ name: 'nothing', arguments: {} }), /there is no tool/);

const { resources, nextCursor } = await client.listResources();
assert.ok(resources.length > 100 && nextCursor);
const guide = await client.readResource({ uri: 'rungc://guide' });
assert.match(guide.contents[0].text, /octal/);
await assert.rejects(client.readResource({ uri: 'rungc://nothing' }), /resources\/list/);

const { prompts } = await client.listPrompts();
assert.equal(prompts.length, 5);
const prompt = await client.getPrompt({ name: 'write-tests', arguments: { path: 'a.il' } });
assert.match(prompt.messages[0].content.text, /a\.il/);
await client.close();
